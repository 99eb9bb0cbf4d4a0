#include "tight_pairs.h"

#include <algorithm>

namespace pent::contact {

namespace {

// Rest distance up to which pairs are listed, over the distance of contact: the farther, the more a
// body may be bent before its patches are looked into, and the longer the lists.
constexpr double kReach = 2;

// The same, at most, over the mean edge; and the least reach that is of use.
constexpr double kMostReach = 0.6;
constexpr double kLeastReach = 1.2;

// Pairs listed, at most: 64 MB.
constexpr std::size_t kMostPairs = 4'000'000;

// Rounding, relative: what is nearer than contact at rest is no contact by the same arithmetic.
constexpr double kRounding = 1e-9;

template <int Dim, int K, int L>
NearPairs find(const SearchSet<K>& first,
               const SearchSet<L>& second,
               const PositionsView<Dim>& rest,
               double from,
               double to) {
    NearPairs found = near_pairs<Dim, K, L>(first, second, rest, to, Closest::Anywhere);
    const double least = (1 - kRounding) * from * from;
    std::erase_if(found.pairs, [&](const NearPair& pair) { return pair.distance_squared < least; });
    found.pairs.shrink_to_fit();
    return found;
}

}  // namespace

template <int Dim>
TightPairs find_tight_pairs(const Surface<Dim>& surface,
                            const PositionsView<Dim>& rest,
                            double distance) {
    const double reach =
        std::min(kReach * distance, kMostReach * mean_edge_length<Dim>(surface, rest));
    if (reach < kLeastReach * distance) {
        return {};
    }
    // A little further than is promised, for rounding.
    const double to = (1 + kRounding) * reach;
    const auto tree = [&]<int Count>(const Simplices<Count>& simplices) {
        return BoxTree(boxes_around<Dim, Count>(simplices, rest, 0.5 * to));
    };
    TightPairs tight;
    tight.rest_distance = reach;
    tight.points = find<Dim, 1, Dim>(
        {surface.vertices, tree.template operator()<1>(surface.vertices)},
        {surface.facets, tree.template operator()<Dim>(surface.facets)}, rest, distance, to);
    const BoxTree edges = tree.template operator()<2>(surface.edges);
    if constexpr (Dim == 3) {
        tight.mixed =
            find<3, 2, 2>({surface.edges, edges}, {surface.edges, edges}, rest, distance, to);
    } else {
        tight.mixed = find<Dim, 2, Dim - 1>(
            {surface.edges, edges},
            {surface.ridges, tree.template operator()<Dim - 1>(surface.ridges)}, rest, distance,
            to);
    }
    if (tight.points.pairs.size() + tight.mixed.pairs.size() > kMostPairs) {
        return {};  // GCOVR_EXCL_LINE: millions of pairs
    }
    return tight;
}

template TightPairs find_tight_pairs<3>(const Surface<3>&, const PositionsView<3>&, double);
template TightPairs find_tight_pairs<4>(const Surface<4>&, const PositionsView<4>&, double);

}  // namespace pent::contact
