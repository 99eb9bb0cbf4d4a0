#include "step/sleep.h"

#include "model/same_time.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace pent::simulator {

namespace {

using CoupledPair = std::pair<std::size_t, std::size_t>;

// Marks what is coupled to something marked and may be marked, until nothing is new.
template <typename CanTake>
void spread(const std::vector<CoupledPair>& pairs,
            const CanTake& can_take,
            std::vector<bool>& marks) {
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (const auto& [a, b] : pairs) {
            for (const auto& [from, to] : {CoupledPair(a, b), CoupledPair(b, a)}) {
                if (marks[from] && !marks[to] && can_take(to)) {
                    marks[to] = true;
                    has_changed = true;
                }
            }
        }
    }
}

}  // namespace

template <int Dim>
Islands<Dim>::Islands(const Scene& scene, const Bodies<Dim>& bodies, const HeldVertices<Dim>& held)
    : bodies_(&bodies), is_on_(scene.sleep.has_value()), states_(bodies.count()) {
    if (!is_on_) {
        return;
    }
    steps_to_sleep_ =
        static_cast<std::uint64_t>(std::max(1.0, steps_to(scene.sleep->time, scene.dt())));
    for (std::size_t body = 0; body < states_.size(); ++body) {
        const auto& positions = bodies.meshes[body].positions;
        const double size =
            (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).norm();
        speed_.push_back(scene.sleep->speed * size);
        is_kinematic_.push_back(held.is_kinematic(body));
    }
}

template <int Dim>
int Islands<Dim>::asleep_count() const {
    return static_cast<int>(std::count_if(states_.begin(), states_.end(),
                                          [](const SleepState& state) { return state.is_asleep; }));
}

template <int Dim>
std::vector<bool> Islands<Dim>::asleep() const {
    std::vector<bool> asleep;
    for (const SleepState& state : states_) {
        asleep.push_back(state.is_asleep);
    }
    return asleep;
}

template <int Dim>
bool Islands<Dim>::wake(const Couplings& couplings,
                        const Positions<Dim>& from,
                        const Positions<Dim>& to) {
    std::vector<bool> is_moving(states_.size());
    for (std::size_t body = 0; body < states_.size(); ++body) {
        is_moving[body] = !states_[body].is_asleep && !is_kinematic_[body];
        const auto range = bodies_->vertices(body);
        is_moving[body] =
            is_moving[body]
            || from.middleCols(range.begin, range.size) != to.middleCols(range.begin, range.size);
    }
    for (const std::size_t body : couplings.driven) {
        is_moving[body] = is_moving[body] || !is_kinematic_[body];
    }
    spread(
        couplings.pairs, [&](std::size_t body) { return states_[body].is_asleep; }, is_moving);
    bool has_woken = false;
    for (std::size_t body = 0; body < states_.size(); ++body) {
        if (states_[body].is_asleep && is_moving[body]) {
            states_[body] = {};
            has_woken = true;
        }
    }
    return has_woken;
}

// Dirichlet vertices have to be still: what they are about to do would wake the body at once.
template <int Dim>
bool Islands<Dim>::is_quiet(std::size_t body,
                            const HeldVertices<Dim>& held,
                            const Positions<Dim>& velocities) const {
    for (Eigen::Index v = bodies_->first_vertex[body]; v < bodies_->first_vertex[body + 1]; ++v) {
        const double most = held.is_held(static_cast<std::uint32_t>(v)) ? 0 : speed_[body];
        if (velocities.col(v).norm() > most) {
            return false;
        }
    }
    return true;
}

template <int Dim>
bool Islands<Dim>::put_to_sleep(const Couplings& couplings,
                                const HeldVertices<Dim>& held,
                                const Positions<Dim>& velocities,
                                double stiffness) {
    assert(is_on_);
    std::vector<bool> is_driven(states_.size());
    for (const std::size_t body : couplings.driven) {
        is_driven[body] = !is_kinematic_[body];
    }
    std::vector<bool> is_moving(states_.size());  // or has been until lately
    bool can_sleep = false;
    for (std::size_t body = 0; body < states_.size(); ++body) {
        SleepState& state = states_[body];
        if (state.is_asleep) {
            continue;
        }
        const bool is_at_rest = !is_driven[body] && is_quiet(body, held, velocities);
        state.quiet_steps = is_at_rest ? state.quiet_steps + 1 : 0;
        is_moving[body] = state.quiet_steps < (is_kinematic_[body] ? 1 : steps_to_sleep_);
        can_sleep = can_sleep || !(is_moving[body] || is_kinematic_[body]);
    }
    if (!can_sleep) {
        return false;
    }
    // Kinematic bodies pass nothing on: they move as told, whatever touches them.
    spread(
        couplings.pairs, [&](std::size_t body) { return !is_kinematic_[body]; }, is_moving);
    bool has_slept = false;
    for (std::size_t body = 0; body < states_.size(); ++body) {
        if (!states_[body].is_asleep && !is_moving[body] && !is_kinematic_[body]) {
            states_[body].is_asleep = true;
            states_[body].contact_stiffness = stiffness;
            has_slept = true;
        }
    }
    return has_slept;
}

template <int Dim>
std::vector<double> Islands<Dim>::stiffness_of_sleepers() const {
    std::vector<double> stiffness;
    for (const SleepState& state : states_) {
        stiffness.push_back(state.is_asleep ? state.contact_stiffness : 0);
    }
    return stiffness;
}

#define PENT_INSTANTIATE(Dim) template class Islands<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
