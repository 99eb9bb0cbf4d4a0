#include "candidates.h"

#include "boxes_around.h"
#include "near_on_paths.h"

#include <pent/dimensions.h>
#include <pent/parallel.h>
#include <pent/stopwatch.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace pent::contact {

namespace {

// With a barrier candidates hold at least until a vertex has left its path by this part of the
// distance of contact. More makes searches fewer and dearer; at twice as much and at half of it
// they cost as much.
constexpr double kInflation = 0.25;

// Lists made for a motion this many times as long as what is asked for have many more pairs than
// are of use.
constexpr double kTooCoarse = 3;

// The inflation around long paths is this part of them: Newton's method goes less far from one
// iteration to the next, so candidates of the first hold for some that follow. A quarter finds more
// candidates and spares no more searches.
constexpr double kInflationOfPath = 0.1;

// Distances are measured up to this many times the activation distance: while no vertex has gone
// farther than 0.3 times that distance since, no pair beyond can be within it.
constexpr double kMeasured = 1.6;

// Pairs of a penalty kept for another evaluation, at most: 96 MB.
constexpr std::size_t kMaxKept = 8'000'000;

// Whether a list that ascends has an item.
template <typename Item>
bool contains(const std::vector<Item>& items, const Item& item) {
    return std::binary_search(items.begin(), items.end(), item);
}

}  // namespace

template <int Dim>
Candidates<Dim>::Candidates(const Colliders<Dim>& colliders, const SharedWork& shared)
    : colliders_(colliders),
      shared_(shared),
      activation_distance_(colliders.scene().options.distance),
      min_inflation_(colliders.scene().options.margin),
      trees_(static_cast<std::size_t>(colliders.count())),
      patches_(static_cast<std::size_t>(colliders.count())),
      proximity_(static_cast<std::size_t>(colliders.count())),
      convex_(static_cast<std::size_t>(colliders.count())) {
    if (!is_penalty()) {
        const ContactOptions& options = colliders.scene().options;
        activation_distance_ = options.distance + options.separation;
        min_inflation_ = kInflation * options.distance;
    }
    parallel_for(convex_.size(), [&](std::size_t i) {
        const int body = static_cast<int>(i);
        if (colliders.can_meet(body, body)) {
            convex_[i] = ConvexBody<Dim>::make(colliders.cells(body), colliders.rest(),
                                               activation_distance(body, body));
        }
    });
}

template <int Dim>
void Candidates<Dim>::cover(const PositionsView<Dim>& from, const PositionsView<Dim>& to) {
    const Paths<Dim> paths{from, to};
    if (inflation_.size() != to.cols()) {  // here, since threads share it
        inflation_.setZero(to.cols());
    }
    const std::vector<Pair> known = covered(paths);
    cover_between(paths, known);
    cover_within(paths, known);
    if (is_penalty()) {
        fit_trees(to);
    }
}

template <int Dim>
void Candidates<Dim>::cover(const PositionsView<Dim>& positions) {
    cover(positions, positions);
}

template <int Dim>
void Candidates<Dim>::drop_what_is_not_kept() {
    if (!is_penalty()) {
        return;
    }
    std::size_t count = 0;
    for (const Meeting<Dim>& meeting : meetings_) {
        count += meeting.pairs.is_self() ? 0 : meeting.pairs.size();
    }
    // All of a team drop them, or none: all have to have the same meetings.
    if (min_inflation_ == 0
        || shared_.sum(static_cast<std::int64_t>(count)) > static_cast<std::int64_t>(kMaxKept)) {
        meetings_.clear();
    }
}

template <int Dim>
std::vector<Displacement> Candidates<Dim>::displacements(const PositionsView<Dim>& from,
                                                         const PositionsView<Dim>& to) const {
    std::vector<Displacement> displacements(meetings_.size());
    parallel_for(meetings_.size(), [&](std::size_t m) {
        const CandidatePairs& pairs = meetings_[m].pairs;
        if (pairs.size() > 0) {
            displacements[m] = Displacement(colliders_.surface(pairs.first).vertices,
                                            colliders_.surface(pairs.second).vertices);
            meetings_[m].cover.find_displacement(from, to, displacements[m]);
        }
    });
    return displacements;
}

// The colliders of the meetings that hold for the paths, ascending.
template <int Dim>
std::vector<typename Candidates<Dim>::Pair> Candidates<Dim>::covered(
    const Paths<Dim>& paths) const {
    std::vector<char> holds(meetings_.size());
    parallel_for(meetings_.size(),
                 [&](std::size_t m) { holds[m] = does_cover(meetings_[m], paths) ? 1 : 0; });
    std::vector<Pair> covered;
    for (std::size_t m = 0; m < meetings_.size(); ++m) {
        if (holds[m] != 0) {
            covered.push_back(meetings_[m].colliders());
        }
    }
    return covered;
}

