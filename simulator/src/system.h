#pragma once

#include "block_matrix.h"
#include "conjugate_gradients.h"
#include "contact_matrix.h"
#include "elements.h"
#include "preconditioner.h"
#include "rotation.h"
#include "scene_contacts.h"
#include "world.h"

#include <pent/parallel.h>
#include <pent/simulator/simulation.h>

#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace pent::simulator {

/// Positions, velocities, and what follows from them. Dim x vertices each.
template <int Dim>
struct BodyState {
    Positions<Dim> positions;   ///< m.
    Positions<Dim> velocities;  ///< m/s.
    Positions<Dim> forces;      ///< N: elastic, gravity, contact.
    /// What touches at these positions; null in a scene without contact. Never changed, so that
    /// copies of the state share it.
    std::shared_ptr<const ContactState<Dim>> contacts;
    Energies energies;
    std::int64_t inverted = 0;   ///< Elements.
    std::int64_t collapsed = 0;  ///< Elements.

    [[nodiscard]] bool is_finite() const {
        return positions.allFinite() && velocities.allFinite() && forces.allFinite();
    }
};

/// The linear equation of a step or of a Newton iteration, for the free vertices:
///
///     (mass_factor M + elastic_factor K + contact_factor C + damping_factor K0) dx
///         = right - (elastic_factor K + contact_factor C)_fh held_shift,
///
/// K being the filtered Hessian of the elastic energy, C that of all contacts, K0 the one that
/// System::set_damping_tangent() keeps.
template <int Dim>
struct LinearStep {
    double mass_factor = 1;
    double elastic_factor = 0;  ///< s^2.
    double contact_factor = 0;  ///< s^2.
    double damping_factor = 0;  ///< s^2.
    double tolerance = 0;       ///< Of the linear solve; 0 for that of the scene.
    Positions<Dim> held_shift;  ///< Dim x vertices; how far held ones move, m; 0 elsewhere.
    BlockVector<Dim> right;     ///< Dim x unknowns.
};

/// The physics of a scene, apart from time: forces, energies, matrices, solves.
/// The host's task system, or threads of ours.
[[nodiscard]] inline Workers workers_of(const SimulationOptions& options) {
    return options.tasks ? Workers(*options.tasks) : Workers(options.threads);
}

template <int Dim>
class System {
public:
    System(const Scene& scene, const World<Dim>& world, const SimulationOptions& options);

    /// Sets forces, energies, contacts and the counts of elements from positions and velocities.
    void evaluate(BodyState<Dim>& state);

    /// Lays matrices and elements out anew after the numbering of the world has changed.
    ///
    /// @param asleep     One entry a body. Their elastic forces and energies are kept as they are at
    /// @param positions  Dim x vertices, m.
    void renumber(const std::vector<bool>& asleep, const Positions<Dim>& positions);

    /// Assembles at a state that has been evaluated, and solves; `dx` holds the first guess and then
    /// the solution.
    ///
    /// Where masses would be lost in the rounding of a float matrix, a double one takes its place.
    /// Where the matrix turns out not to be positive definite, which clamping rules out, it is
    /// assembled and solved with once more, clamped.
    [[nodiscard]] LinearSolveReport solve(const BodyState<Dim>& state,
                                          LinearStep<Dim>& step,
                                          BlockVector<Dim>& dx,
                                          StepReport& report);

    /// Keeps the tangent K0 at these positions for Rayleigh damping of the steps that follow, and
    /// its product with how far held vertices travel.
    void set_damping_tangent(const Positions<Dim>& positions,
                             const Positions<Dim>& held_travel,
                             StepReport& report);

    /// K0 travel, for free vertices; held_damping() has the part of the held ones.
    [[nodiscard]] BlockVector<Dim> damping_product(const BlockVector<Dim>& travel) const;
    [[nodiscard]] const BlockVector<Dim>& held_damping() const { return held_damping_; }

    /// Starts a step of length h (s) from an evaluated state: friction acts from there on, and is in its
    /// forces afterwards.
    void begin_step(BodyState<Dim>& now, bool is_linear, double h);

