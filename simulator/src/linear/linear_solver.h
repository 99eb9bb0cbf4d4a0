#pragma once

#include "linear/linear_solve.h"
#include "linear/newton_system.h"
#include "linear/sharing.h"

#include <memory>
#include <vector>

namespace pent::simulator {

/// Solves the symmetric positive definite equations of Newton's method.
///
/// The matrix is in float or in double, as its NewtonSystem has it, and vectors are in double. That
/// floats give way to doubles is decided while a matrix is put together, not here: what floats lose
/// is lost by then, and only the terms can add it up anew. NewtonSystem::has_lost_inertia() says
/// so, and the sum that a step minimizes assembles the same equation in double.
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
    /// @param guess      Dim x dofs; of use to iterations alone.
    [[nodiscard]] virtual LinearSolution<Dim> solve(const NewtonSystem<Dim>& system,
                                                    const BlockVector<Dim>& positions,
                                                    const LinearSolveOptions& options,
                                                    BlockVector<Dim> guess) = 0;
};

/// Where dofs are at home; empty where nothing is shared.
struct DofOwners {
    const Sharing* sharing = nullptr;
    std::vector<std::uint32_t> ranks;   ///< Of each dof.
    std::vector<std::uint32_t> places;  ///< Its number there.
};

/// What an iterative solver knows of the dofs.
template <int Dim>
struct DofGeometry {
    std::vector<std::uint32_t> column_start;  ///< As DofMap::column_start().
    BlockVector<Dim> rest;                    ///< Dim x dofs, m.
    DofOwners owners = {};
};

/// Preconditioned conjugate gradients. Where dofs are shared all ranks solve together, and the
/// solution has the rows of this rank.
///
/// With rigid modes, where iterations go on for longer than it takes to factor the matrix, as those
/// of slender stiff bodies, it is factored: one iteration more is then the last.
///
/// @param workers, kernels  Must outlive the solver.
template <int Dim>
[[nodiscard]] std::unique_ptr<LinearSolver<Dim>> make_iterative_solver(
    const Workers& workers,
    const BlockKernels& kernels,
    PreconditionerKind preconditioner,
    DofGeometry<Dim> geometry);

/// Sparse L L^T in double, see Factorization. The residual is that of rounding; a pivot that is not
/// positive counts as breakdown.
///
/// @param kernels  Must outlive the solver.
/// @param rest     Dim x dofs, m.
template <int Dim>
[[nodiscard]] std::unique_ptr<LinearSolver<Dim>> make_direct_solver(const BlockKernels& kernels,
                                                                    BlockVector<Dim> rest);

/// Memory that a direct solve takes, where nothing touches.
template <int Dim>
[[nodiscard]] std::int64_t direct_bytes(const BlockPattern& pattern, const BlockVector<Dim>& rest);

}  // namespace pent::simulator
