#pragma once

#include "parallel.h"
#include "world.h"

#include <pent/contact/contacts.h>
#include <pent/simulator/simulation.h>

#include <memory>
#include <vector>

namespace pent::simulator {

/// Everything that touches at some positions of the scene.
template <int Dim>
struct ContactState {
    std::vector<contact::Contact<Dim>> pairs;
    std::vector<contact::ObstacleContact<Dim>> obstacles;
    ContactSummary summary;      ///< Its counts and seconds are those of finding this state.
    double energy = 0;           ///< Of the pairs, J.
    double obstacle_energy = 0;  ///< J.

    /// Adds the forces of all contacts to `forces` (Dim x vertices), N.
    void add_forces(Positions<Dim>& forces) const;
};

/// Finds what touches in a scene. One without [contact] and [[obstacle]] has nothing here: no
/// surface, no tree, no search.
template <int Dim>
class SceneContacts {
public:
    SceneContacts(const Scene& scene, const World<Dim>& world);

    [[nodiscard]] bool is_empty() const { return !finder_ && obstacles_.empty(); }

    /// Contacts at these positions (Dim x vertices): the same for any history and any number of threads.
    [[nodiscard]] ContactState<Dim> find(const Workers& workers, const Positions<Dim>& positions);

    /// Lines for the user about a distance of contact that does not suit the meshes.
    [[nodiscard]] std::vector<std::string> warnings() const;

    [[nodiscard]] std::int64_t bytes() const;

private:
    std::unique_ptr<contact::ContactFinder<Dim>> finder_;  // null without contact between bodies
    std::vector<contact::PenaltyObstacle<Dim>> obstacles_;
    std::vector<std::uint32_t> free_vertices_;  // ascending; empty without obstacles
};

}  // namespace pent::simulator
