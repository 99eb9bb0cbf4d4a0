#include "candidates.h"

#include "boxes_around.h"
#include "near_on_paths.h"

#include <pent/dimensions.h>
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

// Pairs of a penalty kept for another evaluation, at most: 96 MB.
constexpr std::size_t kMaxKept = 8'000'000;

}  // namespace

template <int Dim>
Candidates<Dim>::Candidates(const Colliders<Dim>& colliders, const SharedWork& shared)
    : colliders_(colliders),
      shared_(shared),
      activation_distance_(colliders.scene().options.distance),
      min_inflation_(colliders.scene().options.margin),
      longest_(static_cast<std::size_t>(colliders.count()), kNever),
      trees_(static_cast<std::size_t>(colliders.count())),
      patches_(static_cast<std::size_t>(colliders.count())),
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
double Candidates<Dim>::measured_within(double distance) const {
    return distance + (kMeasured - 1) * activation_distance_;
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
bool Candidates<Dim>::does_cover(int body, const Paths<Dim>& paths) const {
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
            insert_within(body, proximity(body).find(positions));
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
    if (!is_penalty()) {
        return;
    }
    // All of a team drop them, or none: trees have to stay the same.
    if (min_inflation_ == 0
        || shared_.sum(static_cast<std::int64_t>(count)) > static_cast<std::int64_t>(kMaxKept)) {
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
void Candidates<Dim>::search_between(const Paths<Dim>& paths) {
    between_.set(vertices_, paths.from, paths.to, min_inflation_, kInflationOfPath);
    fit(paths);
    std::erase_if(pairs_, [](const CandidatePairs& pairs) { return !pairs.is_self(); });
    find_pairs_between(paths.is_still());
    ++work_.searches;
}

template <int Dim>
void Candidates<Dim>::search_within(int body, const Paths<Dim>& paths) {
    const Simplices<1>& vertices = colliders_.surface(body).vertices;
    longest_[static_cast<std::size_t>(body)] =
        std::max(longest_path<Dim>(vertices, paths.from, paths.to), min_inflation_);
    within_.set(vertices, paths.from, paths.to, min_inflation_, kInflationOfPath);
    const double distance = activation_distance(body, body);
    ++work_.searches;
    insert_within(body, proximity(body).find(within_, distance, measured_within(distance)));
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

template <int Dim>
void Candidates<Dim>::fit_patches(int collider, const Paths<Dim>& paths) {
    std::optional<SurfacePatches<Dim>>& patches = patches_[static_cast<std::size_t>(collider)];
    if (!patches) {
        patches.emplace(colliders_.surface(collider), PositionsView<Dim>(colliders_.rest()));
    }
    patches->fit(&between_.inflation(), boxes_);
    patches->set_lanes(paths);
}

// Boxes around all of a collider tell which may meet: the others need no more.
template <int Dim>
void Candidates<Dim>::fit(const Paths<Dim>& paths) {
    const Stopwatch watch;
    const int count = colliders_.count();
    std::vector<bool> is_alone(static_cast<std::size_t>(count), true);
    meeting_.clear();
    if (count > 1) {
        std::vector<Box> around(static_cast<std::size_t>(count));
        for (int a = 0; a < count; ++a) {
            const Surface<Dim>& surface = colliders_.surface(a);
            fit_boxes(surface.vertices, paths, &between_.inflation(),
                      0.5 * activation_distance_ + colliders_.radius(a), boxes_);
            around[static_cast<std::size_t>(a)] = hull_of(surface.vertices, boxes_);
            if (is_penalty()) {
                trees_[static_cast<std::size_t>(a)].update_vertices(surface, boxes_);
            }
        }
        for (int a = 0; a < count; ++a) {
            for (int b = a + 1; b < count; ++b) {
                if (colliders_.can_meet(a, b)
                    && overlap(around[static_cast<std::size_t>(a)],
                               around[static_cast<std::size_t>(b)])) {
                    meeting_.emplace_back(a, b);
                    is_alone[static_cast<std::size_t>(a)] = false;
                    is_alone[static_cast<std::size_t>(b)] = false;
                }
            }
        }
    }
    for (int a = 0; a < count; ++a) {
        if (!is_alone[static_cast<std::size_t>(a)]) {
            fit_patches(a, paths);
            if (is_penalty()) {
                trees_[static_cast<std::size_t>(a)].update_facets(colliders_.surface(a), boxes_);
            }
        }
    }
    work_.tree_seconds += watch.seconds();
}

template <int Dim>
void Candidates<Dim>::find_pairs_between(bool is_still) {
    for (const auto& [a, b] : meeting_) {
        CandidatePairs pairs{.first = a, .second = b};
        pairs.points_first = search<1, Dim>(a, b, is_still);
        pairs.mixed_first = search<2, Dim - 1>(a, b, is_still);
        pairs.points_second = search<1, Dim>(b, a, is_still);
        if constexpr (Dim > 3) {
            pairs.mixed_second = search<2, Dim - 1>(b, a, is_still);
        }
        work_.overlaps += pairs.overlaps();
        insert(std::move(pairs));
    }
}

template <int Dim>
template <int K, int L>
CandidateList Candidates<Dim>::search(int first, int second, bool is_still) const {
    const Simplices<K>& a = colliders_.surface(first).template simplices<K>();
    const Simplices<L>& b = colliders_.surface(second).template simplices<L>();
    const double distance = activation_distance(first, second);
    if (!is_penalty()) {
        return search<K, L>(
            first, second, is_still,
            NearOnPaths<Dim, K, L>{a, b, false, between_, distance, measured_within(distance)});
    }
    // Tests allow for rounding where candidates have to be a superset.
    const double limit = (distance + 2 * min_inflation_) * (is_exact() ? 1 : 1 + 1e-9);
    const PositionsView<Dim> end = between_.end();
    return search<K, L>(
        first, second, is_still,
        NearTest<Dim, K, L>{a, b, false, end, limit * limit,
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
SelfProximity<Dim>& Candidates<Dim>::proximity(int body) {
    std::optional<SelfProximity<Dim>>& proximity = proximity_[static_cast<std::size_t>(body)];
    if (!proximity) {
        proximity.emplace(colliders_.surface(body), colliders_.rest(),
                          activation_distance_ + (is_penalty() ? 0 : 2 * min_inflation_),
                          is_penalty(), shared_);
    }
    return *proximity;
}

template <int Dim>
void Candidates<Dim>::insert_within(int body, CandidatePairs pairs) {
    pairs.first = body;
    pairs.second = body;
    work_.overlaps += pairs.overlaps();
    insert(std::move(pairs));
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
    std::int64_t sum = 0;
    for (const CandidatePairs& pairs : pairs_) {
        sum += static_cast<std::int64_t>(pairs.size() * sizeof(Candidate));
    }
    for (const SurfaceTrees<Dim>& trees : trees_) {
        sum += trees.bytes();
    }
    for (const std::optional<SurfacePatches<Dim>>& patches : patches_) {
        sum += patches ? patches->bytes() : 0;
    }
    for (const std::optional<SelfProximity<Dim>>& proximity : proximity_) {
        sum += proximity ? proximity->bytes() : 0;
    }
    return sum + between_.bytes() + within_.bytes()
           + static_cast<std::int64_t>(boxes_.size() * sizeof(Box));
}

#define PENT_INSTANTIATE(Dim) template class Candidates<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
