#pragma once

#include "linear/linear_solver.h"
#include "model/held_vertices.h"
#include "potentials/mass_distance.h"
#include "potentials/rayleigh_damping.h"
#include "potentials/scene_energy.h"
#include "step/force_scales.h"
#include "step/matrix_range.h"
#include "step/objective.h"
#include "step/step_problem.h"

#include <cstdint>
#include <functional>
#include <memory>

namespace pent::simulator {

/// What linear solves did since this was last asked.
struct SolveWork {
    int iterations = 0;           ///< Of the linear solver.
    double residual = 0;          ///< Largest |b - A x| / |b|.
    std::int64_t unknowns = 0;    ///< Scalars solved for.
    std::int64_t hessians = 0;    ///< Of elements in the matrices that were solved with,
    std::int64_t filtered = 0;    ///< and of these, on this rank, those that the filter changed.
    double assembly_seconds = 0;  ///< Without stencils.
    double stencil_seconds = 0;   ///< Summing up stencils, of which contact makes most.
    double solve_seconds = 0;
};

/// The function that the end of a time step minimizes, see StepProblem: a weighted sum of terms
/// over the vertices that have dofs. The one place that knows how terms are weighted, which
/// vertices are free, and how the linear equations are solved.
template <int Dim>
class IncrementalPotential final : public Objective<Dim> {
public:
    /// Told where vertices are on the path of a step, Dim x vertices, m; true where it starts.
    using Observer = std::function<void(const Eigen::MatrixXd& positions, bool is_start)>;

    /// @param workers, kernels, bodies, energy  Must outlive this.
    /// @param held                              Now; all bodies are awake.
    IncrementalPotential(const Workers& workers,
                         const Kernels<Dim>& kernels,
                         const Bodies<Dim>& bodies,
                         const HeldVertices<Dim>& held,
                         const Scene& scene,
                         SceneEnergy<Dim>& energy);

    /// Throws an Error where a direct solve would take more memory than there is, or is asked of
    /// ranks.
    ///
    /// @param memory  Bytes; 0 for no limit.
    void refuse_unsolvable(std::int64_t memory) const;

    /// Solves for some bodies alone from now on, and for what of them is not held now.
    ///
    /// @param held       Now.
    /// @param asleep     One entry a body: those that are not solved for.
    /// @param positions  Dim x vertices: where these lie, m.
    void renumber(const HeldVertices<Dim>& held,
                  const std::vector<bool>& asleep,
                  const Positions<Dim>& positions);

    /// Starts a step; the energy must have been evaluated where it starts.
    void begin_step(std::shared_ptr<const StepProblem<Dim>> problem, const StepStart<Dim>& start);

    /// Whether solve() may give directions that are not exact in the step that has begun: what
    /// conjugate gradients leave at max_iterations, or what rounding leaves of inertia.
    void accept_rough_directions(bool may_be_rough) { may_be_rough_ = may_be_rough; }

    /// Lets terms choose their stiffness, see Potential::balance(); the energy as for begin_step().
    void balance(const Positions<Dim>& x);

    [[nodiscard]] Evaluation<Dim> evaluate(const Positions<Dim>& x) override;
    [[nodiscard]] GradientNorms norms(const Positions<Dim>& gradient) const override {
        return scales_.norms(gradient);
    }
    [[nodiscard]] NewtonDirection<Dim> solve(const Positions<Dim>& gradient,
                                             const Positions<Dim>& displacement,
                                             double tolerance) override;
    [[nodiscard]] Positions<Dim> prescribed_displacement(const Positions<Dim>& x) const override;
    [[nodiscard]] double max_step(const Positions<Dim>& from, const Positions<Dim>& to) override {
        return energy_->max_step(from, to);
    }
    [[nodiscard]] bool accept(const Positions<Dim>& x) override;

    void set_observer(Observer observer) { observer_ = std::move(observer); }
    void tell_start(const Positions<Dim>& x) const;

    [[nodiscard]] const DofMap& dofs() const { return *dofs_; }
    [[nodiscard]] SolveWork take_work() { return std::exchange(work_, {}); }
    [[nodiscard]] std::int64_t take_damping_hessians() { return stiffness_drag_.take_hessians(); }

    /// Bytes of a block of the matrix, with those of a tangent that damping keeps.
    [[nodiscard]] std::int64_t bytes_per_block() const;
    [[nodiscard]] std::int64_t tangent_bytes() const;

    /// Bytes that a direct solve takes, 0 if there is none.
    [[nodiscard]] std::int64_t factor_bytes() const;

private:
    [[nodiscard]] DofOwners find_owners() const;
    void set_up_solver();
    [[nodiscard]] bool assemble(NewtonSystem<Dim>& system,
                                Filter filter,
                                const Positions<Dim>& gradient,
                                const Positions<Dim>& displacement);
    [[nodiscard]] NewtonSystem<Dim>* assemble_somehow(Filter filter,
                                                      const Positions<Dim>& gradient,
                                                      const Positions<Dim>& displacement);
    [[nodiscard]] LinearSolution<Dim> solve_filtered(const NewtonSystem<Dim>& system,
                                                     double tolerance);

    const Workers* workers_;
    const Kernels<Dim>* kernels_;
    const Bodies<Dim>* bodies_;
    SolverOptions options_;
    Damping damping_;
    PotentialEnergy<Dim>* energy_;
    Elasticity<Dim>* elasticity_;
    // Never rewritten, but replaced: those who were given one keep it as it was.
    std::shared_ptr<const DofMap> dofs_;           // alike on all ranks
    std::shared_ptr<const DofMap> rows_;           // the same as this rank has them in its matrix
    std::shared_ptr<const BlockPattern> pattern_;  // of elements, by rows
    ForceScales<Dim> scales_;
    MatrixRange range_;
    MassDistance<Dim> inertia_;
    MassDistance<Dim> mass_drag_;
    RayleighDamping<Dim> stiffness_drag_;
    std::unique_ptr<LinearSolver<Dim>> solver_;
    // The second one is made where float turns out too coarse.
    std::unique_ptr<NewtonSystem<Dim>> float_system_;
    std::unique_ptr<NewtonSystem<Dim>> double_system_;
    bool was_double_needed_ = false;  // whether the last matrix had to be in double
    std::shared_ptr<const StepProblem<Dim>> problem_;
    bool may_be_rough_ = false;
    Observer observer_;
    SolveWork work_;
};

}  // namespace pent::simulator
