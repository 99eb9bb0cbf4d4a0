#pragma once

#include "linear/block_matrix.h"
#include "linear/halo.h"
#include "linear/linear_solve.h"
#include "linear/preconditioner.h"

#include <functional>
#include <span>
#include <vector>

namespace pent::simulator {

/// Preconditioned conjugate gradients for A x = b, A symmetric positive definite.
///
/// The residual that is carried along drifts from the true one; the true one decides at the end,
/// and where it is too large the iteration starts again from there.
template <int Dim>
class ConjugateGradients {
public:
    /// @param workers, kernels  Must outlive this.
    ConjugateGradients(const Workers& workers, const BlockKernels& kernels)
        : workers_(&workers), kernels_(&kernels) {}

    /// As many iterations as another way to solve the same equation takes time, asked once there
    /// have been a few.
    using Alternative = std::function<double()>;

    /// @param alternative  Taken where that many more would not be enough at the rate of the last
    ///                     iterations, half that many; before so many have been made, where so many
    ///                     times more would not be as they are fewer.
    template <typename Scalar>
    [[nodiscard]] LinearSolution<Dim> solve(const BlockMatrix<Dim, Scalar>& A,
                                            const Preconditioner<Dim>& preconditioner,
                                            const BlockVector<Dim>& b,
                                            const LinearSolveOptions& options,
                                            BlockVector<Dim> guess,
                                            const Halo& halo = {},
                                            const Alternative& alternative = nullptr);

private:
    // r_ = b - A x; returns what is left of b.
    template <typename Scalar>
    double find_residual(const BlockMatrix<Dim, Scalar>& A,
                         const BlockVector<Dim>& b,
                         BlockVector<Dim>& x);
    // From r_ = b - A x on: takes the multiple of the guess x that is nearest to the solution in
    // the norm of A, where none can be farther than 0 is, and its residual; returns what is left of
    // b. What inertia alone would do is far from what stiff bodies do.
    double scale_guess(Eigen::Index rows, const BlockVector<Dim>& b, BlockVector<Dim>& x);
    // What r_ is of b, by the norm in which that is more.
    [[nodiscard]] double part_left(double r_square) const;
    // From x, whose residual is r_, until the one that is carried along is small enough, iterations
    // are spent or take too long, or a direction shows that A is not positive definite.
    template <typename Scalar>
    void iterate(const BlockMatrix<Dim, Scalar>& A,
                 const Preconditioner<Dim>& preconditioner,
                 const LinearSolveOptions& options,
                 double enough,
                 const Alternative& alternative,
                 LinearSolution<Dim>& solution);

    const Workers* workers_;
    const BlockKernels* kernels_;
    Halo halo_;
    // Columns of other ranks count in x and p alone, and there as ghosts.
    BlockVector<Dim> r_;  // kept between solves
    BlockVector<Dim> z_;
    BlockVector<Dim> p_;
    BlockVector<Dim> q_;
    std::span<const Eigen::VectorXd> weights_;  // of the solve that goes on, see LinearSolveOptions
    std::vector<double> b_norms_;               // |b|, and those by weights
};

}  // namespace pent::simulator
