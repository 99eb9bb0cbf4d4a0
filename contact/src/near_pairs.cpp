#include "near_pairs.h"

#include "winding_number.h"

#include <pent/dimensions.h>
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
                 const PositionsView<Dim>& positions,
                 const SharedWork& shared)
        : surface_(surface),
          vertices_(vertices),
          around_(around),
          facets_(facets),
          positions_(positions),
          shared_(shared),
          is_inside_(vertices.size(), 0) {}

    std::vector<std::uint8_t> run() {
        if (!vertices_.is_empty()) {
            visit(vertices_.root(), vertices_.root_box());
        }
        if (shared_.is_shared()) {
            tell_the_others();
        }
        return std::move(is_inside_);
    }

private:
    static constexpr std::uint32_t kSerial = 256;
    static constexpr std::uint32_t kShared = 32;

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
            visit_below(range, range.left(), left);
            visit_below(range, range.right(), right);
        } else {
            parallel_invoke([&, &half = left] { visit_below(range, range.left(), half); },
                            [&, &half = right] { visit_below(range, range.right(), half); });
        }
    }

    // Of a team all go through large groups, and one of them alone through a small group with all
    // below it.
    void visit_below(const BoxTree::Range& range, const BoxTree::Range& half, const Box& box) {
        if (range.count <= kShared || half.count > kShared || is_own(half)) {
            visit(half, box);
        }
    }

    [[nodiscard]] bool is_own(const BoxTree::Range& range) const {
        return shared_.is_own(range.begin / kShared);
    }

    void tell_the_others() {
        std::vector<std::uint32_t> inside;
        for (std::uint32_t i = 0; i < is_inside_.size(); ++i) {
            if (is_inside_[i] != 0) {
                inside.push_back(i);
            }
        }
        for (const std::uint32_t i : shared_.all(std::move(inside))) {
            is_inside_[i] = 1;
        }
    }

    void decide(const BoxTree::Range& range) {
        if (range.count > kShared && !is_own(range)) {
            return;
        }
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
    const SharedWork& shared_;
    std::vector<std::uint8_t> is_inside_;
};

}  // namespace

template <int Dim, int K, int L>
CandidateList near_pairs(const SearchSet<K>& first,
                         const SearchSet<L>& second,
                         const PositionsView<Dim>& positions,
                         double distance,
                         Closest closest) {
    const NearTest<Dim, K, L> test{.first = first.simplices,
                                   .second = second.simplices,
                                   .is_same_list = &first.tree == &second.tree,
                                   .positions = positions,
                                   .limit_squared = distance * distance,
                                   .closest = closest};
    return sorted(joined(walk_overlaps<CandidateList>(first.tree, second.tree, test)));
}

template <int Dim>
std::vector<std::uint8_t> vertices_inside(const Surface<Dim>& surface,
                                          const BoxTree& vertices,
                                          const Surface<Dim>& around,
                                          const BoxTree& facets,
                                          const PositionsView<Dim>& positions,
                                          const SharedWork& shared) {
    return InsideSearch<Dim>(surface, vertices, around, facets, positions, shared).run();
}

template <int Dim>
std::uint32_t nearest_facet(const Surface<Dim>& surface,
                            const BoxTree& facets,
                            const PositionsView<Dim>& positions,
                            const Vector<Dim>& point) {
    std::uint32_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    const Corners<Dim, 1> corner = point;
    facets.for_each_near<Dim>(point, least, [&](std::uint32_t f) {
        const Corners<Dim, Dim> corners = gather<Dim, Dim>(surface.facets, f, positions);
        // Without a limit, so that the distance is the same whatever was met before.
        ClosestPointSearch<Dim, 1, Dim> search(corner, corners,
                                               std::numeric_limits<double>::infinity());
        search.run();
        const double squared = search.best().distance_squared;
        if (squared < least || (squared == least && f < nearest)) {
            nearest = f;
            least = squared;
        }
        return least;
    });
    return nearest;
}

#define PENT_INSTANTIATE(Dim)                                                                   \
    template CandidateList near_pairs<Dim, 1, Dim>(const SearchSet<1>&, const SearchSet<Dim>&,  \
                                                   const PositionsView<Dim>&, double, Closest); \
    template CandidateList near_pairs<Dim, 2, Dim - 1>(                                         \
        const SearchSet<2>&, const SearchSet<Dim - 1>&, const PositionsView<Dim>&, double,      \
        Closest);                                                                               \
    template std::vector<std::uint8_t> vertices_inside<Dim>(                                    \
        const Surface<Dim>&, const BoxTree&, const Surface<Dim>&, const BoxTree&,               \
        const PositionsView<Dim>&, const SharedWork&);                                          \
    template std::uint32_t nearest_facet<Dim>(const Surface<Dim>&, const BoxTree&,              \
                                              const PositionsView<Dim>&, const Vector<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
