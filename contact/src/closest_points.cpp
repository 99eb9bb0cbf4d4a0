#include "pent/contact/closest_points.h"

#include "closest_point_search.h"

#include <Eigen/QR>

#include <limits>

namespace pent::contact {

namespace {

// The sine of an angle below which directions count as the same here. Only the name of the branch
// depends on it, not the closest points.
constexpr double kParallel = 1e-7;

template <int Dim, int Count>
Eigen::Matrix<double, Dim, Count - 1> edges_of(const Corners<Dim, Count>& corners) {
    return corners.template rightCols<Count - 1>().colwise() - corners.col(0);
}

template <typename Edges>
bool is_dependent(const Edges& edges) {
    if constexpr (Edges::ColsAtCompileTime == 0) {
        return false;
    } else {
        Eigen::ColPivHouseholderQR<Edges> factors(edges);
        factors.setThreshold(kParallel);
        return factors.rank() < edges.cols();
    }
}

template <int Dim, int K, int L>
Branch branch_of(const Corners<Dim, K>& first,
                 const Corners<Dim, L>& second,
                 const ClosestPoints<Dim, K, L>& points) {
    if (is_dependent(edges_of<Dim, K>(first)) || is_dependent(edges_of<Dim, L>(second))) {
        return Branch::Collapsed;
    }
    Eigen::Matrix<double, Dim, Dim - 1> edges;
    edges << edges_of<Dim, K>(first), edges_of<Dim, L>(second);
    if (is_dependent(edges)) {
        return Branch::Parallel;
    }
    const bool is_interior =
        points.first_face == (1U << K) - 1 && points.second_face == (1U << L) - 1;
    return is_interior ? Branch::Interior : Branch::Border;
}

}  // namespace

template <int Dim, int K, int L>
bool ClosestPointSearch<Dim, K, L>::run() {
    visit<(1U << K) - 1, (1U << L) - 1>();
    return best_.first_face != 0;
}

template <int Dim, int K, int L>
template <unsigned A, unsigned B>
void ClosestPointSearch<Dim, K, L>::visit() {
    constexpr int kN = kUnknowns<A, B>;
    Vector<Dim> offset = first_.col(corner(A, 0)) - second_.col(corner(B, 0));
    if constexpr (kN == 0) {
        record<A, B>(Parameters<0>(), offset);
    } else {
        const Edges<kN> edges = edges_of<A, B>(std::make_integer_sequence<int, kN>());
        Parameters<kN> t = Parameters<kN>::Zero();
        if (!solve_normal_equations<kN>(edges, offset, t)) {
            visit_dependent<A, B>(edges, offset);
            return;
        }
        offset += edges * t;
        if (!(offset.squaredNorm() < best_.distance_squared)) {
            return;  // nor is any point of the faces of these
        }
        if (is_inside<A, B>(t)) {
            record<A, B>(t, offset);
        } else {
            visit_facets<A, B>(t, false);
        }
    }
}

// The minimum of a convex function over a polytope lies on a facet that its free minimum is
// beyond: a facet is the lack of one corner, and beyond it the weight of that corner is negative.
template <int Dim, int K, int L>
template <unsigned A, unsigned B>
[[gnu::noinline]] void ClosestPointSearch<Dim, K, L>::visit_facets(
    const Parameters<kUnknowns<A, B>>& t, bool all) {
    constexpr int kFirst = std::popcount(A);
    constexpr int kSecond = std::popcount(B);
    if constexpr (kFirst > 1) {
        [&]<int... I>(std::integer_sequence<int, I...>) {
            ((all || weight(t, 0, kFirst, I) < 0 ? visit<A & ~(1U << corner(A, I)), B>() : void()),
             ...);
        }
        (std::make_integer_sequence<int, kFirst>());
    }
    if constexpr (kSecond > 1) {
        [&]<int... J>(std::integer_sequence<int, J...>) {
            ((all || weight(t, kFirst - 1, kSecond, J) < 0 ? visit<A, B & ~(1U << corner(B, J))>()
                                                           : void()),
             ...);
        }
        (std::make_integer_sequence<int, kSecond>());
    }
}

// Edges that are dependent, or nearly so: a stable solution where there is one, and all facets.
template <int Dim, int K, int L>
template <unsigned A, unsigned B>
[[gnu::noinline]] void ClosestPointSearch<Dim, K, L>::visit_dependent(
    const Edges<kUnknowns<A, B>>& edges, const Vector<Dim>& offset) {
    constexpr int kN = kUnknowns<A, B>;
    if (is_apart<kN>(edges, offset)) {
        return;
    }
    Parameters<kN> t = Parameters<kN>::Zero();
    if (solve_stably<kN>(edges, offset, t) && is_inside<A, B>(t)) {
        record<A, B>(t, offset + edges * t);
    }
    visit_facets<A, B>(t, true);
}

template <int Dim, int K, int L>
ClosestPoints<Dim, K, L> closest_points(const Corners<Dim, K>& first,
                                        const Corners<Dim, L>& second) {
    static_assert(K + L == Dim + 1);
    ClosestPointSearch<Dim, K, L> search(first, second, std::numeric_limits<double>::infinity());
    search.run();
    ClosestPoints<Dim, K, L> points = search.best();
    points.branch = branch_of<Dim, K, L>(first, second, points);
    return points;
}

template <int Dim, int K, int L>
double distance_squared_within(const Corners<Dim, K>& first,
                               const Corners<Dim, L>& second,
                               double limit_squared) {
    ClosestPointSearch<Dim, K, L> search(first, second, limit_squared);
    search.run();
    return search.best().distance_squared;
}

template bool ClosestPointSearch<3, 1, 3>::run();
template bool ClosestPointSearch<3, 2, 2>::run();
template bool ClosestPointSearch<4, 1, 4>::run();
template bool ClosestPointSearch<4, 2, 3>::run();
template ClosestPoints<3, 1, 3> closest_points(const Corners<3, 1>&, const Corners<3, 3>&);
template ClosestPoints<3, 2, 2> closest_points(const Corners<3, 2>&, const Corners<3, 2>&);
template ClosestPoints<4, 1, 4> closest_points(const Corners<4, 1>&, const Corners<4, 4>&);
template ClosestPoints<4, 2, 3> closest_points(const Corners<4, 2>&, const Corners<4, 3>&);
template double distance_squared_within<3, 1, 3>(const Corners<3, 1>&,
                                                 const Corners<3, 3>&,
                                                 double);
template double distance_squared_within<3, 2, 2>(const Corners<3, 2>&,
                                                 const Corners<3, 2>&,
                                                 double);
template double distance_squared_within<4, 1, 4>(const Corners<4, 1>&,
                                                 const Corners<4, 4>&,
                                                 double);
template double distance_squared_within<4, 2, 3>(const Corners<4, 2>&,
                                                 const Corners<4, 3>&,
                                                 double);

}  // namespace pent::contact