    /// Cells that are inside out in a state that has been evaluated. Smoothed elements may not be where
    /// one of their cells is.
    [[nodiscard]] std::int64_t count_inverted(const BodyState<Dim>& state) const;

    /// How far a step may go before something crosses; all of it without a barrier.
    [[nodiscard]] contact::StepLimit limit_step(const Positions<Dim>& from,
                                                const Positions<Dim>& to);

    /// Tells SimulationOptions::on_move where vertices are on the path of a step.
    void tell_move(const Positions<Dim>& positions, bool is_start) const {
        if (on_move_) {
            on_move_(positions, is_start);
        }
    }

    /// Gives the barrier a stiffness, N/m, and evaluates the state with it.
    void set_barrier_stiffness(double stiffness, BodyState<Dim>& state);

    /// What contact cost since the last call.
    [[nodiscard]] ContactWork take_contact_work() { return std::exchange(contact_work_, {}); }

    [[nodiscard]] const SceneContacts<Dim>& contacts() const { return contacts_; }
    [[nodiscard]] const Damping& damping() const { return damping_; }
    [[nodiscard]] const SolverOptions& options() const { return options_; }

    [[nodiscard]] const Workers& workers() const { return workers_; }
    [[nodiscard]] Isa isa() const { return isa_; }
    [[nodiscard]] SimulationSize size() const;

private:
    /// Elasticity of bodies that sleep, which does not change.
    struct Frozen {
        Positions<Dim> forces;  // Dim x vertices, N; empty if none sleeps
        RunEnergy energy;
    };

    [[nodiscard]] ElementLayout<Dim> lay_out(const Numbering& numbering) const;
    void set_up_solver();
    void find_contacts(BodyState<Dim>& state);
    template <typename Scalar>
    LinearSolveReport solve_with(BlockMatrix<Dim, Scalar>& matrix,
                                 const BodyState<Dim>& state,
                                 Filter filter,
                                 LinearStep<Dim> step,
                                 BlockVector<Dim>& dx,
                                 StepReport& report);
    template <typename Scalar>
    [[nodiscard]] bool has_lost_inertia(const BlockMatrix<Dim, Scalar>& matrix,
                                        double factor) const;
    template <typename Scalar>
    LinearSolveReport iterate(const BlockMatrix<Dim, Scalar>& matrix,
                              const Positions<Dim>& positions,
                              const LinearStep<Dim>& step,
                              BlockVector<Dim>& dx);
    template <typename Scalar>
    void add_masses(BlockMatrix<Dim, Scalar>& matrix, double factor) const;
    template <typename Scalar>
    [[nodiscard]] std::unique_ptr<CouplingMatrix<Dim, Scalar>> add_contacts(
        const BodyState<Dim>& state, LinearStep<Dim>& step, BlockMatrix<Dim, Scalar>& matrix);

    template <typename Scalar>
    [[nodiscard]] std::unique_ptr<Preconditioner<Dim>> precondition(
        const BlockMatrix<Dim, Scalar>& matrix, const Positions<Dim>& positions) const;

    const World<Dim>* world_;
    SolverOptions options_;
    Vector<Dim> gravity_;
    Damping damping_;
    Workers workers_;
    Isa isa_;
    const Kernels<Dim>* kernels_;
    ElementLayout<Dim> layout_;
    Frozen frozen_;
    SceneContacts<Dim> contacts_;
    std::function<void(const Eigen::MatrixXd&, bool)> on_move_;
    ContactWork contact_work_;                 // since it was last taken
    std::vector<std::uint32_t> column_start_;  // columns the preconditioner solves together
    Aggregates aggregates_;                    // for the coarse space, if there is one
    std::unique_ptr<BlockMatrix<Dim, float>> float_matrix_;
    std::unique_ptr<BlockMatrix<Dim, double>> double_matrix_;
    std::unique_ptr<BlockMatrix<Dim, double>> damping_tangent_;  // only where it is used
    BlockVector<Dim> held_damping_;
    LinearSolveSpace<Dim> space_;
};

}  // namespace pent::simulator
