#include "closest_point_search.h"

#include <pent/dimensions.h>

namespace pent::contact {

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
            return;  // no point of these faces is nearer
        }
        if (is_inside<A, B>(t)) {
            record<A, B>(t, offset);
        } else {
            visit_facets<A, B>(t, false);
        }
    }
}

// The minimum of a convex function over a polytope, if its free minimum is outside, lies on a facet
// that the free minimum is beyond. Each facet lacks one corner; beyond it the weight of that corner
// is negative.
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

// Edges that are dependent, or nearly so: tries a stable solution, if there is one, and all facets.
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

#define PENT_INSTANTIATE(Dim)                             \
    template bool ClosestPointSearch<Dim, 1, Dim>::run(); \
    template bool ClosestPointSearch<Dim, 2, Dim - 1>::run();
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
