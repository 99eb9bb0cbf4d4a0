#include "barrier_setting.h"
#include "gather.h"

#include <pent/contact/ccd.h>
#include <pent/parallel.h>

#include <array>
#include <atomic>
#include <cmath>
#include <tuple>

namespace pent::contact {

namespace {

constexpr std::size_t kChunk = 512;

template <int Dim>
class Limiter {
public:
    Limiter(const BarrierSetting<Dim>& setting,
            const PositionsView<Dim>& from,
            const PositionsView<Dim>& to)
        : setting_(setting),
          from_(from),
          motion_(to - from),
          travel_(setting.candidates.travel(from, to)) {}

    StepLimit run() {
        setting_.for_each_list([this](const auto& list, const auto& first, const auto& second,
                                      const std::array<int, 2>& bodies) {
            this->shorten(list, first, second, bodies);
        });
        shorten_by_obstacles();
        return std::move(limit_);
    }

private:
    // Takes the least fraction of all pairs; of equals the first pair.
    template <int K, int L>
    void shorten(const CandidateList& list,
                 const Simplices<K>& first,
                 const Simplices<L>& second,
                 const std::array<int, 2>& bodies) {
        using Best = std::tuple<double, std::uint32_t, std::uint32_t>;  // fraction and pair
        const Clearance clearance{setting_.options.separation, setting_.options.distance};
        // A pair that stays beyond this distance stops no motion.
        const Sieve<K, L> sieve(list, first, second, travel_,
                                clearance.separation + kGapReached * clearance.distance);
        std::vector<Best> best((sieve.size() + kChunk - 1) / kChunk, Best{1, 0, 0});
        std::atomic<double> least = limit_.fraction;  // a bound that only saves work
        parallel_for(best.size(), [&](std::size_t chunk) {
            Best& here = best[chunk];
            const std::size_t end = std::min((chunk + 1) * kChunk, sieve.size());
            for (std::size_t k = chunk * kChunk; k < end; ++k) {
                if (!sieve.passes(k)) {
                    continue;
                }
                const std::uint32_t i = list.pairs[k].first;
                const std::uint32_t j = list.pairs[k].second;
                const double bound =
                    std::min(least.load(std::memory_order_relaxed), std::get<0>(here));
                const Corners<Dim, K> a_motion = gather<Dim, K>(first, i, motion_);
                const Corners<Dim, L> b_motion = gather<Dim, L>(second, j, motion_);
                const Vector<Dim> together = a_motion.col(0);
                if ((a_motion.colwise() - together).isZero(0)
                    && (b_motion.colwise() - together).isZero(0)) {
                    continue;  // held vertices may touch if they stay as they are
                }
                const double fraction = safe_fraction<Dim, K, L>(
                    gather<Dim, K>(first, i, from_), a_motion, gather<Dim, L>(second, j, from_),
                    b_motion, clearance, std::nextafter(bound, 2.0));
                if (Best{fraction, i, j} < here) {
                    here = {fraction, i, j};
                    double seen = least.load(std::memory_order_relaxed);
                    while (fraction < seen
                           && !least.compare_exchange_weak(seen, fraction,
                                                           std::memory_order_relaxed)) {
                    }
                }
            }
        });
        const auto of_all = std::min_element(best.begin(), best.end());
        if (of_all != best.end() && std::get<0>(*of_all) < limit_.fraction) {
            const auto [fraction, i, j] = *of_all;
            limit_ = {fraction,
                      {CrossingKind::Touching,
                       bodies[0],
                       bodies[1],
                       {first.col(i).data(), first.col(i).data() + K},
                       {second.col(j).data(), second.col(j).data() + L},
                       0}};
        }
    }

    void shorten_by_obstacles() {
        for (std::size_t o = 0; o < setting_.obstacles.size(); ++o) {
            const auto take = [&](double fraction, std::int32_t body,
                                  std::vector<std::uint32_t> corners) {
                if (fraction < limit_.fraction) {
                    limit_.fraction = fraction;
                    limit_.limiting = {
                        CrossingKind::Touching, body, -1 - static_cast<std::int32_t>(o),
                        std::move(corners),     {},   0};
                }
            };
            if (const auto* ball = std::get_if<Ball<Dim>>(&setting_.obstacles[o])) {
                const Clearance clearance{ball->radius + setting_.options.separation,
                                          setting_.options.distance};
                const Corners<Dim, 1> center = ball->center;
                setting_.for_each_facet_near(*ball, [&](std::int32_t body, std::uint32_t facet) {
                    const Simplices<Dim>& facets = setting_.bodies[body].surface.facets;
                    take(safe_fraction<Dim, 1, Dim>(center, Corners<Dim, 1>::Zero(),
                                                    gather<Dim, Dim>(facets, facet, from_),
                                                    gather<Dim, Dim>(facets, facet, motion_),
                                                    clearance),
                         body, {facets.col(facet).data(), facets.col(facet).data() + Dim});
                });
                continue;
            }
            const Clearance clearance{setting_.options.separation, setting_.options.distance};
            setting_.for_each_free_vertex([&](std::int32_t body, std::uint32_t vertex) {
                take(safe_fraction<Dim>(setting_.obstacles[o], from_.col(vertex),
                                        motion_.col(vertex), clearance),
                     body, {vertex});
            });
        }
    }

    const BarrierSetting<Dim>& setting_;
    const PositionsView<Dim>& from_;
    const Positions<Dim> motion_;
    const Travel travel_;
    StepLimit limit_;
};

}  // namespace

template <int Dim>
StepLimit limit_barrier_step(const BarrierSetting<Dim>& setting,
                             const PositionsView<Dim>& from,
                             const PositionsView<Dim>& to) {
    return Limiter<Dim>(setting, from, to).run();
}

template StepLimit limit_barrier_step(const BarrierSetting<3>&,
                                      const PositionsView<3>&,
                                      const PositionsView<3>&);
template StepLimit limit_barrier_step(const BarrierSetting<4>&,
                                      const PositionsView<4>&,
                                      const PositionsView<4>&);

}  // namespace pent::contact
