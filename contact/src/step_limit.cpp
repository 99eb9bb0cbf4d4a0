#include "step_limit.h"

#include "ccd.h"
#include "obstacle_contacts.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <tuple>

namespace pent::contact {

namespace {

constexpr std::size_t kChunk = 512;

// A fraction of a step, and the pair that allows no more: by its places in a list.
using Bound = std::tuple<double, std::uint32_t, std::uint32_t>;

// Where vertices start, and how they move.
template <int Dim>
struct Step {
    const PositionsView<Dim>& from;
    const Positions<Dim> motion;
};

// The least of safe(k, limit) over all k in [0, count), where it is below the limit; of equals the
// first.
template <typename Safe>
Bound least_bound(std::size_t count, double limit, const Safe& safe) {
    std::vector<Bound> bounds((count + kChunk - 1) / kChunk, Bound{1, 0, 0});
    std::atomic<double> least = limit;  // a bound that only saves work
    for_each_chunk(count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        Bound& here = bounds[chunk];
        for (std::size_t k = begin; k < end; ++k) {
            const double most = std::min(least.load(std::memory_order_relaxed), std::get<0>(here));
            const Bound bound = safe(k, std::nextafter(most, 2.0));
            if (bound < here) {
                here = bound;
                const double fraction = std::get<0>(bound);
                double seen = least.load(std::memory_order_relaxed);
                while (fraction < seen
                       && !least.compare_exchange_weak(seen, fraction, std::memory_order_relaxed)) {
                }
            }
        }
    });
    const auto of_all = std::min_element(bounds.begin(), bounds.end());
    return of_all == bounds.end() ? Bound{1, 0, 0} : *of_all;
}

// Corners of a simplex of a collider, for messages: none of an obstacle.
template <int Dim, int Count>
std::vector<std::uint32_t> named_corners(const Colliders<Dim>& colliders,
                                         int collider,
                                         std::uint32_t i) {
    if (colliders.is_core(collider)) {
        return {};
    }
    const auto corners = colliders.surface(collider).template simplices<Count>().col(i);
    return {corners.data(), corners.data() + Count};
}

// Shortens a step by the candidates of one list.
template <int Dim, int K, int L>
void shorten(const Candidates<Dim>& candidates,
             const CandidateList& list,
             const std::array<int, 2>& which,
             const Step<Dim>& step,
             const Displacement& displacement,
             StepLimit& limit) {
    const Colliders<Dim>& colliders = candidates.colliders();
    const ContactOptions& options = colliders.scene().options;
    const Simplices<K>& first = colliders.surface(which[0]).template simplices<K>();
    const Simplices<L>& second = colliders.surface(which[1]).template simplices<L>();
    const bool has_core = colliders.is_core(which[0]) || colliders.is_core(which[1]);
    const Clearance clearance{
        options.separation + colliders.radius(which[0]) + colliders.radius(which[1]),
        options.distance};
    // A pair that stays beyond this distance stops no motion.
    const DistanceCull<K, L> cull(list, first, second, displacement,
                                  clearance.separation + kGapReached * clearance.distance);
    const auto safe = [&](std::size_t k, double most) -> Bound {
        const auto& [i, j, measured] = list.pairs[k];
        if (!cull.passes(k)) {
            return {1, i, j};
        }
        const Corners<Dim, K> a_motion = gather<Dim, K>(first, i, step.motion);
        const Corners<Dim, L> b_motion = gather<Dim, L>(second, j, step.motion);
        const Vector<Dim> together = a_motion.col(0);
        const bool do_keep_place =
            (a_motion.colwise() - together).isZero(0) && (b_motion.colwise() - together).isZero(0);
        // Fixed vertices may touch if they stay as they are.
        if (do_keep_place
            || (has_core && colliders.template may_enter_obstacles<K>(first, i)
                && colliders.template may_enter_obstacles<L>(second, j))) {
            return {1, i, j};
        }
        return {safe_fraction<Dim, K, L>(gather<Dim, K>(first, i, step.from), a_motion,
                                         gather<Dim, L>(second, j, step.from), b_motion, clearance,
                                         most),
                i, j};
    };
    const auto [fraction, i, j] = least_bound(cull.size(), limit.fraction, safe);
    if (fraction < limit.fraction) {
        limit.fraction = fraction;
        limit.limiting = {CrossingKind::Touching,
                          colliders.collider(which[0]),
                          colliders.collider(which[1]),
                          named_corners<Dim, K>(colliders, which[0], i),
                          named_corners<Dim, L>(colliders, which[1], j),
                          0};
        if (colliders.is_core(which[0])) {
            std::swap(limit.limiting.first, limit.limiting.second);
            std::swap(limit.limiting.first_corners, limit.limiting.second_corners);
        }
    }
}

// Shortens it by the surface of an obstacle.
template <int Dim>
void shorten(const Colliders<Dim>& colliders,
             std::uint32_t obstacle,
             const std::vector<std::uint32_t>& vertices,
             const Step<Dim>& step,
             StepLimit& limit) {
    const ContactScene<Dim>& scene = colliders.scene();
    const Clearance clearance{scene.options.separation, scene.options.distance};
    const auto [fraction, at, unused] =
        least_bound(vertices.size(), limit.fraction, [&](std::size_t k, double most) -> Bound {
            return {safe_fraction<Dim>(scene.obstacles[obstacle].shape, step.from.col(vertices[k]),
                                       step.motion.col(vertices[k]), clearance, most),
                    static_cast<std::uint32_t>(k), 0};
        });
    if (fraction < limit.fraction) {
        limit.fraction = fraction;
        limit.limiting = {CrossingKind::Touching,
                          body_of<Dim>(scene, vertices[at]),
                          {Collider::Kind::Obstacle, obstacle},
                          {vertices[at]},
                          {},
                          0};
    }
}

}  // namespace

template <int Dim>
StepLimit find_step_limit(const Candidates<Dim>& candidates,
                          const std::vector<std::uint32_t>& vertices,
                          const PositionsView<Dim>& from,
                          const PositionsView<Dim>& to) {
    const Colliders<Dim>& colliders = candidates.colliders();
    const Step<Dim> step{from, to - from};
    StepLimit limit;
    if (!candidates.pairs().empty()) {
        const Displacements displacements = candidates.displacements(from, to);
        candidates.for_each_list(
            [&]<int K, int L>(const CandidateList& list, int first, int second) {
                shorten<Dim, K, L>(candidates, list, {first, second}, step,
                                   displacements.of(first, second), limit);
            });
    }
    for (std::uint32_t o = 0; o < colliders.scene().obstacles.size(); ++o) {
        if (meets_vertices(colliders, o)) {
            shorten<Dim>(colliders, o, vertices, step, limit);
        }
    }
    return limit;
}

template StepLimit find_step_limit(const Candidates<3>&,
                                   const std::vector<std::uint32_t>&,
                                   const PositionsView<3>&,
                                   const PositionsView<3>&);
template StepLimit find_step_limit(const Candidates<4>&,
                                   const std::vector<std::uint32_t>&,
                                   const PositionsView<4>&,
                                   const PositionsView<4>&);

}  // namespace pent::contact