// Whether lists hold for the paths and are worth keeping: not where these are much shorter than
// what the lists were made for, and so far from where distances were measured that these hold few
// pairs back.
template <int Dim>
bool Candidates<Dim>::does_cover(const Meeting<Dim>& meeting, const Paths<Dim>& paths) const {
    const PathCover<Dim>& cover = meeting.cover;
    if (!cover.covers(paths.from)) {
        return false;
    }
    if (paths.is_still()) {
        return true;
    }
    const double asked = longest_path<Dim>(cover.vertices(), paths.from, paths.to);
    const bool are_many = kTooCoarse * std::max(asked, min_inflation_)
                          < std::max(cover.longest_path(), min_inflation_);
    const double unmeasured = 0.5 * (kMeasured - 1) * activation_distance_;
    return cover.covers(paths.to)
           && !(are_many && cover.farthest_from_end(paths.from) > unmeasured);
}

template <int Dim>
void Candidates<Dim>::insert(const Pair& pair, Meeting<Dim> meeting) {
    work_.overlaps += meeting.pairs.overlaps();
    ++work_.searches;
    meetings_.put(pair, std::move(meeting));
}

// Bodies side by side: small ones are not worth several threads each.
template <int Dim>
void Candidates<Dim>::cover_within(const Paths<Dim>& paths, const std::vector<Pair>& covered) {
    std::vector<int> bodies;
    for (int body = 0; body < colliders_.count(); ++body) {
        if (colliders_.can_meet(body, body)
            && (is_penalty() || !contains(covered, Pair(body, body)))) {
            bodies.push_back(body);
        }
    }
    std::vector<Meeting<Dim>> found(bodies.size());
    parallel_for(bodies.size(), [&](std::size_t k) { found[k] = find_within(bodies[k], paths); });
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        insert({bodies[k], bodies[k]}, std::move(found[k]));
    }
}

// A convex body that has not been bent enough to meet itself needs no search.
template <int Dim>
Meeting<Dim> Candidates<Dim>::find_within(int body, Paths<Dim> paths) {
    const std::optional<ConvexBody<Dim>>& convex = convex_[static_cast<std::size_t>(body)];
    const double distance = activation_distance(body, body);
    if (is_penalty()) {
        const bool is_apart = convex && convex->stays_apart({paths.to, paths.to}, distance);
        return {is_apart ? CandidatePairs() : proximity(body).find(paths.to), {}};
    }
    const Simplices<1>& vertices = colliders_.surface(body).vertices;
    paths.inflation = &inflation_;
    if (convex && convex->stays_apart(paths, distance + 2 * min_inflation_)) {
        set_inflation<Dim>(vertices, paths, min_inflation_, 0, inflation_);
        return {{}, PathCover<Dim>(vertices, paths)};
    }
    paths.drift = mean_shift<Dim>(vertices, paths.from, paths.to);
    set_inflation<Dim>(vertices, paths, min_inflation_, kInflationOfPath, inflation_);
    return {proximity(body).find(paths, distance, measured_within(distance)),
            PathCover<Dim>(vertices, paths)};
}

template <int Dim>
SelfProximity<Dim>& Candidates<Dim>::proximity(int body) {
    std::optional<SelfProximity<Dim>>& proximity = proximity_[static_cast<std::size_t>(body)];
    if (!proximity) {
        proximity.emplace(colliders_.surface(body), colliders_.rest(),
                          activation_distance_ + (is_penalty() ? 0 : 2 * min_inflation_),
                          is_penalty(), shared_);
    }
    return *proximity;
}

// Searches pairs of colliders that are near and not covered, and drops lists of those that are
// neither.
template <int Dim>
void Candidates<Dim>::cover_between(const Paths<Dim>& paths, const std::vector<Pair>& covered) {
    const std::vector<Pair> near = overlapping(paths);
    std::vector<Pair> unknown;
    std::copy_if(near.begin(), near.end(), std::back_inserter(unknown),
                 [&](const Pair& pair) { return !contains(covered, pair); });
    meetings_.erase_if([&](const Meeting<Dim>& meeting) {
        return !meeting.pairs.is_self() && !contains(near, meeting.colliders())
               && !contains(covered, meeting.colliders());
    });
    if (!unknown.empty()) {
        search_between(unknown, paths);
    }
}

