#pragma once

#include "lagged_friction.h"
#include "world.h"

#include <pent/contact/barrier_finder.h>
#include <pent/contact/contacts.h>
#include <pent/parallel.h>
#include <pent/simulator/simulation.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace pent::simulator {

/// The filtered Hessian of one contact whose weights move, N/m.
template <int Dim>
struct LocalHessian {
    std::array<std::uint32_t, Dim + 1> vertices{};
    int count = 0;                       ///< Vertices in use.
    contact::StencilMatrix<Dim> matrix;  ///< Rows of the first `count` vertices are in use.
};

/// Everything that touches at some positions of the scene.
template <int Dim>
struct ContactState {
    std::vector<contact::Contact<Dim>> pairs;  ///< With a barrier without Hessians: see `barrier`.
    std::vector<contact::ObstacleContact<Dim>> obstacles;
    contact::BarrierContacts<Dim> barrier;  ///< The pairs once more, as the barrier has them.
    Positions<Dim> barrier_forces;          ///< Dim x vertices, N; empty without a barrier.
    FrictionState<Dim> friction;
    ContactSummary summary;      ///< Its work is that of finding this state, without seconds.
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

    [[nodiscard]] bool is_empty() const { return !finder_ && !barrier_ && obstacles_.empty(); }
    [[nodiscard]] bool has_barrier() const { return barrier_ != nullptr; }
    [[nodiscard]] bool has_friction() const { return friction_ != nullptr; }

    /// Contacts at these positions (Dim x vertices): the same for any history and any number of threads.
    [[nodiscard]] ContactState<Dim> find(const Workers& workers, const Positions<Dim>& positions);

    /// Starts a step of length h (s) from contacts that find() gave: from there on friction acts.
    ///
    /// @param velocities  As for LaggedFriction::begin_step().
    void begin_step(const ContactState<Dim>& now,
                    const Positions<Dim>& positions,
                    const Positions<Dim>* velocities,
                    double h);

    /// Hessians of the pairs of a barrier, in their order.
    [[nodiscard]] std::vector<LocalHessian<Dim>> hessians(const Workers& workers,
                                                          const ContactState<Dim>& state,
                                                          const Positions<Dim>& positions) const;

    /// How far a step may go without a crossing: all of it without a barrier.
    [[nodiscard]] contact::StepLimit limit_step(const Workers& workers,
                                                const Positions<Dim>& from,
                                                const Positions<Dim>& to);

    /// What crosses where a barrier is to keep things apart; empty without one.
    [[nodiscard]] std::vector<contact::Crossing> find_crossings(
        const Workers& workers, const Positions<Dim>& positions) const;

    /// One line about a crossing or what is in the way of a step.
    [[nodiscard]] std::string describe(const contact::Crossing& crossing) const;

    /// Stiffness of a barrier now, N/m; never below that of the scene.
    [[nodiscard]] double stiffness() const { return stiffness_; }
    void set_stiffness(double stiffness) { stiffness_ = stiffness; }
    [[nodiscard]] const Contact& options() const { return options_; }

    /// Lines for the user about a distance of contact that does not suit the meshes.
    [[nodiscard]] std::vector<std::string> warnings() const;

    [[nodiscard]] std::int64_t bytes() const;

private:
    void find_barrier(const Positions<Dim>& positions, ContactState<Dim>& state);

    Contact options_;
    double stiffness_ = 0;                                  // of a barrier
    std::unique_ptr<contact::ContactFinder<Dim>> finder_;   // null without contact between bodies
    std::unique_ptr<contact::BarrierFinder<Dim>> barrier_;  // null but with a barrier
    std::unique_ptr<LaggedFriction<Dim>> friction_;         // null without friction
    std::vector<contact::PenaltyObstacle<Dim>> obstacles_;
    std::vector<std::uint32_t> free_vertices_;  // ascending; empty without obstacles
};

}  // namespace pent::simulator
