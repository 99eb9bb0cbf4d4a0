#include "candidates.h"

#include "apart.h"
#include "near_pairs.h"
#include "pairs_within.h"

#include <pent/stopwatch.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace pent::contact {

namespace {

// With a barrier candidates hold at least until a vertex has left its path by this part of the
// distance of contact. More makes searches fewer and dearer; at twice as much and at half of it
// they cost as much.
constexpr double kInflation = 0.25;

// Candidates of a motion this many times as long as what is asked for are many more than are of
// use.
constexpr double kTooCoarse = 3;

// The inflation around long paths is this part of them: Newton's method goes less far from one
// iteration to the next, so candidates of the first hold for some that follow.
constexpr double kInflationOfPath = 0.25;

// Distances are measured up to this many times the activation distance: while no vertex has gone
// farther than 0.3 times that from there, no other pair can be within it.
constexpr double kMeasured = 1.6;

// Tests allow for rounding: candidates have to be a superset.
constexpr double kRoundUp = 1 + 1e-9;

// Pairs of a penalty kept for another evaluation, at most: 96 MB.
constexpr std::size_t kMaxKept = 8'000'000;

template <int Count>
double max_of(const Eigen::VectorXd& values, const Simplices<Count>& simplices, Eigen::Index i) {
    double max = 0;
    for (int a = 0; a < Count; ++a) {
        max = std::max(max, values[simplices(a, i)]);
    }
    return max;
}

float rounded_up(double value) {
    return static_cast<float>(value * (1 + 1e-7));
}

// Of pairs found in two ways, each once; both are ascending.
CandidateList united(const CandidateList& a, const CandidateList& b) {
    CandidateList all;
    all.overlaps = static_cast<std::int64_t>(a.pairs.size()) + b.overlaps;
    std::set_union(a.pairs.begin(), a.pairs.end(), b.pairs.begin(), b.pairs.end(),
                   std::back_inserter(all.pairs), is_before);
    for (Candidate& pair : all.pairs) {
        pair.distance = 0;  // those that were near at rest have not been measured
    }
    return all;
}

// What the search along paths finds: candidates whose distance at the end is known, and others.
struct Found {
    std::vector<Candidate> known;
    std::vector<Candidate> others;
    std::int64_t overlaps = 0;
};

CandidateList joined_by_distance(const std::vector<Found>& found) {
    CandidateList all;
    std::size_t count = 0;
    for (const Found& list : found) {
        count += list.known.size() + list.others.size();
        all.overlaps += list.overlaps;
    }
    all.pairs.reserve(count);
    for (const Found& list : found) {
        all.pairs.insert(all.pairs.end(), list.known.begin(), list.known.end());
    }
    all.known_count = all.pairs.size();
    for (const Found& list : found) {
        all.pairs.insert(all.pairs.end(), list.others.begin(), list.others.end());
    }
    return all;
}

}  // namespace

template <int Dim>
Candidates<Dim>::Candidates(const Colliders<Dim>& colliders)
    : colliders_(colliders),
      activation_distance_(colliders.scene().options.distance),
      min_inflation_(colliders.scene().options.margin),
      trees_(static_cast<std::size_t>(colliders.count())),
      near_at_rest_(static_cast<std::size_t>(colliders.count())) {
    if (!is_penalty()) {
        const ContactOptions& options = colliders.scene().options;
        activation_distance_ = options.distance + options.separation;
        min_inflation_ = kInflation * options.distance;
    }
}

// The time at which the paths are next to the positions in the sense of least squares is as good as
// any.
template <int Dim>
bool Candidates<Dim>::is_covered(const PositionsView<Dim>& positions) const {
    if (positions.cols() != start_.cols() || work_.searches == 0) {
        return false;
    }
    const double squared = (end_ - start_).squaredNorm();
    const double along = (positions - start_).cwiseProduct(end_ - start_).sum();
    const double t = squared > 0 ? std::clamp(along / squared, 0.0, 1.0) : 0;
    for (Eigen::Index v = 0; v < positions.cols(); ++v) {
        const Vector<Dim> aside = positions.col(v) - ((1 - t) * start_.col(v) + t * end_.col(v));
        if (!(aside.squaredNorm() <= inflation_[v] * inflation_[v])) {
            return false;
        }
    }
    return true;
}

