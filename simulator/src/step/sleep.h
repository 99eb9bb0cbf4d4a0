#pragma once

#include "model/bodies.h"
#include "model/held_vertices.h"
#include "potentials/potential.h"

#include <pent/simulator/simulation.h>

#include <vector>

namespace pent::simulator {

/// Which bodies of a scene sleep; see Sleep. Bodies that are coupled, by contact or otherwise, fall
/// asleep and wake together, as islands. Without Scene::sleep none ever does, and nothing is looked
/// at.
template <int Dim>
class Islands {
public:
    /// @param bodies  Must outlive this.
    /// @param held    At the start; not needed afterwards.
    Islands(const Scene& scene, const Bodies<Dim>& bodies, const HeldVertices<Dim>& held);

    [[nodiscard]] int asleep_count() const;
    [[nodiscard]] const std::vector<SleepState>& states() const { return states_; }
    void set_states(const std::vector<SleepState>& states) { states_ = states; }

    /// One entry a body: whether it sleeps.
    [[nodiscard]] std::vector<bool> asleep() const;

    /// One a body: the stiffness of a barrier when it fell asleep, N/m; 0 for those that are awake.
    [[nodiscard]] std::vector<double> stiffness_of_sleepers() const;

    [[nodiscard]] bool is_on() const { return is_on_; }

    /// Wakes bodies whose Dirichlet vertices move or that are driven, bodies coupled to what moves
    /// or is awake, and what is coupled to these in turn.
    ///
    /// @param from, to  Dim x vertices: where Dirichlet vertices are and will be, m; all others
    ///                  the same in both.
    /// @return          Whether any has woken.
    bool wake(const Couplings& couplings, const Positions<Dim>& from, const Positions<Dim>& to);

    void wake(int body) { states_[static_cast<std::size_t>(body)] = {}; }

    /// Counts a step; islands that have been at rest for long fall asleep.
    ///
    /// @param stiffness  Of a barrier now, N/m.
    /// @return           Whether any has.
    bool put_to_sleep(const Couplings& couplings,
                      const HeldVertices<Dim>& held,
                      const Positions<Dim>& velocities,
                      double stiffness);

private:
    [[nodiscard]] bool is_quiet(std::size_t body,
                                const HeldVertices<Dim>& held,
                                const Positions<Dim>& velocities) const;

    const Bodies<Dim>* bodies_;
    bool is_on_;
    std::uint64_t steps_to_sleep_ = 0;
    std::vector<double> speed_;       // below which a body is at rest, m/s
    std::vector<bool> is_kinematic_;  // moved from outside alone: neither awake nor asleep
    std::vector<SleepState> states_;
};

}  // namespace pent::simulator