// The broad phase: colliders that may meet and whose boxes overlap, ascending.
template <int Dim>
std::vector<typename Candidates<Dim>::Pair> Candidates<Dim>::overlapping(Paths<Dim> paths) {
    const Stopwatch watch;
    paths.drift = paths.is_still() ? Vector<Dim>::Zero().eval()
                                   : (paths.to - paths.from).rowwise().mean().eval();
    std::vector<int> which;
    std::vector<Box> around;
    for (int i = 0; colliders_.count() > 1 && i < colliders_.count(); ++i) {
        const Simplices<1>& vertices = colliders_.surface(i).vertices;
        if (vertices.cols() > 0) {
            fit_boxes<Dim>(vertices, paths, 0.5 * activation_distance_ + colliders_.radius(i),
                           boxes_);
            which.push_back(i);
            around.push_back(hull_of(vertices, boxes_));
        }
    }
    std::vector<Pair> pairs;
    if (which.size() > 1) {
        const BoxTree tree(around);
        for (const BoxTree::Work& work : BoxTree::split(tree, tree, 1)) {
            BoxTree::for_each_overlap(tree, tree, work, [&](std::uint32_t i, std::uint32_t j) {
                const Pair pair = std::minmax(which[i], which[j]);
                if (colliders_.can_meet(pair.first, pair.second)) {
                    pairs.push_back(pair);
                }
            });
        }
        std::sort(pairs.begin(), pairs.end());
    }
    work_.tree_seconds += watch.seconds();
    return pairs;
}

template <int Dim>
void Candidates<Dim>::search_between(const std::vector<Pair>& pairs, Paths<Dim> paths) {
    std::vector<int> colliders;
    for (const Pair& pair : pairs) {
        colliders.push_back(pair.first);
        colliders.push_back(pair.second);
    }
    std::sort(colliders.begin(), colliders.end());
    colliders.erase(std::unique(colliders.begin(), colliders.end()), colliders.end());
    const Simplices<1> vertices = vertices_of(colliders);
    paths.drift = mean_shift<Dim>(vertices, paths.from, paths.to);
    set_inflation<Dim>(vertices, paths, min_inflation_, kInflationOfPath, inflation_);
    paths.inflation = &inflation_;
    boxes_.resize(static_cast<std::size_t>(paths.to.cols()));
    const Stopwatch watch;
    parallel_for(colliders.size(), [&](std::size_t k) { fit_patches(colliders[k], paths); });
    work_.tree_seconds += watch.seconds();
    std::vector<Meeting<Dim>> found(pairs.size());
    parallel_for(pairs.size(), [&](std::size_t k) {
        found[k] = {find_between(pairs[k], paths),
                    PathCover<Dim>(vertices_of({pairs[k].first, pairs[k].second}), paths)};
    });
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        insert(pairs[k], std::move(found[k]));
    }
}

template <int Dim>
Simplices<1> Candidates<Dim>::vertices_of(const std::vector<int>& colliders) const {
    Eigen::Index count = 0;
    for (const int i : colliders) {
        count += colliders_.surface(i).vertices.cols();
    }
    Simplices<1> all(1, count);
    Eigen::Index begin = 0;
    for (const int i : colliders) {
        const Simplices<1>& vertices = colliders_.surface(i).vertices;
        all.middleCols(begin, vertices.cols()) = vertices;
        begin += vertices.cols();
    }
    return all;
}

template <int Dim>
void Candidates<Dim>::fit_patches(int collider, const Paths<Dim>& paths) {
    const Surface<Dim>& surface = colliders_.surface(collider);
    std::optional<SurfacePatches<Dim>>& patches = patches_[static_cast<std::size_t>(collider)];
    if (!patches) {
        patches.emplace(surface, PositionsView<Dim>(colliders_.rest()));
    }
    fit_boxes<Dim>(surface.vertices, paths,
                   0.5 * activation_distance_ + colliders_.radius(collider), boxes_);
    patches->fit(paths, boxes_);
    patches->set_lanes(paths);
}

// Lists of pairs hold where both colliders are shifted, trees do not: these are fit to the
// positions.
template <int Dim>
void Candidates<Dim>::fit_trees(const PositionsView<Dim>& positions) {
    const Stopwatch watch;
    std::vector<bool> are_met(trees_.size(), false);
    for (const Meeting<Dim>& meeting : meetings_) {
        for (const int i : {meeting.pairs.first, meeting.pairs.second}) {
            const auto place = static_cast<std::size_t>(i);
            if (meeting.pairs.is_self() || are_met[place]) {
                continue;
            }
            are_met[place] = true;
            const Surface<Dim>& surface = colliders_.surface(i);
            fit_boxes<Dim>(surface.vertices, {positions, positions}, 0, boxes_);
            trees_[place].update_vertices(surface, boxes_);
            trees_[place].update_facets(surface, boxes_);
        }
    }
    work_.tree_seconds += watch.seconds();
}

