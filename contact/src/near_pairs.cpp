#include "pent/contact/near_pairs.h"

#include "collect_pairs.h"

#include <pent/parallel.h>

#include <limits>

namespace pent::contact {

namespace {

template <int Dim>
class InsideSearch {
public:
    InsideSearch(const Surface<Dim>& surface,
                 const BoxTree& vertices,
                 const Surface<Dim>& around,
                 const BoxTree& facets,
                 const PositionsView<Dim>& positions)
        : surface_(surface),
          vertices_(vertices),
          around_(around),
          facets_(facets),
          positions_(positions),
          is_inside_(vertices.size(), 0) {}

    std::vector<std::uint8_t> run() {
        if (!vertices_.is_empty()) {
            visit(vertices_.root(), vertices_.root_box());
        }
        return std::move(is_inside_);
    }

private:
    static constexpr std::uint32_t kSerial = 256;

    void visit(const BoxTree::Range& range, const Box& box) {
        if (facets_.is_empty() || !overlap(box, facets_.root_box())) {
            return;
        }
        if (range.is_leaf() || !facets_.has_overlap(box)) {
            decide(range);
            return;
        }
        const auto [left, right] = vertices_.child_boxes(range);
        if (range.count < kSerial) {
            visit(range.left(), left);
            visit(range.right(), right);
        } else {
            parallel_invoke([&, &half = left] { visit(range.left(), half); },
                            [&, &half = right] { visit(range.right(), half); });
        }
    }

    void decide(const BoxTree::Range& range) {
        const std::uint32_t vertex = surface_.vertices(0, vertices_.leaf(range.begin));
        const bool is_inside =
            winding_number<Dim>(around_, facets_, positions_, positions_.col(vertex)) > 0;
        for (std::uint32_t i = range.begin; i < range.begin + range.count; ++i) {
            is_inside_[vertices_.leaf(i)] = is_inside ? 1 : 0;
        }
    }

    const Surface<Dim>& surface_;
    const BoxTree& vertices_;
    const Surface<Dim>& around_;
    const BoxTree& facets_;
    const PositionsView<Dim>& positions_;
    std::vector<std::uint8_t> is_inside_;
};

}  // namespace

template <int Dim, int K, int L>
NearPairs near_pairs(const SearchSet<K>& first,
                     const SearchSet<L>& second,
                     const PositionsView<Dim>& positions,
                     double distance,
                     Closest closest) {
    const double limit = distance * distance;
    const bool is_same_list = &first.tree == &second.tree;
    const std::vector<BoxTree::Work> work = BoxTree::split(first.tree, second.tree, kPieces);
    std::vector<NearPairs> found(work.size());
    parallel_for(work.size(), [&](std::size_t piece) {
        NearPairs& here = found[piece];
        BoxTree::for_each_overlap(
            first.tree, second.tree, work[piece], [&](std::uint32_t i, std::uint32_t j) {
                visit_candidate<Dim, K, L>(first.simplices, i, second.simplices, j, is_same_list,
                                           positions, limit, closest, here);
            });
    });
    return merge(found);
}

template <int Dim, int K, int L>
NearPairs still_near_pairs(const NearPairs& before,
                           const Simplices<K>& first,
                           const Simplices<L>& second,
                           const PositionsView<Dim>& positions,
                           double distance,
                           Closest closest) {
    constexpr std::size_t kChunk = 1024;
    std::vector<NearPairs> found((before.pairs.size() + kChunk - 1) / kChunk);
    parallel_for(found.size(), [&](std::size_t chunk) {
        const std::size_t end = std::min((chunk + 1) * kChunk, before.pairs.size());
        for (std::size_t k = chunk * kChunk; k < end; ++k) {
            add_if_near<Dim, K, L>(first, before.pairs[k].first, second, before.pairs[k].second,
                                   positions, distance * distance, closest, found[chunk]);
            ++found[chunk].candidates;
        }
    });
    return merge(found);
}

template <int Dim>
std::vector<std::uint8_t> vertices_inside(const Surface<Dim>& surface,
                                          const BoxTree& vertices,
                                          const Surface<Dim>& around,
                                          const BoxTree& facets,
                                          const PositionsView<Dim>& positions) {
    return InsideSearch<Dim>(surface, vertices, around, facets, positions).run();
}

template <int Dim>
NearPair nearest_facet(const Surface<Dim>& surface,
                       const BoxTree& facets,
                       const PositionsView<Dim>& positions,
                       const Vector<Dim>& point) {
    NearPair best;
    best.distance_squared = std::numeric_limits<double>::infinity();
    const Corners<Dim, 1> corner = point;
    facets.for_each_near<Dim>(point, best.distance_squared, [&](std::uint32_t f) {
        const Corners<Dim, Dim> corners = gather<Dim, Dim>(surface.facets, f, positions);
        // Without a limit, so that the distance is the same whatever was met before.
        ClosestPointSearch<Dim, 1, Dim> search(corner, corners,
                                               std::numeric_limits<double>::infinity());
        search.run();
        const double squared = search.best().distance_squared;
        if (squared < best.distance_squared
            || (squared == best.distance_squared && f < best.second)) {
            best = {0, f, squared};
        }
        return best.distance_squared;
    });
    return best;
}

template NearPairs near_pairs<3, 1, 3>(
    const SearchSet<1>&, const SearchSet<3>&, const PositionsView<3>&, double, Closest);
template NearPairs near_pairs<3, 2, 2>(
    const SearchSet<2>&, const SearchSet<2>&, const PositionsView<3>&, double, Closest);
template NearPairs still_near_pairs<3, 1, 3>(const NearPairs&,
                                             const Simplices<1>&,
                                             const Simplices<3>&,
                                             const PositionsView<3>&,
                                             double,
                                             Closest);
template NearPairs still_near_pairs<3, 2, 2>(const NearPairs&,
                                             const Simplices<2>&,
                                             const Simplices<2>&,
                                             const PositionsView<3>&,
                                             double,
                                             Closest);
template std::vector<std::uint8_t> vertices_inside<3>(
    const Surface<3>&, const BoxTree&, const Surface<3>&, const BoxTree&, const PositionsView<3>&);
template NearPair nearest_facet<3>(const Surface<3>&,
                                   const BoxTree&,
                                   const PositionsView<3>&,
                                   const Vector<3>&);
template NearPairs near_pairs<4, 1, 4>(
    const SearchSet<1>&, const SearchSet<4>&, const PositionsView<4>&, double, Closest);
template NearPairs near_pairs<4, 2, 3>(
    const SearchSet<2>&, const SearchSet<3>&, const PositionsView<4>&, double, Closest);
template NearPairs still_near_pairs<4, 1, 4>(const NearPairs&,
                                             const Simplices<1>&,
                                             const Simplices<4>&,
                                             const PositionsView<4>&,
                                             double,
                                             Closest);
template NearPairs still_near_pairs<4, 2, 3>(const NearPairs&,
                                             const Simplices<2>&,
                                             const Simplices<3>&,
                                             const PositionsView<4>&,
                                             double,
                                             Closest);
template std::vector<std::uint8_t> vertices_inside<4>(
    const Surface<4>&, const BoxTree&, const Surface<4>&, const BoxTree&, const PositionsView<4>&);
template NearPair nearest_facet<4>(const Surface<4>&,
                                   const BoxTree&,
                                   const PositionsView<4>&,
                                   const Vector<4>&);

}  // namespace pent::contact
