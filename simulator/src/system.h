#pragma once

#include "block_matrix.h"
#include "conjugate_gradients.h"
#include "elements.h"
#include "parallel.h"
#include "preconditioner.h"
#include "rotation.h"
#include "world.h"

#include <pent/simulator/simulation.h>

#include <memory>
#include <vector>

namespace pent::simulator {

/// Positions, velocities, and what follows from them. Dim x vertices each.
template <int Dim>
struct BodyState {
    Positions<Dim> positions;   ///< m.
    Positions<Dim> velocities;  ///< m/s.
    Positions<Dim> forces;      ///< N: elastic, gravity, obstacles.
    Energies energies;
    std::int64_t inverted = 0;
    std::int64_t collapsed = 0;

    [[nodiscard]] bool is_finite() const {
        return positions.allFinite() && velocities.allFinite() && forces.allFinite();
    }
};

/// The linear equation of a step or of a Newton iteration, for the free vertices:
///
///     (mass_factor M + stiffness_factor K + damping_factor K0) dx
///         = right - stiffness_factor K_fh held_shift,
///
/// K being the filtered Hessian of the elastic energy and the Hessian of the obstacles, K0 the one
/// that System::set_damping_tangent() keeps.
template <int Dim>
struct LinearStep {
    double mass_factor = 1;
    double stiffness_factor = 0;  ///< s^2.
    double damping_factor = 0;    ///< s^2.
    double tolerance = 0;         ///< Of the linear solve; 0 for that of the scene.
    Positions<Dim> held_shift;    ///< Dim x vertices; how far held ones move, m; 0 elsewhere.
    BlockVector<Dim> right;       ///< Dim x unknowns.
};

/// The physics of a scene, apart from time: forces, energies, matrices, solves.
template <int Dim>
class System {
public:
    System(const Scene& scene, const World<Dim>& world, const SimulationOptions& options);

    /// Sets forces, energies and the count of inverted elements from positions and velocities.
    void evaluate(BodyState<Dim>& state) const;

    /// Assembles at `positions` and solves; `dx` holds the first guess and then the solution.
    ///
    /// Where the matrix turns out not to be positive definite, which clamping rules out, it is
    /// assembled and solved with once more, clamped.
    [[nodiscard]] LinearSolveReport solve(const Positions<Dim>& positions,
                                          LinearStep<Dim>& step,
                                          BlockVector<Dim>& dx,
                                          StepReport& report);

    /// Keeps the tangent K0 at these positions for Rayleigh damping of the steps that follow, and
    /// its product with how far held vertices travel.
    void set_damping_tangent(const Positions<Dim>& positions, const Positions<Dim>& held_travel);

    /// K0 travel, for free vertices; held_damping() has the part of the held ones.
    [[nodiscard]] BlockVector<Dim> damping_product(const BlockVector<Dim>& travel) const;
    [[nodiscard]] const BlockVector<Dim>& held_damping() const { return held_damping_; }

    [[nodiscard]] const Damping& damping() const { return damping_; }
    [[nodiscard]] const SolverOptions& options() const { return options_; }

    [[nodiscard]] const Workers& workers() const { return workers_; }
    [[nodiscard]] Isa isa() const { return isa_; }
    [[nodiscard]] SimulationSize size() const;

private:
    template <typename Scalar>
    LinearSolveReport solve_with(BlockMatrix<Dim, Scalar>& matrix,
                                 const Positions<Dim>& positions,
                                 Filter filter,
                                 LinearStep<Dim> step,
                                 BlockVector<Dim>& dx,
                                 StepReport& report);
    template <typename Scalar>
    void add_diagonal(BlockMatrix<Dim, Scalar>& matrix,
                      const Positions<Dim>& positions,
                      const LinearStep<Dim>& step) const;

    template <typename Scalar>
    [[nodiscard]] std::unique_ptr<Preconditioner<Dim>> precondition(
        const BlockMatrix<Dim, Scalar>& matrix, const Positions<Dim>& positions) const;

    const World<Dim>* world_;
    SolverOptions options_;
    Vector<Dim> gravity_;
    std::vector<Obstacle> obstacles_;
    Damping damping_;
    Workers workers_;
    Isa isa_;
    const Kernels<Dim>* kernels_;
    BlockPattern pattern_;
    Elements<Dim> elements_;
    std::vector<std::uint32_t> column_start_;  // columns the preconditioner solves together
    Aggregates aggregates_;                    // for the coarse space, if there is one
    std::unique_ptr<BlockMatrix<Dim, float>> float_matrix_;
    std::unique_ptr<BlockMatrix<Dim, double>> double_matrix_;
    std::unique_ptr<BlockMatrix<Dim, double>> damping_tangent_;  // only where it is used
    BlockVector<Dim> held_damping_;
    LinearSolveSpace<Dim> space_;
};

}  // namespace pent::simulator