// Whether a motion needs few of the candidates, and distances measured elsewhere do not tell which.
template <int Dim>
bool Candidates<Dim>::is_too_coarse(const PositionsView<Dim>& from, double path_length) const {
    const double unmeasured = 0.5 * (kMeasured - 1) * activation_distance_;
    return kTooCoarse * std::max(path_length, min_inflation_) < longest_
           && (from - end_).colwise().squaredNorm().maxCoeff() > unmeasured * unmeasured;
}

template <int Dim>
void Candidates<Dim>::cover(const PositionsView<Dim>& from, const PositionsView<Dim>& to) {
    const double path_length =
        from.cols() == 0 ? 0 : std::sqrt((to - from).colwise().squaredNorm().maxCoeff());
    if (!is_covered(from) || !is_covered(to) || is_too_coarse(from, path_length)) {
        search(from, to);
        longest_ = std::max(path_length, min_inflation_);
    }
}

template <int Dim>
void Candidates<Dim>::cover(const PositionsView<Dim>& positions) {
    if (!is_covered(positions)) {
        search(positions, positions);
        longest_ = min_inflation_;
    } else if (has_fresh_pairs_within()) {
        fit_trees({positions, positions});
    }
    if (has_fresh_pairs_within()) {
        find_pairs_within(positions);
    }
}

template <int Dim>
void Candidates<Dim>::drop_what_is_not_kept() {
    std::size_t count = 0;
    for (const CandidatePairs& pairs : pairs_) {
        count += pairs.is_self() ? 0 : pairs.size();
    }
    if (is_penalty() && (min_inflation_ == 0 || count > kMaxKept)) {
        start_.resize(Dim, 0);
        end_.resize(Dim, 0);
        std::vector<CandidatePairs>().swap(pairs_);
    }
}

template <int Dim>
Displacement Candidates<Dim>::displacement(const PositionsView<Dim>& from,
                                           const PositionsView<Dim>& to) const {
    Displacement displacement{Eigen::VectorXf(from.cols())};
    for (Eigen::Index v = 0; v < from.cols(); ++v) {
        const double squared = std::max((from.col(v) - end_.col(v)).squaredNorm(),
                                        (to.col(v) - end_.col(v)).squaredNorm());
        displacement.of_vertex[v] = rounded_up(std::sqrt(squared));
        displacement.max = std::max(displacement.max, displacement.of_vertex[v]);
    }
    return displacement;
}

template <int Dim>
void Candidates<Dim>::search(const PositionsView<Dim>& from, const PositionsView<Dim>& to) {
    start_ = from;
    end_ = to;
    path_length_ = (to - from).colwise().norm();
    inflation_ = (kInflationOfPath * path_length_).cwiseMax(min_inflation_);
    fit_trees({from, to});
    find_pairs();
    ++work_.searches;
}

template <int Dim>
void Candidates<Dim>::fit_boxes(const Paths& paths) {
    constexpr std::size_t kChunk = 4096;
    boxes_.resize(static_cast<std::size_t>(paths.from.cols()));
    for (int i = 0; i < colliders_.count(); ++i) {
        const Simplices<1>& vertices = colliders_.surface(i).vertices;
        const double reach = 0.5 * activation_distance_ + colliders_.radius(i);
        for_each_chunk(static_cast<std::size_t>(vertices.cols()), kChunk,
                       [&](std::size_t /*chunk*/, std::size_t begin, std::size_t end) {
                           for (std::size_t k = begin; k < end; ++k) {
                               const std::uint32_t v = vertices(0, static_cast<Eigen::Index>(k));
                               Eigen::Matrix<double, Dim, 2> path;
                               path << paths.from.col(v), paths.to.col(v);
                               boxes_[v] = box_around<Dim, 2>(path, inflation_[v] + reach);
                           }
                       });
    }
}

