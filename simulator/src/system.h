#pragma once

#include "block_matrix.h"
#include "conjugate_gradients.h"
#include "elements.h"
#include "parallel.h"
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

    [[nodiscard]] bool is_finite() const {
        return positions.allFinite() && velocities.allFinite() && forces.allFinite();
    }
};

/// The linear equation of a step or of a Newton iteration, for the free vertices:
///
///     (mass_factor M + stiffness_factor K) dx = right - stiffness_factor K_fh held_shift,
///
/// K being the filtered Hessian of the elastic energy and the Hessian of the obstacles.
template <int Dim>
struct LinearStep {
    double mass_factor = 1;
    double stiffness_factor = 0;  ///< s^2.
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
    [[nodiscard]] LinearSolveReport solve_step(const Positions<Dim>& positions,
                                               LinearStep<Dim>& step,
                                               BlockVector<Dim>& dx,
                                               StepReport& report);

    [[nodiscard]] const Workers& workers() const { return workers_; }
    [[nodiscard]] Isa isa() const { return isa_; }
    [[nodiscard]] SimulationSize size() const;

private:
    template <typename Scalar>
    LinearSolveReport solve_with(BlockMatrix<Dim, Scalar>& matrix,
                                 const Positions<Dim>& positions,
                                 LinearStep<Dim>& step,
                                 BlockVector<Dim>& dx,
                                 StepReport& report);
    template <typename Scalar>
    void add_diagonal(BlockMatrix<Dim, Scalar>& matrix,
                      const Positions<Dim>& positions,
                      const LinearStep<Dim>& step) const;

    const World<Dim>* world_;
    SolverOptions options_;
    Vector<Dim> gravity_;
    std::vector<Obstacle> obstacles_;
    Workers workers_;
    Isa isa_;
    const Kernels<Dim>* kernels_;
    BlockPattern pattern_;
    Elements<Dim> elements_;
    std::unique_ptr<BlockMatrix<Dim, float>> float_matrix_;
    std::unique_ptr<BlockMatrix<Dim, double>> double_matrix_;
    LinearSolveSpace<Dim> space_;
};

}  // namespace pent::simulator
