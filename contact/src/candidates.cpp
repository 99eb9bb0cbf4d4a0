#include "candidates.h"

#include "apart.h"

#include <pent/stopwatch.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

// Instead of how far a search went where there was none.
constexpr double kNever = -1;

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
      longest_(static_cast<std::size_t>(colliders.count()), kNever),
      trees_(static_cast<std::size_t>(colliders.count())),
      trees_within_(static_cast<std::size_t>(colliders.count())),
      proximity_(static_cast<std::size_t>(colliders.count())) {
    if (!is_penalty()) {
        const ContactOptions& options = colliders.scene().options;
        activation_distance_ = options.distance + options.separation;
        min_inflation_ = kInflation * options.distance;
    }
    Eigen::Index count = 0;
    for (int i = 0; i < colliders.count(); ++i) {
        const Simplices<1>& vertices = colliders.surface(i).vertices;
        vertices_.conservativeResize(1, count + vertices.cols());
        vertices_.rightCols(vertices.cols()) = vertices;
        count += vertices.cols();
    }
}

// Whether a motion needs few of the candidates, and distances measured elsewhere do not tell which.
template <int Dim>
bool Candidates<Dim>::is_too_coarse(double searched, double measured_from, double asked) const {
    const double unmeasured = 0.5 * (kMeasured - 1) * activation_distance_;
    return kTooCoarse * std::max(asked, min_inflation_) < searched && measured_from > unmeasured;
}

template <int Dim>
void Candidates<Dim>::cover(const PositionsView<Dim>& from, const PositionsView<Dim>& to) {
    const double path_length = longest_path<Dim>(vertices_, from, to);
    if (!between_.covers(vertices_, from) || !between_.covers(vertices_, to)
        || is_too_coarse(longest_between_, longest_path<Dim>(vertices_, between_.end(), from),
                         path_length)) {
        longest_between_ = std::max(path_length, min_inflation_);
        search_between({from, to, mean_shift<Dim>(vertices_, from, to)});
    }
    for (int body = 0; body < colliders_.count(); ++body) {
        if (colliders_.can_meet(body, body) && !does_cover(body, {from, to})) {
            search_within(body, {from, to});
        }
    }
}

template <int Dim>
bool Candidates<Dim>::does_cover(int body, const Paths& paths) const {
    const Simplices<1>& vertices = colliders_.surface(body).vertices;
    const double searched = longest_[static_cast<std::size_t>(body)];
    return searched >= 0 && within_.covers(vertices, paths.from)
           && within_.covers(vertices, paths.to)
           && !is_too_coarse(searched, longest_path<Dim>(vertices, within_.end(), paths.from),
                             longest_path<Dim>(vertices, paths.from, paths.to));
}

template <int Dim>
void Candidates<Dim>::cover(const PositionsView<Dim>& positions) {
    if (!between_.covers(vertices_, positions)) {
        longest_between_ = min_inflation_;
        search_between({positions, positions});
    }
    for (int body = 0; body < colliders_.count(); ++body) {
        if (!colliders_.can_meet(body, body)) {
            continue;
        }
        if (is_penalty()) {
            find_pairs_within(body, positions);
        } else if (longest_[static_cast<std::size_t>(body)] < 0
                   || !within_.covers(colliders_.surface(body).vertices, positions)) {
            search_within(body, {positions, positions});
        }
    }
}
template <int Dim>
void Candidates<Dim>::drop_what_is_not_kept() {
    std::size_t count = 0;
    for (const CandidatePairs& pairs : pairs_) {
        count += pairs.is_self() ? 0 : pairs.size();
    }
    if (is_penalty() && (min_inflation_ == 0 || count > kMaxKept)) {
        between_.clear();
        std::vector<CandidatePairs>().swap(pairs_);
    }
}

template <int Dim>
Displacements Candidates<Dim>::displacements(const PositionsView<Dim>& from,
                                             const PositionsView<Dim>& to) const {
    Displacements all;
    all.between.of_vertex.resize(from.cols());
    all.between.max = between_.displacement(vertices_, from, to, all.between.of_vertex);
    for (int body = 0; body < colliders_.count(); ++body) {
        if (longest_[static_cast<std::size_t>(body)] >= 0) {
            all.within.of_vertex.resize(from.cols());
            all.within.max =
                std::max(all.within.max, within_.displacement(colliders_.surface(body).vertices,
                                                              from, to, all.within.of_vertex));
        }
    }
    return all;
}

