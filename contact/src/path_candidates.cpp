#include "path_candidates.h"

#include "apart.h"
#include "collect_pairs.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

namespace pent::contact {

namespace {

// Candidates of a motion this many times as long as what is asked for are searched anew: there are many
// more of them than are of use.
constexpr double kCrude = 3;

// The slack around long ways is this part of them. Newton's method goes less far from one iteration to
// the next, so candidates of the first hold for some that follow.
constexpr double kSlackOfWay = 0.25;

// Where vertices can go less far than this times the reach, candidates are those whose distance is
// within it. Beyond, nearly all whose boxes are near enough would be, and distances cost more.
constexpr double kShortWay = 1;

// The narrow test allows for rounding: candidates have to be a superset.
constexpr double kRoundUp = 1 + 1e-9;

template <int Count>
double most_travel(const Eigen::VectorXd& travel,
                   const Simplices<Count>& simplices,
                   Eigen::Index i) {
    double most = 0;
    for (int a = 0; a < Count; ++a) {
        most = std::max(most, travel[simplices(a, i)]);
    }
    return most;
}

template <int Dim>
bool is_inside(const Vector<Dim>& point, const Box& box) {
    bool is_inside = true;
    for (int axis = 0; axis < Dim; ++axis) {
        is_inside &= static_cast<double>(box.low[axis]) <= point[axis]
                     && point[axis] <= static_cast<double>(box.high[axis]);
    }
    return is_inside;
}

bool is_before(const IndexPair& a, const IndexPair& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
}

}  // namespace

template <int Dim>
PathCandidates<Dim>::PathCandidates(const std::vector<ContactBody<Dim>>& bodies,
                                    std::vector<bool> is_held,
                                    bool self,
                                    double reach,
                                    double slack)
    : bodies_(bodies),
      is_held_(std::move(is_held)),
      self_(self),
      reach_(reach),
      slack_(slack),
      trees_(bodies.size()) {}

template <int Dim>
bool PathCandidates<Dim>::is_covered(const PositionsView<Dim>& positions) const {
    if (positions.cols() != start_.cols() || searches_ == 0) {
        return false;
    }
    for (Eigen::Index v = 0; v < positions.cols(); ++v) {
        if (!is_inside<Dim>(positions.col(v), free_boxes_[static_cast<std::size_t>(v)])) {
            return false;
        }
    }
    return true;
}

template <int Dim>
void PathCandidates<Dim>::cover(const PositionsView<Dim>& from, const PositionsView<Dim>& to) {
    const double way =
        from.cols() == 0 ? 0 : std::sqrt((to - from).colwise().squaredNorm().maxCoeff());
    const bool is_crude = kCrude * std::max(way, slack_) < longest_;
    if (is_crude || !is_covered(from) || !is_covered(to)) {
        search(from, to, std::max(slack_, kSlackOfWay * way));
        longest_ = std::max(way, slack_);
    }
}

template <int Dim>
void PathCandidates<Dim>::cover(const PositionsView<Dim>& positions) {
    if (!is_covered(positions)) {
        search(positions, positions, slack_);
        longest_ = slack_;
    }
}

template <int Dim>
void PathCandidates<Dim>::search(const PositionsView<Dim>& from,
                                 const PositionsView<Dim>& to,
                                 double slack) {
    const Eigen::Index count = from.cols();
    start_ = from;
    boxes_.resize(static_cast<std::size_t>(count));
    free_boxes_.resize(static_cast<std::size_t>(count));
    travel_.resize(count);
    for (Eigen::Index v = 0; v < count; ++v) {
        Eigen::Matrix<double, Dim, 2> path;
        path << from.col(v), to.col(v);
        const auto i = static_cast<std::size_t>(v);
        boxes_[i] = box_around<Dim, 2>(path, slack + 0.5 * reach_);
        free_boxes_[i] = box_around<Dim, 2>(path, slack);
        double squared = 0;
        for (int axis = 0; axis < Dim; ++axis) {
            const double below = from(axis, v) - static_cast<double>(free_boxes_[i].low[axis]);
            const double above = static_cast<double>(free_boxes_[i].high[axis]) - from(axis, v);
            squared += std::max(below * below, above * above);
        }
        travel_[v] = std::sqrt(squared);
    }
    update_trees();
    find_pairs();
    ++searches_;
}

template <int Dim>
template <int Count>
std::vector<Box> PathCandidates<Dim>::hulls(const Simplices<Count>& simplices) const {
    constexpr Eigen::Index kChunk = 4096;
    std::vector<Box> hulls(static_cast<std::size_t>(simplices.cols()));
    tbb::parallel_for(Eigen::Index{0}, (simplices.cols() + kChunk - 1) / kChunk,
                      [&](Eigen::Index c) {
                          for (Eigen::Index i = c * kChunk;
                               i < std::min((c + 1) * kChunk, simplices.cols()); ++i) {
                              Box box = boxes_[simplices(0, i)];
                              for (int corner = 1; corner < Count; ++corner) {
                                  box = hull(box, boxes_[simplices(corner, i)]);
                              }
                              hulls[static_cast<std::size_t>(i)] = box;
                          }
                      });
    return hulls;
}

template <int Dim>
void PathCandidates<Dim>::update_trees() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Surface<Dim>& surface = bodies_[i].surface;
        trees_[i].vertices.update(hulls<1>(surface.vertices));
        trees_[i].edges.update(hulls<2>(surface.edges));
        trees_[i].facets.update(hulls<Dim>(surface.facets));
        if constexpr (Dim > 3) {
            trees_[i].ridges.update(hulls<Dim - 1>(surface.ridges));
        }
    }
}

