#pragma once

#include "linear/linear_solve.h"
#include "linear/newton_system.h"
#include "linear/sharing.h"

#include <memory>
#include <vector>

namespace pent::simulator {

/// Solves the symmetric positive definite equations of Newton's method.
///
/// The matrix is in float or in double, as its NewtonSystem has it; vectors are in double. Whether
/// float is enough is decided during assembly, not here: what rounding has lost by now only a new
/// assembly can bring back. So where NewtonSystem::has_lost_inertia(), IncrementalPotential
/// assembles the same equation once more in double.
template <int Dim>
class LinearSolver {
public:
    LinearSolver() = default;
    virtual ~LinearSolver() = default;
    LinearSolver(const LinearSolver&) = delete;
    LinearSolver& operator=(const LinearSolver&) = delete;
    LinearSolver(LinearSolver&&) = delete;
    LinearSolver& operator=(LinearSolver&&) = delete;

    /// @param positions  Dim x dofs, m: where the vertices are now.
    /// @param guess      Dim x dofs: initial guess; direct solvers do not use it.
    [[nodiscard]] virtual LinearSolution<Dim> solve(const NewtonSystem<Dim>& system,
                                                    const BlockVector<Dim>& positions,
                                                    const LinearSolveOptions& options,
                                                    BlockVector<Dim> guess) = 0;
};

/// Which rank owns each dof; empty without ranks.
struct DofOwners {
    const Sharing* sharing = nullptr;
    std::vector<std::uint32_t> ranks;   ///< The owner of each dof.
    std::vector<std::uint32_t> places;  ///< The number of the dof on that rank.
};

/// What an iterative solver knows of the dofs.
template <int Dim>
struct DofGeometry {
    std::vector<std::uint32_t> column_start;  ///< As DofMap::column_start().
    BlockVector<Dim> rest;                    ///< Dim x dofs, m.
    DofOwners owners = {};
};

/// Preconditioned conjugate gradients. With ranks all solve together, and the solution has the rows
/// of this rank.
///
/// With the preconditioner RigidModes a matrix is factored after all where iterations take longer
/// than that would, as those of slender stiff bodies do: one more iteration is then the last.
///
/// @param workers, kernels  Must outlive the solver.
template <int Dim>
[[nodiscard]] std::unique_ptr<LinearSolver<Dim>> make_iterative_solver(
    const Workers& workers,
    const BlockKernels& kernels,
    PreconditionerKind preconditioner,
    DofGeometry<Dim> geometry);

/// Sparse Cholesky factorization in double, see Factorization. The residual that remains is due to
/// rounding; a pivot that is not positive counts as breakdown.
///
/// @param kernels  Must outlive the solver.
/// @param rest     Dim x dofs, m.
template <int Dim>
[[nodiscard]] std::unique_ptr<LinearSolver<Dim>> make_direct_solver(const BlockKernels& kernels,
                                                                    BlockVector<Dim> rest);

/// Bytes that a direct solve takes, without contact.
template <int Dim>
[[nodiscard]] std::int64_t direct_bytes(const BlockPattern& pattern, const BlockVector<Dim>& rest);

}  // namespace pent::simulator