template <int Dim>
void Candidates<Dim>::search_between(const Paths& paths) {
    between_.set(vertices_, paths.from, paths.to, min_inflation_, kInflationOfPath);
    fit_trees(paths);
    std::erase_if(pairs_, [](const CandidatePairs& pairs) { return !pairs.is_self(); });
    find_pairs_between();
    ++work_.searches;
}

template <int Dim>
void Candidates<Dim>::search_within(int body, const Paths& paths) {
    const Stopwatch watch;
    const Surface<Dim>& surface = colliders_.surface(body);
    const auto place = static_cast<std::size_t>(body);
    const Vector<Dim> drift = mean_shift<Dim>(surface.vertices, paths.from, paths.to);
    longest_[place] =
        std::max(longest_path<Dim>(surface.vertices, paths.from, paths.to), min_inflation_);
    within_.set(surface.vertices, paths.from, paths.to, min_inflation_, kInflationOfPath);
    boxes_.resize(static_cast<std::size_t>(paths.from.cols()));
    fit_boxes(body, {paths.from, paths.to, drift}, within_);
    trees_within_[place].update_vertices(surface, boxes_);
    trees_within_[place].update_faces(surface, boxes_);
    work_.tree_seconds += watch.seconds();
    CandidatePairs pairs{.first = body, .second = body};
    pairs.points_first = search<1, Dim>(body, body);
    pairs.mixed_first = search<2, Dim - 1>(body, body);
    work_.overlaps += pairs.overlaps();
    ++work_.searches;
    insert(std::move(pairs));
}

// In the place of what is there of the same colliders; lists are by these.
template <int Dim>
void Candidates<Dim>::insert(CandidatePairs pairs) {
    const auto key = [](const CandidatePairs& p) { return std::pair(p.first, p.second); };
    const auto place = std::lower_bound(
        pairs_.begin(), pairs_.end(), pairs,
        [&](const CandidatePairs& a, const CandidatePairs& b) { return key(a) < key(b); });
    if (place != pairs_.end() && key(*place) == key(pairs)) {
        *place = std::move(pairs);
    } else {
        pairs_.insert(place, std::move(pairs));
    }
}

