#include "pent/contact/closest_points.h"

#include "closest_point_search.h"

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
