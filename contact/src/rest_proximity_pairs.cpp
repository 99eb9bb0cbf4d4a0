#include "rest_proximity_pairs.h"

#include "boxes_around.h"
#include "near_pairs.h"

#include <algorithm>

namespace pent::contact {

namespace {

// Rest distance up to which pairs are listed, over the distance of contact: the farther, the more a
// body may be bent before its patches are looked into, and the longer the lists.
constexpr double kRestDistance = 2;

// The same, at most, over the mean edge; and the least that is of use.
constexpr double kMaxOfEdge = 0.6;
constexpr double kMinRestDistance = 1.2;

// Pairs listed, at most: 48 MB.
constexpr std::size_t kMaxPairs = 4'000'000;

// Rounding, relative, of the distances of candidates: what is nearer than contact at rest is no
// contact, by exact distances, when it is looked at.
constexpr double kRounding = 1e-6;

template <int Dim, int K, int L>
CandidateList find(const SearchSet<K>& first,
                   const SearchSet<L>& second,
                   const PositionsView<Dim>& rest,
                   double from,
                   double to) {
    CandidateList found = near_pairs<Dim, K, L>(first, second, rest, to);
    std::erase_if(found.pairs, [&](const Candidate& pair) {
        return static_cast<double>(pair.distance) < (1 - kRounding) * from;
    });
    found.pairs.shrink_to_fit();
    found.known_count = 0;  // they were measured at rest
    return found;
}

}  // namespace

template <int Dim>
RestProximityPairs find_rest_proximity_pairs(const Surface<Dim>& surface,
                                             const PositionsView<Dim>& rest,
                                             double distance) {
    const double rest_distance =
        std::min(kRestDistance * distance, kMaxOfEdge * mean_edge_length<Dim>(surface, rest));
    if (rest_distance < kMinRestDistance * distance) {
        return {};
    }
    // A little further than is promised, for rounding.
    const double to = (1 + kRounding) * rest_distance;
    const auto tree = [&]<int Count>(const Simplices<Count>& simplices) {
        return BoxTree(boxes_around<Dim, Count>(simplices, rest, 0.5 * to));
    };
    RestProximityPairs pairs;
    pairs.rest_distance = rest_distance;
    pairs.points = find<Dim, 1, Dim>(
        {surface.vertices, tree.template operator()<1>(surface.vertices)},
        {surface.facets, tree.template operator()<Dim>(surface.facets)}, rest, distance, to);
    const BoxTree edges = tree.template operator()<2>(surface.edges);
    if constexpr (Dim == 3) {
        pairs.mixed =
            find<3, 2, 2>({surface.edges, edges}, {surface.edges, edges}, rest, distance, to);
    } else {
        pairs.mixed = find<Dim, 2, Dim - 1>(
            {surface.edges, edges},
            {surface.ridges, tree.template operator()<Dim - 1>(surface.ridges)}, rest, distance,
            to);
    }
    if (pairs.points.pairs.size() + pairs.mixed.pairs.size() > kMaxPairs) {
        return {};  // GCOVR_EXCL_LINE: millions of pairs
    }
    return pairs;
}

template RestProximityPairs find_rest_proximity_pairs<3>(const Surface<3>&,
                                                         const PositionsView<3>&,
                                                         double);
template RestProximityPairs find_rest_proximity_pairs<4>(const Surface<4>&,
                                                         const PositionsView<4>&,
                                                         double);

}  // namespace pent::contact
