#include "step_limit.h"

#include "ccd.h"
#include "obstacle_contacts.h"
#include "passing_candidates.h"

#include <pent/dimensions.h>

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

// A step: where vertices start, and how they move.
template <int Dim>
struct Step {
    const PositionsView<Dim>& from;
    const Positions<Dim> motion;
};

// The least fraction that any thread has found so far. It only saves work and decides nothing: a
// fraction equal to it is still found exactly.
class SharedLimit {
public:
    explicit SharedLimit(double limit) : least_(limit) {}

    // The limit for a thread that has found `own`: just above the least.
    [[nodiscard]] double most(double own) const {
        return std::nextafter(std::min(least_.load(std::memory_order_relaxed), own), 2.0);
    }

    void lower_to(double fraction) {
        double seen = least_.load(std::memory_order_relaxed);
        while (fraction < seen
               && !least_.compare_exchange_weak(seen, fraction, std::memory_order_relaxed)) {
        }
    }

private:
    std::atomic<double> least_;
};

// The least of safe(k, limit) over all k in [0, count), where it is below the limit; of equals the
// first.
template <typename Safe>
Bound least_bound(std::size_t count, double limit, const Safe& safe) {
    std::vector<Bound> bounds((count + kChunk - 1) / kChunk, Bound{1, 0, 0});
    SharedLimit shared(limit);
    for_each_chunk(count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        Bound& here = bounds[chunk];
        for (std::size_t k = begin; k < end; ++k) {
            const Bound bound = safe(k, shared.most(std::get<0>(here)));
            if (bound < here) {
                here = bound;
                shared.lower_to(std::get<0>(bound));
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

// The same of several lists: those of candidates in their order, or one for each obstacle.
struct LeastBound {
    Bound bound{1, 0, 0};
    std::uint32_t list = 0;

    [[nodiscard]] double fraction() const { return std::get<0>(bound); }

    // Takes a bound that is lower; of equal ones the list that came first keeps its place.
    void take(const Bound& other, std::uint32_t of) {
        if (std::get<0>(other) < fraction()) {
            *this = {other, of};
        }
    }
    [[nodiscard]] bool is_below(const LeastBound& other) const {
        return std::tuple(fraction(), list, bound)
               < std::tuple(other.fraction(), other.list, other.bound);
    }
};

// The fraction of the step that a candidate allows; 1 or more than `most` where that is more.
template <int Dim, int K, int L>
double fraction_of(const Colliders<Dim>& colliders,
                   const ListPlace& place,
                   const Candidate& pair,
                   const Step<Dim>& step,
                   double most) {
    const Simplices<K>& first = colliders.surface(place.first).template simplices<K>();
    const Simplices<L>& second = colliders.surface(place.second).template simplices<L>();
    const Corners<Dim, K> a_motion = gather<Dim, K>(first, pair.first, step.motion);
    const Corners<Dim, L> b_motion = gather<Dim, L>(second, pair.second, step.motion);
    const Vector<Dim> together = a_motion.col(0);
    const bool do_keep_place =
        (a_motion.colwise() - together).isZero(0) && (b_motion.colwise() - together).isZero(0);
    const bool has_core = colliders.is_core(place.first) || colliders.is_core(place.second);
    // Fixed vertices may touch if they stay as they are.
    if (do_keep_place
        || (has_core && colliders.template may_enter_obstacles<K>(first, pair.first)
            && colliders.template may_enter_obstacles<L>(second, pair.second))) {
        return 1;
    }
    const ContactOptions& options = colliders.scene().options;
    const Clearance clearance{
        options.separation + colliders.radius(place.first) + colliders.radius(place.second),
        options.distance};
    return safe_fraction<Dim, K, L>(gather<Dim, K>(first, pair.first, step.from), a_motion,
                                    gather<Dim, L>(second, pair.second, step.from), b_motion,
                                    clearance, most);
}

// The two simplices of a bound.
template <int Dim>
Crossing touching(const Candidates<Dim>& candidates, const LeastBound& least) {
    const Colliders<Dim>& colliders = candidates.colliders();
    Crossing crossing;
    visit_list<Dim>(candidates.meetings()[least.list / kLists].pairs, least.list % kLists,
                    [&]<int K, int L>(const ListOfTwo& of) {
                        crossing = {
                            CrossingKind::Touching,
                            colliders.collider(of.first),
                            colliders.collider(of.second),
                            named_corners<Dim, K>(colliders, of.first, std::get<1>(least.bound)),
                            named_corners<Dim, L>(colliders, of.second, std::get<2>(least.bound)),
                            0};
                        if (colliders.is_core(of.first)) {
                            std::swap(crossing.first, crossing.second);
                            std::swap(crossing.first_corners, crossing.second_corners);
                        }
                    });
    return crossing;
}

// A vertex and the surface of an obstacle.
template <int Dim>
Crossing touching(const ContactScene<Dim>& scene, std::uint32_t obstacle, std::uint32_t vertex) {
    return {CrossingKind::Touching,
            body_of<Dim>(scene, vertex),
            {Collider::Kind::Obstacle, obstacle},
            {vertex},
            {},
            0};
}

// The fraction that the surface of an obstacle allows, if that is less than the limit, and the
// place of the vertex.
template <int Dim>
Bound bound_of(const Candidates<Dim>& candidates,
               std::uint32_t obstacle,
               const std::vector<std::uint32_t>& vertices,
               const Step<Dim>& step,
               double limit) {
    const ContactScene<Dim>& scene = candidates.colliders().scene();
    const Clearance clearance{scene.options.separation, scene.options.distance};
    return least_bound(vertices.size(), limit, [&](std::size_t k, double most) -> Bound {
        const auto place = static_cast<std::uint32_t>(k);
        if (!candidates.shared().is_own(k / kChunk)) {
            return {1, place, 0};
        }
        return {safe_fraction<Dim>(scene.obstacles[obstacle].shape, step.from.col(vertices[k]),
                                   step.motion.col(vertices[k]), clearance, most),
                place, 0};
    });
}

// The least bound of all of a team.
LeastBound least_of_all(const LeastBound& own, const SharedWork& shared) {
    LeastBound least = own;
    for (const LeastBound& bound : shared.all(std::vector<LeastBound>{own})) {
        least = bound.is_below(least) ? bound : least;
    }
    return least;
}

// The fraction that pairs allow, if that is less than a part of the step; else that part, of no
// pair. Pairs are searched for on that part alone.
template <int Dim>
LeastBound least_of_pairs(Candidates<Dim>& candidates,
                          const Step<Dim>& step,
                          const PositionsView<Dim>& to,
                          double part) {
    Positions<Dim> cut;
    if (part < 1) {
        cut = step.from + part * step.motion;
    }
    const PositionsView<Dim> end = part < 1 ? PositionsView<Dim>(cut) : to;
    candidates.cover(step.from, end);
    const Colliders<Dim>& colliders = candidates.colliders();
    const ContactOptions& options = colliders.scene().options;
    // A pair that stays beyond this distance stops no motion.
    const PassingCandidates<Dim> passing(candidates, step.from, end,
                                         options.separation + kGapReached * options.distance);
    SharedLimit limit(part);
    const std::vector<LeastBound> bounds = passing.template look_at_each<LeastBound>(
        [&]<int K, int L>(const ListPlace& place, const Candidate& pair, LeastBound& here) {
            const double fraction =
                fraction_of<Dim, K, L>(colliders, place, pair, step, limit.most(here.fraction()));
            const LeastBound bound{{fraction, pair.first, pair.second}, place.list};
            if (bound.is_below(here)) {
                here = bound;
                limit.lower_to(fraction);
            }
        });
    LeastBound least{.bound{part, 0, 0}};
    for (const LeastBound& bound : bounds) {
        least = bound.is_below(least) ? bound : least;
    }
    return least_of_all(least, candidates.shared());
}

}  // namespace

template <int Dim>
StepLimit find_step_limit(Candidates<Dim>& candidates,
                          const std::vector<std::uint32_t>& vertices,
                          const PositionsView<Dim>& from,
                          const PositionsView<Dim>& to) {
    const ContactScene<Dim>& scene = candidates.colliders().scene();
    const Step<Dim> step{from, to - from};
    LeastBound least;
    for (std::uint32_t o = 0; o < scene.obstacles.size(); ++o) {
        if (meets_vertices(candidates.colliders(), o)) {
            least.take(bound_of<Dim>(candidates, o, vertices, step, least.fraction()), o);
        }
    }
    // Where the surface of an obstacle stops the step, pairs that are met later need not be
    // searched.
    const LeastBound of_obstacles = least_of_all(least, candidates.shared());
    least = least_of_pairs<Dim>(candidates, step, to, of_obstacles.fraction());
    StepLimit limit;
    limit.fraction = least.fraction();
    if (limit.fraction < of_obstacles.fraction()) {
        limit.limiting = touching<Dim>(candidates, least);
    } else if (limit.fraction < 1) {
        limit.limiting =
            touching<Dim>(scene, of_obstacles.list, vertices[std::get<1>(of_obstacles.bound)]);
    }
    return limit;
}

#define PENT_INSTANTIATE(Dim)                                                               \
    template StepLimit find_step_limit(Candidates<Dim>&, const std::vector<std::uint32_t>&, \
                                       const PositionsView<Dim>&, const PositionsView<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