template <int Dim>
void PathCandidates<Dim>::find_pairs() {
    pairs_.clear();
    const auto ridges_of = [](const Trees& trees) -> const BoxTree& {
        return Dim > 3 ? trees.ridges.tree() : trees.edges.tree();
    };
    for (std::size_t a = 0; a < bodies_.size(); ++a) {
        for (std::size_t b = a; b < bodies_.size(); ++b) {
            const bool is_self = a == b;
            if ((is_self && !self_)
                || !overlap(trees_[a].vertices.tree().root_box(),
                            trees_[b].vertices.tree().root_box())) {
                continue;
            }
            const Surface<Dim>& first = bodies_[a].surface;
            const Surface<Dim>& second = bodies_[b].surface;
            CandidatePairs pairs;
            pairs.first_body = static_cast<int>(a);
            pairs.second_body = static_cast<int>(b);
            pairs.points_first = search<1, Dim>(first.vertices, trees_[a].vertices.tree(),
                                                second.facets, trees_[b].facets.tree());
            pairs.mixed_first = search<2, Dim - 1>(first.edges, trees_[a].edges.tree(),
                                                   second.ridges, ridges_of(trees_[b]));
            if (!is_self) {
                pairs.points_second = search<1, Dim>(second.vertices, trees_[b].vertices.tree(),
                                                     first.facets, trees_[a].facets.tree());
                if constexpr (Dim > 3) {
                    pairs.mixed_second = search<2, Dim - 1>(second.edges, trees_[b].edges.tree(),
                                                            first.ridges, ridges_of(trees_[a]));
                }
            }
            pairs_.push_back(std::move(pairs));
        }
    }
}

template <int Dim>
template <int K, int L>
std::vector<IndexPair> PathCandidates<Dim>::search(const Simplices<K>& first,
                                                   const BoxTree& first_tree,
                                                   const Simplices<L>& second,
                                                   const BoxTree& second_tree) const {
    const bool is_same_list = &first_tree == &second_tree;
    const std::vector<BoxTree::Work> work = BoxTree::split(first_tree, second_tree, kPieces);
    std::vector<std::vector<IndexPair>> found(work.size());
    const auto add = [&](std::uint32_t i, std::uint32_t j, std::vector<IndexPair>& list) {
        if (share_a_vertex<K, L>(first, i, second, j)) {
            return;
        }
        if (is_same_list && j < i) {
            std::swap(i, j);
        }
        // Boxes are crude: what counts is how near the simplices are now, and how far they can go.
        const double way = most_travel<K>(travel_, first, i) + most_travel<L>(travel_, second, j);
        const double most = (reach_ + way) * kRoundUp;
        const Corners<Dim, K> a = gather<Dim, K>(first, i, start_);
        const Corners<Dim, L> b = gather<Dim, L>(second, j, start_);
        if (!are_boxes_apart<Dim, K, L>(a, b, most * most)
            && (way > kShortWay * reach_
                || ClosestPointSearch<Dim, K, L>(a, b, most * most).run())) {
            list.push_back({i, j});
        }
    };
    tbb::parallel_for(
        std::size_t{0}, work.size(),
        [&](std::size_t piece) {
            BoxTree::for_each_overlap(
                first_tree, second_tree, work[piece],
                [&](std::uint32_t i, std::uint32_t j) { add(i, j, found[piece]); });
        },
        tbb::simple_partitioner());
    std::vector<IndexPair> all;
    for (const std::vector<IndexPair>& list : found) {
        all.insert(all.end(), list.begin(), list.end());
    }
    std::sort(all.begin(), all.end(), is_before);
    return all;
}

template class PathCandidates<3>;
template class PathCandidates<4>;

}  // namespace pent::contact
