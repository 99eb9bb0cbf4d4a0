#include "path_candidates.h"

#include "apart.h"
#include "collect_pairs.h"

#include <pent/parallel.h>

#include <algorithm>
#include <cmath>

namespace pent::contact {

namespace {

// Candidates of a motion this many times as long as what is asked for are many more than are of use.
constexpr double kCrude = 3;

// The slack around long ways is this part of them: Newton's method goes less far from one iteration to the
// next, so candidates of the first hold for some that follow.
constexpr double kSlackOfWay = 0.25;

// Distances are measured up to this many times the reach: while no vertex has gone farther than 0.3 times
// the reach from there, no other pair can be within it.
constexpr double kMeasured = 1.6;

// Tests allow for rounding: candidates have to be a superset.
constexpr double kRoundUp = 1 + 1e-9;

template <int Count>
double most_of(const Eigen::VectorXd& values, const Simplices<Count>& simplices, Eigen::Index i) {
    double most = 0;
    for (int a = 0; a < Count; ++a) {
        most = std::max(most, values[simplices(a, i)]);
    }
    return most;
}

float rounded_down(double value) {
    return static_cast<float>(value * (1 - 1e-7));
}

float rounded_up(double value) {
    return static_cast<float>(value * (1 + 1e-7));
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
      least_slack_(slack),
      trees_(bodies.size()) {}

// The time at which the paths are next to the positions in the sense of least squares is as good as any.
template <int Dim>
bool PathCandidates<Dim>::is_covered(const PositionsView<Dim>& positions) const {
    if (positions.cols() != start_.cols() || searches_ == 0) {
        return false;
    }
    const double squared = (end_ - start_).squaredNorm();
    const double along = (positions - start_).cwiseProduct(end_ - start_).sum();
    const double t = squared > 0 ? std::clamp(along / squared, 0.0, 1.0) : 0;
    for (Eigen::Index v = 0; v < positions.cols(); ++v) {
        const Vector<Dim> aside = positions.col(v) - ((1 - t) * start_.col(v) + t * end_.col(v));
        if (!(aside.squaredNorm() <= slack_[v] * slack_[v])) {
            return false;
        }
    }
    return true;
}

// Whether a motion needs few of the candidates, and distances measured elsewhere do not tell which.
template <int Dim>
bool PathCandidates<Dim>::is_crude(const PositionsView<Dim>& from, double way) const {
    const double unmeasured = 0.5 * (kMeasured - 1) * reach_;
    return kCrude * std::max(way, least_slack_) < longest_
           && (from - end_).colwise().squaredNorm().maxCoeff() > unmeasured * unmeasured;
}

template <int Dim>
void PathCandidates<Dim>::cover(const PositionsView<Dim>& from, const PositionsView<Dim>& to) {
    const double way =
        from.cols() == 0 ? 0 : std::sqrt((to - from).colwise().squaredNorm().maxCoeff());
    if (!is_covered(from) || !is_covered(to) || is_crude(from, way)) {
        search(from, to);
        longest_ = std::max(way, least_slack_);
    }
}

template <int Dim>
void PathCandidates<Dim>::cover(const PositionsView<Dim>& positions) {
    if (!is_covered(positions)) {
        search(positions, positions);
        longest_ = least_slack_;
    }
}

template <int Dim>
Travel PathCandidates<Dim>::travel(const PositionsView<Dim>& from,
                                   const PositionsView<Dim>& to) const {
    Travel travel{Eigen::VectorXf(from.cols())};
    for (Eigen::Index v = 0; v < from.cols(); ++v) {
        const double squared = std::max((from.col(v) - end_.col(v)).squaredNorm(),
                                        (to.col(v) - end_.col(v)).squaredNorm());
        travel.of_vertex[v] = rounded_up(std::sqrt(squared));
        travel.most = std::max(travel.most, travel.of_vertex[v]);
    }
    return travel;
}

template <int Dim>
void PathCandidates<Dim>::search(const PositionsView<Dim>& from, const PositionsView<Dim>& to) {
    start_ = from;
    end_ = to;
    way_ = (to - from).colwise().norm();
    slack_ = (kSlackOfWay * way_).cwiseMax(least_slack_);
    boxes_.resize(static_cast<std::size_t>(from.cols()));
    for (Eigen::Index v = 0; v < from.cols(); ++v) {
        Eigen::Matrix<double, Dim, 2> path;
        path << from.col(v), to.col(v);
        boxes_[static_cast<std::size_t>(v)] = box_around<Dim, 2>(path, slack_[v] + 0.5 * reach_);
    }
    update_trees();
    find_pairs();
    ++searches_;
}

template <int Dim>
template <int Count>
std::vector<Box> PathCandidates<Dim>::hulls(const Simplices<Count>& simplices) const {
    constexpr int kChunk = 4096;
    std::vector<Box> hulls(static_cast<std::size_t>(simplices.cols()));
    parallel_for(simplices.cols(), kChunk, [&](Eigen::Index i) {
        Box box = boxes_[simplices(0, i)];
        for (int corner = 1; corner < Count; ++corner) {
            box = hull(box, boxes_[simplices(corner, i)]);
        }
        hulls[static_cast<std::size_t>(i)] = box;
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
CandidateList PathCandidates<Dim>::search(const Simplices<K>& first,
                                          const BoxTree& first_tree,
                                          const Simplices<L>& second,
                                          const BoxTree& second_tree) const {
    struct Found {
        std::vector<Candidate> known;  // distances
        std::vector<Candidate> others;
    };
    const bool is_same_list = &first_tree == &second_tree;
    const double measured = kMeasured * reach_;
    const std::vector<BoxTree::Work> work = BoxTree::split(first_tree, second_tree, kPieces);
    std::vector<Found> found(work.size());
    const auto add = [&](std::uint32_t i, std::uint32_t j, Found& list) {
        if (share_a_vertex<K, L>(first, i, second, j)) {
            return;
        }
        if (is_same_list && j < i) {
            std::swap(i, j);
        }
        // Boxes around whole paths are crude: what counts is how near the two come at any one time.
        const double apart =
            (reach_ + most_of<K>(slack_, first, i) + most_of<L>(slack_, second, j)) * kRoundUp;
        const Corners<Dim, K> a = gather<Dim, K>(first, i, end_);
        const Corners<Dim, L> b = gather<Dim, L>(second, j, end_);
        if (are_paths_apart<Dim, K, L>(gather<Dim, K>(first, i, start_), a,
                                       gather<Dim, L>(second, j, start_), b, apart * apart)) {
            return;
        }
        ClosestPointSearch<Dim, K, L> search(a, b, measured * measured);
        const bool is_known =
            !are_boxes_apart<Dim, K, L>(a, b, measured * measured) && search.run();
        const double distance = is_known ? std::sqrt(search.best().distance_squared) : measured;
        if (distance < apart + most_of<K>(way_, first, i) + most_of<L>(way_, second, j)) {
            (is_known ? list.known : list.others).push_back({i, j, rounded_down(distance)});
        }
    };
    parallel_for(work.size(), [&](std::size_t piece) {
        BoxTree::for_each_overlap(
            first_tree, second_tree, work[piece],
            [&](std::uint32_t i, std::uint32_t j) { add(i, j, found[piece]); });
    });
    CandidateList all;
    for (const Found& list : found) {
        all.pairs.insert(all.pairs.end(), list.known.begin(), list.known.end());
    }
    all.known_count = all.pairs.size();
    for (const Found& list : found) {
        all.pairs.insert(all.pairs.end(), list.others.begin(), list.others.end());
    }
    return all;
}

template class PathCandidates<3>;
template class PathCandidates<4>;

}  // namespace pent::contact