template <int Dim>
CandidatePairs Candidates<Dim>::find_between(const Pair& pair, const Paths<Dim>& paths) const {
    const auto [a, b] = pair;
    CandidatePairs pairs;
    pairs.points_first = search<1, Dim>(a, b, paths);
    pairs.mixed_first = search<2, Dim - 1>(a, b, paths);
    pairs.points_second = search<1, Dim>(b, a, paths);
    if constexpr (Dim > 3) {
        pairs.mixed_second = search<2, Dim - 1>(b, a, paths);
    }
    return pairs;
}

template <int Dim>
double Candidates<Dim>::measured_within(double distance) const {
    return distance + (kMeasured - 1) * activation_distance_;
}

template <int Dim>
template <int K, int L>
CandidateList Candidates<Dim>::search(int first, int second, const Paths<Dim>& paths) const {
    const Simplices<K>& a = colliders_.surface(first).template simplices<K>();
    const Simplices<L>& b = colliders_.surface(second).template simplices<L>();
    const double distance = activation_distance(first, second);
    if (!is_penalty()) {
        return search<K, L>(
            first, second, paths.is_still(),
            NearOnPaths<Dim, K, L>{a, b, false, paths, distance, measured_within(distance)});
    }
    // Tests allow for rounding where candidates have to be a superset.
    const double limit = (distance + 2 * min_inflation_) * (is_exact() ? 1 : 1 + 1e-9);
    return search<K, L>(
        first, second, paths.is_still(),
        NearTest<Dim, K, L>{a, b, false, paths.to, limit * limit,
                            is_exact() && K == 2 ? Closest::Interior : Closest::Anywhere});
}

template <int Dim>
template <int K, int L, typename Test>
CandidateList Candidates<Dim>::search(int first,
                                      int second,
                                      bool is_still,
                                      const Test& test) const {
    constexpr std::size_t kChunk = 4;
    const auto& of_first = patches_[static_cast<std::size_t>(first)]->template of<K>();
    const auto& of_second = patches_[static_cast<std::size_t>(second)]->template of<L>();
    const double distance = activation_distance(first, second);
    const std::size_t count = of_first.partition.size();
    std::vector<typename Test::Found> found((count + kChunk - 1) / kChunk);
    for_each_chunk(count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        for (std::size_t a = begin; shared_.is_own(chunk) && a < end; ++a) {
            of_second.tree.for_each_overlap(of_first.around[a], [&](std::uint32_t b) {
                for_each_near<Dim, K>(
                    PatchOnPaths<Dim>{of_first, a}, PatchOnPaths<Dim>{of_second, b}, is_still,
                    distance + of_first.inflation[a] + of_second.inflation[b],
                    [&](std::uint32_t i, std::uint32_t j) { test(i, j, found[chunk]); });
            });
        }
    });
    return joined(found);
}

template <int Dim>
SearchWork Candidates<Dim>::work() const {
    SearchWork work = work_;
    for (const SurfaceTrees<Dim>& trees : trees_) {
        work.trees_built += trees.built();
        work.trees_refit += trees.refit();
    }
    for (const std::optional<SurfacePatches<Dim>>& patches : patches_) {
        work.trees_refit += patches ? patches->refit() : 0;
    }
    for (const std::optional<SelfProximity<Dim>>& proximity : proximity_) {
        work.trees_refit += proximity ? proximity->refit() : 0;
    }
    return work;
}

template <int Dim>
std::int64_t Candidates<Dim>::bytes() const {
    std::int64_t sum = meetings_.bytes();
    for (const SurfaceTrees<Dim>& trees : trees_) {
        sum += trees.bytes();
    }
    for (const std::optional<SurfacePatches<Dim>>& patches : patches_) {
        sum += patches ? patches->bytes() : 0;
    }
    for (const std::optional<SelfProximity<Dim>>& proximity : proximity_) {
        sum += proximity ? proximity->bytes() : 0;
    }
    for (const std::optional<ConvexBody<Dim>>& convex : convex_) {
        sum += convex ? convex->bytes() : 0;
    }
    return sum
           + static_cast<std::int64_t>(boxes_.size() * sizeof(Box)
                                       + static_cast<std::size_t>(inflation_.size())
                                             * sizeof(double));
}

#define PENT_INSTANTIATE(Dim) template class Candidates<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