// Less what all shift.
template <int Dim>
void Candidates<Dim>::fit_boxes(int collider, const Paths& paths, const PathCover<Dim>& cover) {
    constexpr std::size_t kChunk = 4096;
    const Simplices<1>& vertices = colliders_.surface(collider).vertices;
    const double reach = 0.5 * activation_distance_ + colliders_.radius(collider);
    for_each_chunk(static_cast<std::size_t>(vertices.cols()), kChunk,
                   [&](std::size_t /*chunk*/, std::size_t begin, std::size_t end) {
                       for (std::size_t k = begin; k < end; ++k) {
                           const std::uint32_t v = vertices(0, static_cast<Eigen::Index>(k));
                           Eigen::Matrix<double, Dim, 2> path;
                           path << paths.from.col(v), paths.to.col(v) - paths.drift;
                           boxes_[v] = box_around<Dim, 2>(path, cover.inflation()[v] + reach);
                       }
                   });
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
    if (count > 1) {
        boxes_.resize(static_cast<std::size_t>(paths.from.cols()));
        for (int a = 0; a < count; ++a) {
            fit_boxes(a, paths, between_);
            trees_[static_cast<std::size_t>(a)].update_vertices(colliders_.surface(a), boxes_);
        }
        for (int a = 0; a < count; ++a) {
            for (int b = a + 1; b < count; ++b) {
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
void Candidates<Dim>::find_pairs_between() {
    for (int a = 0; a < colliders_.count(); ++a) {
        for (int b = a + 1; b < colliders_.count(); ++b) {
            if (!colliders_.can_meet(a, b) || !do_overlap(a, b)) {
                continue;
            }
            CandidatePairs pairs{.first = a, .second = b};
            pairs.points_first = search<1, Dim>(a, b);
            pairs.mixed_first = search<2, Dim - 1>(a, b);
            pairs.points_second = search<1, Dim>(b, a);
            if constexpr (Dim > 3) {
                pairs.mixed_second = search<2, Dim - 1>(b, a);
            }
            work_.overlaps += pairs.overlaps();
            insert(std::move(pairs));
        }
    }
}

template <int Dim>
template <int K, int L>
CandidateList Candidates<Dim>::search(int first, int second) const {
    const Simplices<K>& a = colliders_.surface(first).template simplices<K>();
    const Simplices<L>& b = colliders_.surface(second).template simplices<L>();
    const bool is_within = first == second;
    const auto& all_trees = is_within ? trees_within_ : trees_;
    const BoxTree& first_tree = all_trees[static_cast<std::size_t>(first)].template tree<K>();
    const BoxTree& second_tree = all_trees[static_cast<std::size_t>(second)].template tree<L>();
    const bool is_same_list = &first_tree == &second_tree;
    const double reach = this->reach(first, second);
    const PathCover<Dim>& cover = is_within ? within_ : between_;
    const Eigen::VectorXd& inflation = cover.inflation();
    const PositionsView<Dim> end = cover.end();
    if (is_penalty()) {
        const double limit = (reach + 2 * min_inflation_) * (is_exact() ? 1 : kRoundUp);
        return joined(walk_overlaps<CandidateList>(
            first_tree, second_tree,
            NearTest<Dim, K, L>{a, b, is_same_list, end, limit * limit,
                                is_exact() && K == 2 ? Closest::Interior : Closest::Anywhere}));
    }
    const PositionsView<Dim> start = cover.start();
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
            (reach + max_of<K>(inflation, a, i) + max_of<L>(inflation, b, j)) * kRoundUp;
        const Corners<Dim, K> p_start = gather<Dim, K>(a, i, start);
        const Corners<Dim, L> q_start = gather<Dim, L>(b, j, start);
        const Corners<Dim, K> p = gather<Dim, K>(a, i, end);
        const Corners<Dim, L> q = gather<Dim, L>(b, j, end);
        if (are_paths_apart<Dim, K, L>(p_start, p, q_start, q, near * near)
            || are_paths_apart_along_middles<Dim, K, L>(p_start, p, q_start, q, near)) {
            return;
        }
        ClosestPointSearch<Dim, K, L> closest(p, q, measured * measured);
        const bool is_known =
            !are_boxes_apart<Dim, K, L>(p, q, measured * measured) && closest.run();
        const double distance = is_known ? std::sqrt(closest.best().distance_squared) : measured;
        if (distance < near + relative_path_length<Dim, K, L>(p_start, p, q_start, q) * kRoundUp) {
            (is_known ? list.known : list.others).push_back({i, j, rounded_down(distance)});
        }
    };
    return joined_by_distance(walk_overlaps<Found>(first_tree, second_tree, add));
}

template <int Dim>
void Candidates<Dim>::find_pairs_within(int body, const PositionsView<Dim>& positions) {
    std::optional<SelfProximity<Dim>>& proximity = proximity_[static_cast<std::size_t>(body)];
    if (!proximity) {
        proximity.emplace(colliders_.surface(body), colliders_.rest(), activation_distance_);
    }
    CandidatePairs pairs{.first = body, .second = body};
    proximity->find(positions, pairs);
    work_.overlaps += pairs.overlaps();
    insert(std::move(pairs));
}

template <int Dim>
SearchWork Candidates<Dim>::work() const {
    SearchWork work = work_;
    for (const auto* all : {&trees_, &trees_within_}) {
        for (const SurfaceTrees<Dim>& trees : *all) {
            work.trees_built += trees.built();
            work.trees_refit += trees.refit();
        }
    }
    for (const std::optional<SelfProximity<Dim>>& proximity : proximity_) {
        work.trees_refit += proximity ? proximity->refit() : 0;
    }
    return work;
}

template <int Dim>
std::int64_t Candidates<Dim>::bytes() const {
    std::int64_t sum = 0;
    for (const CandidatePairs& pairs : pairs_) {
        sum += static_cast<std::int64_t>(pairs.size() * sizeof(Candidate));
    }
    for (const auto* all : {&trees_, &trees_within_}) {
        for (const SurfaceTrees<Dim>& trees : *all) {
            sum += trees.bytes();
        }
    }
    for (const std::optional<SelfProximity<Dim>>& proximity : proximity_) {
        sum += proximity ? proximity->bytes() : 0;
    }
    return sum + between_.bytes() + within_.bytes()
           + static_cast<std::int64_t>(boxes_.size() * sizeof(Box));
}

template class Candidates<3>;
template class Candidates<4>;

}  // namespace pent::contact
