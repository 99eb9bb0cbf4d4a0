#include "self_proximity.h"

#include "boxes_around.h"
#include "self_proximity_search.h"

#include <pent/dimensions.h>

#include <algorithm>

namespace pent::contact {

namespace {

// Pairs are listed up to this many times the distance of contact: the farther, the more a body may
// be bent before there has to be another reference, and the longer the lists.
constexpr double kListed = 2;

// The same, at most, over the mean edge; and the least that is of use.
constexpr double kMaxOfEdge = 0.6;
constexpr double kMinListed = 1.2;

// To list the pairs of two patches costs as much as to look at them so many times.
constexpr std::int64_t kListCost = 2;

}  // namespace

template <int Dim>
SelfProximity<Dim>::SelfProximity(const Surface<Dim>& surface,
                                  const Positions<Dim>& rest,
                                  double distance,
                                  bool is_rest_left_out,
                                  const SharedWork& shared)
    : surface_(surface),
      rest_(rest),
      distance_(distance),
      is_rest_left_out_(is_rest_left_out),
      shared_(shared) {
    const double of_edge = kMaxOfEdge * mean_edge_length<Dim>(surface, rest);
    listed_distance_ = std::clamp(of_edge, kMinListed * distance, kListed * distance);
    add_tree<1>(surface.vertices);
    add_tree<2>(surface.edges);
    add_tree<3>(surface.template simplices<3>());
    if constexpr (Dim > 3) {
        add_tree<Dim>(surface.facets);
    }
    points_.resize(trees_[0].partition.size());
    mixed_.resize(trees_[1].partition.size());
}

template <int Dim>
template <int Count>
void SelfProximity<Dim>::add_tree(const Simplices<Count>& simplices) {
    const PositionsView<Dim> rest = rest_;
    Tree& tree = trees_[Count - 1];
    tree.partition = PatchPartition(boxes_around<Dim, Count>(simplices, rest, 0.5 * distance_));
    if (tree.partition.size() > 0) {
        patches_at_rest_[Count - 1] = Patches<Dim>(simplices, tree.partition, rest);
    }
}

template <int Dim>
template <int Count>
void SelfProximity<Dim>::fit_tree(const Simplices<Count>& simplices, const Asked& asked) {
    constexpr int kPatches = 64;
    Tree& tree = trees_[Count - 1];
    const std::size_t size = tree.partition.size();
    std::vector<Box> around(size);
    tree.patch_inflation.resize(asked.inflation ? size : 0);
    parallel_for(size, kPatches, [&](std::size_t patch) {
        const std::span<const std::uint32_t> members = tree.partition[patch];
        Box all = boxes_[simplices(0, members[0])];
        double inflation = 0;
        for (const std::uint32_t i : members) {
            for (int corner = 0; corner < Count; ++corner) {
                const std::uint32_t v = simplices(corner, i);
                all = hull(all, boxes_[v]);
                inflation = asked.inflation ? std::max(inflation, (*asked.inflation)[v]) : 0;
            }
        }
        around[patch] = all;
        if (asked.inflation) {
            tree.patch_inflation[patch] = inflation;
        }
    });
    tree.patches = PatchTree(around);
    ++refit_;
}

template <int Dim>
void SelfProximity<Dim>::fit_trees(const Asked& asked) {
    fit_boxes<Dim>(surface_.vertices, asked.paths, asked.inflation, 0.5 * asked.reach, boxes_);
    fit_tree<1>(surface_.vertices, asked);
    fit_tree<2>(surface_.edges, asked);
    fit_tree<3>(surface_.template simplices<3>(), asked);
    if constexpr (Dim > 3) {
        fit_tree<Dim>(surface_.facets, asked);
    }
}

template <int Dim>
void SelfProximity<Dim>::set_lanes(Lanes& lanes, const PositionsView<Dim>& positions) const {
    lanes[0].set(surface_.vertices, trees_[0].partition, positions);
    lanes[1].set(surface_.edges, trees_[1].partition, positions);
    lanes[2].set(surface_.template simplices<3>(), trees_[2].partition, positions);
    if constexpr (Dim > 3) {
        lanes[Dim - 1].set(surface_.facets, trees_[Dim - 1].partition, positions);
    }
}

template <int Dim>
void SelfProximity<Dim>::fit_patches(Reference& reference, const Paths<Dim>& paths) {
    for (Patches<Dim>& patches : reference.patches) {
        if (!patches.motions().empty()) {
            patches.fit(paths);
        }
    }
}

template <int Dim>
const typename SelfProximity<Dim>::Reference* SelfProximity<Dim>::reference(
    std::uint32_t serial) const {
    const auto place =
        std::find_if(references_.begin(), references_.end(),
                     [&](const Reference& r) { return r.serial == serial && serial != 0; });
    return place == references_.end() ? nullptr : &*place;
}

// How many lists are of each reference.
template <int Dim>
std::array<std::size_t, SelfProximity<Dim>::kReferences> SelfProximity<Dim>::count_lists() const {
    std::array<std::size_t, kReferences> counts{};
    for (const std::vector<Row>* rows : {&points_, &mixed_}) {
        for (const Row& row : *rows) {
            for (const Known& known : row.known) {
                if (const Reference* of = reference(known.serial)) {
                    ++counts[static_cast<std::size_t>(of - references_.data())];
                }
            }
        }
    }
    return counts;
}

// The one to be given up, where what pairs of patches cost that no reference tells anything of has
// added up to what it costs to list them at another, and to list anew what is lost with the old.
template <int Dim>
typename SelfProximity<Dim>::Reference* SelfProximity<Dim>::wanted_reference(std::size_t unknown) {
    const auto is_due = [&](std::size_t lists) {
        return newest_ == 0 || owed_ >= kListCost * static_cast<std::int64_t>(lists);
    };
    owed_ += static_cast<std::int64_t>(unknown);
    if (unknown == 0 || !is_due(unknown)) {
        return nullptr;
    }
    const std::array<std::size_t, kReferences> counts = count_lists();
    const auto least = std::min_element(counts.begin(), counts.end());
    return is_due(unknown + *least) ? &references_[static_cast<std::size_t>(least - counts.begin())]
                                    : nullptr;
}

// Where the paths end.
template <int Dim>
void SelfProximity<Dim>::take_reference(const Paths<Dim>& paths, Reference& place) {
    ++newest_;
    place.serial = newest_;
    place.positions = paths.to;
    for (std::size_t i = 0; i < place.patches.size(); ++i) {
        if (!patches_at_rest_[i].motions().empty()) {
            place.patches[i] = Patches<Dim>(patches_at_rest_[i], paths.to);
        }
    }
    fit_patches(place, paths);
    set_lanes(lanes_at_newest_, paths.to);
}

template <int Dim>
template <typename Points, typename Mixed>
void SelfProximity<Dim>::search(const Asked& asked, Points& points, Mixed& mixed) {
    const std::size_t unknown = points.look_at_lists() + mixed.look_at_lists();
    if (unknown == 0) {
        return;
    }
    set_lanes(lanes_at_end_, asked.paths.to);
    if (!asked.paths.is_still()) {
        set_lanes(lanes_at_start_, asked.paths.from);
    }
    if (Reference* place = wanted_reference(unknown)) {
        take_reference(asked.paths, *place);
        const std::size_t unlisted = points.list_others() + mixed.list_others();
        owed_ = -kListCost * static_cast<std::int64_t>(unlisted);
    } else {
        points.look_at_others();
        mixed.look_at_others();
    }
}

template <int Dim>
void SelfProximity<Dim>::find(const PositionsView<Dim>& positions, CandidatePairs& pairs) {
    const Asked asked{{positions, positions}, nullptr, distance_};
    fit_trees(asked);
    for (Reference& reference : references_) {
        fit_patches(reference, asked.paths);
    }
    const double squared = distance_ * distance_;
    Search<NearTest<Dim, 1, Dim>, 1, Dim> points(
        *this, {surface_.vertices, surface_.facets, points_}, asked,
        {surface_.vertices, surface_.facets, false, positions, squared, Closest::Anywhere});
    Search<NearTest<Dim, 2, Dim - 1>, 2, Dim - 1> mixed(
        *this, {surface_.edges, surface_.ridges, mixed_}, asked,
        {surface_.edges, surface_.ridges, Dim == 3, positions, squared, Closest::Interior});
    search(asked, points, mixed);
    pairs.points_first = united(points.found());
    pairs.mixed_first = united(mixed.found());
}

template <int Dim>
void SelfProximity<Dim>::find(const PathCover<Dim>& cover,
                              double reach,
                              double measured,
                              CandidatePairs& pairs) {
    const PositionsView<Dim> start = cover.start();
    const PositionsView<Dim> end = cover.end();
    const Asked asked{
        {start, end, mean_shift<Dim>(surface_.vertices, start, end)}, &cover.inflation(), reach};
    fit_trees(asked);
    for (Reference& reference : references_) {
        fit_patches(reference, asked.paths);
    }
    Search<NearOnPaths<Dim, 1, Dim>, 1, Dim> points(
        *this, {surface_.vertices, surface_.facets, points_}, asked,
        {surface_.vertices, surface_.facets, false, cover, reach, measured});
    Search<NearOnPaths<Dim, 2, Dim - 1>, 2, Dim - 1> mixed(
        *this, {surface_.edges, surface_.ridges, mixed_}, asked,
        {surface_.edges, surface_.ridges, Dim == 3, cover, reach, measured});
    search(asked, points, mixed);
    pairs.points_first = joined(points.found());
    pairs.mixed_first = joined(mixed.found());
}

template <int Dim>
std::int64_t SelfProximity<Dim>::bytes() const {
    auto sum = static_cast<std::int64_t>(boxes_.size() * sizeof(Box));
    for (const Tree& tree : trees_) {
        sum += tree.partition.bytes() + tree.patches.bytes();
    }
    for (const Lanes* all : {&lanes_at_newest_, &lanes_at_start_, &lanes_at_end_}) {
        for (const PatchLanes<Dim>& lanes : *all) {
            sum += lanes.bytes();
        }
    }
    for (const Patches<Dim>& patches : patches_at_rest_) {
        sum += patches.bytes();
    }
    for (const Reference& reference : references_) {
        sum += static_cast<std::int64_t>(sizeof(double)) * reference.positions.size();
        for (const Patches<Dim>& patches : reference.patches) {
            sum += patches.bytes();
        }
    }
    for (const std::vector<Row>* rows : {&points_, &mixed_}) {
        for (const Row& row : *rows) {
            sum += static_cast<std::int64_t>(row.known.size() * sizeof(Known)
                                             + row.pairs.size() * sizeof(Candidate));
        }
    }
    return sum;
}

#define PENT_INSTANTIATE(Dim) template class SelfProximity<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