template <int Dim>
bool Candidates<Dim>::do_overlap(int a, int b) const {
    const BoxTree& first = trees(a).template tree<1>();
    const BoxTree& second = trees(b).template tree<1>();
    return !first.is_empty() && !second.is_empty() && overlap(first.root_box(), second.root_box());
}

// Those of vertices tell which bodies may meet: the others need no more.
template <int Dim>
void Candidates<Dim>::fit_trees(const Paths& paths) {
    const Stopwatch watch;
    const int count = colliders_.count();
    std::vector<bool> is_alone(static_cast<std::size_t>(count), true);
    if (count > 1 || colliders_.scene().options.self) {
        fit_boxes(paths);
        for (int a = 0; a < count; ++a) {
            trees_[static_cast<std::size_t>(a)].update_vertices(colliders_.surface(a), boxes_);
        }
        for (int a = 0; a < count; ++a) {
            for (int b = a; b < count; ++b) {
                if (colliders_.can_meet(a, b) && do_overlap(a, b)) {
                    is_alone[static_cast<std::size_t>(a)] = false;
                    is_alone[static_cast<std::size_t>(b)] = false;
                }
            }
        }
    }
    for (int a = 0; a < count; ++a) {
        if (!is_alone[static_cast<std::size_t>(a)]) {
            trees_[static_cast<std::size_t>(a)].update_faces(colliders_.surface(a), boxes_);
        }
    }
    work_.tree_seconds += watch.seconds();
}

template <int Dim>
void Candidates<Dim>::find_pairs() {
    pairs_.clear();
    for (int a = 0; a < colliders_.count(); ++a) {
        for (int b = a; b < colliders_.count(); ++b) {
            if (!colliders_.can_meet(a, b) || !do_overlap(a, b)) {
                continue;
            }
            CandidatePairs pairs{.first = a, .second = b};
            if (a != b || !has_fresh_pairs_within()) {
                pairs.points_first = search<1, Dim>(a, b);
                pairs.mixed_first = search<2, Dim - 1>(a, b);
            }
            if (a != b) {
                pairs.points_second = search<1, Dim>(b, a);
                if constexpr (Dim > 3) {
                    pairs.mixed_second = search<2, Dim - 1>(b, a);
                }
            }
            work_.overlaps += pairs.overlaps();
            pairs_.push_back(std::move(pairs));
        }
    }
}

template <int Dim>
template <int K, int L>
CandidateList Candidates<Dim>::search(int first, int second) const {
    const Simplices<K>& a = colliders_.surface(first).template simplices<K>();
    const Simplices<L>& b = colliders_.surface(second).template simplices<L>();
    const BoxTree& first_tree = trees(first).template tree<K>();
    const BoxTree& second_tree = trees(second).template tree<L>();
    const bool is_same_list = &first_tree == &second_tree;
    const double reach = this->reach(first, second);
    const PositionsView<Dim> end = end_;
    if (path_length_.isZero(0)) {
        const double limit = (reach + 2 * min_inflation_) * (is_exact() ? 1 : kRoundUp);
        return joined(walk_overlaps<CandidateList>(
            first_tree, second_tree,
            NearTest<Dim, K, L>{a, b, is_same_list, end, limit * limit,
                                is_exact() && K == 2 ? Closest::Interior : Closest::Anywhere}));
    }
    const PositionsView<Dim> start = start_;
    const double measured = reach + (kMeasured - 1) * activation_distance_;
    const auto add = [&](std::uint32_t i, std::uint32_t j, Found& list) {
        ++list.overlaps;
        if (share_a_vertex<K, L>(a, i, b, j)) {
            return;
        }
        if (is_same_list && j < i) {
            std::swap(i, j);
        }
        // Boxes around whole paths are crude: what counts is how near the two come at any one time.
        const double near =
            (reach + max_of<K>(inflation_, a, i) + max_of<L>(inflation_, b, j)) * kRoundUp;
        const Corners<Dim, K> p = gather<Dim, K>(a, i, end);
        const Corners<Dim, L> q = gather<Dim, L>(b, j, end);
        if (are_paths_apart<Dim, K, L>(gather<Dim, K>(a, i, start), p, gather<Dim, L>(b, j, start),
                                       q, near * near)) {
            return;
        }
        ClosestPointSearch<Dim, K, L> closest(p, q, measured * measured);
        const bool is_known =
            !are_boxes_apart<Dim, K, L>(p, q, measured * measured) && closest.run();
        const double distance = is_known ? std::sqrt(closest.best().distance_squared) : measured;
        if (distance < near + max_of<K>(path_length_, a, i) + max_of<L>(path_length_, b, j)) {
            (is_known ? list.known : list.others).push_back({i, j, rounded_down(distance)});
        }
    };
    return joined_by_distance(walk_overlaps<Found>(first_tree, second_tree, add));
}

