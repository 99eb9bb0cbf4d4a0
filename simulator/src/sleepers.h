#pragma once

#include "scene_contacts.h"
#include "world.h"

#include <pent/simulator/simulation.h>

#include <vector>

namespace pent::simulator {

/// Which bodies of a scene sleep; see Sleep. Without Scene::sleep none ever does, and nothing is
/// looked at.
template <int Dim>
class Sleepers {
public:
    /// @param world  Must outlive this.
    Sleepers(const Scene& scene, const World<Dim>& world);

    [[nodiscard]] int count() const;  ///< Of bodies that sleep.
    [[nodiscard]] const std::vector<BodyRest>& rest() const { return rest_; }
    void set_rest(const std::vector<BodyRest>& rest) { rest_ = rest; }

    /// One entry a body: whether it sleeps.
    [[nodiscard]] std::vector<bool> asleep() const;

    /// Wakes bodies whose held vertices move, bodies in contact with what moves or is awake, and what
    /// these touch in turn.
    ///
    /// @param contacts  Null if nothing can touch.
    /// @param from, to  Dim x vertices: where held vertices are and will be.
    /// @return          Whether any has woken.
    bool wake(const ContactState<Dim>* contacts,
              const Positions<Dim>& from,
              const Positions<Dim>& to);

    void wake(int body) { rest_[static_cast<std::size_t>(body)] = {}; }

    /// Counts a step; bodies that have been at rest for long, and touch nothing else, fall asleep.
    ///
    /// @return  Whether any has.
    bool settle(const ContactState<Dim>* contacts, const Positions<Dim>& velocities);

private:
    [[nodiscard]] bool is_quiet(std::size_t body, const Positions<Dim>& velocities) const;

    const World<Dim>* world_;
    bool is_on_;
    std::uint64_t steps_to_sleep_ = 0;
    std::vector<double> speed_;       // below which a body is at rest, m/s
    std::vector<bool> is_kinematic_;  // held everywhere: neither awake nor asleep
    std::vector<BodyRest> rest_;
};

}  // namespace pent::simulator