template <int Dim>
void Candidates<Dim>::find_pairs_within(const PositionsView<Dim>& positions) {
    for (CandidatePairs& pairs : pairs_) {
        if (pairs.is_self()) {
            find_pairs_within(positions, pairs);
            work_.overlaps += pairs.overlaps();
        }
    }
}

template <int Dim>
void Candidates<Dim>::find_pairs_within(const PositionsView<Dim>& positions,
                                        CandidatePairs& pairs) {
    const auto body = static_cast<std::size_t>(pairs.first);
    const Surface<Dim>& surface = colliders_.surface(pairs.first);
    const double distance = activation_distance_;
    std::optional<RestProximityPairs>& near = near_at_rest_[body];
    if (!near) {
        near = find_rest_proximity_pairs<Dim>(surface, colliders_.rest(), distance);
    }
    SurfaceTrees<Dim>& trees = trees_[body];
    if (near->rest_distance == 0) {
        pairs.points_first = near_pairs<Dim, 1, Dim>({surface.vertices, trees.template tree<1>()},
                                                     {surface.facets, trees.template tree<Dim>()},
                                                     positions, distance);
        pairs.mixed_first =
            near_pairs<Dim, 2, Dim - 1>({surface.edges, trees.template tree<2>()},
                                        {surface.ridges, trees.template tree<Dim - 1>()}, positions,
                                        distance, Closest::Interior);
        return;
    }
    trees.update_patches(surface, colliders_.rest(), positions);
    pairs.points_first = united(
        near->points, pairs_within<Dim, 1, Dim>(trees.template patched<1>(surface),
                                                trees.template patched<Dim>(surface), positions,
                                                distance, near->rest_distance, Closest::Anywhere));
    pairs.mixed_first = united(near->mixed, pairs_within<Dim, 2, Dim - 1>(
                                                trees.template patched<2>(surface),
                                                trees.template patched<Dim - 1>(surface), positions,
                                                distance, near->rest_distance, Closest::Interior));
}

template <int Dim>
SearchWork Candidates<Dim>::work() const {
    SearchWork work = work_;
    for (const SurfaceTrees<Dim>& trees : trees_) {
        work.trees_built += trees.built();
        work.trees_refit += trees.refit();
    }
    return work;
}

template <int Dim>
std::int64_t Candidates<Dim>::bytes() const {
    std::int64_t sum = 0;
    for (const CandidatePairs& pairs : pairs_) {
        sum += static_cast<std::int64_t>(pairs.size() * sizeof(Candidate));
    }
    for (const SurfaceTrees<Dim>& trees : trees_) {
        sum += trees.bytes();
    }
    for (const std::optional<RestProximityPairs>& near : near_at_rest_) {
        sum += near ? near->bytes() : 0;
    }
    return sum
           + static_cast<std::int64_t>(sizeof(double))
                 * (start_.size() + end_.size() + path_length_.size() + inflation_.size())
           + static_cast<std::int64_t>(boxes_.size() * sizeof(Box));
}

template class Candidates<3>;
template class Candidates<4>;

}  // namespace pent::contact
