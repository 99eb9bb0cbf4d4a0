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
/// The residual that is updated from iteration to iteration drifts away from b - A x. The latter
/// decides at the end; where it is too large the iteration restarts from there.
template <int Dim>
class ConjugateGradients {
public:
    /// @param workers, kernels  Must outlive this.
    ConjugateGradients(const Workers& workers, const BlockKernels& kernels)
        : workers_(&workers), kernels_(&kernels) {}

    /// What another way to solve the same equation costs, in iterations. Asked once a few
    /// iterations have been made.
    using Alternative = std::function<double()>;

    /// @param alternative  Where more iterations seem to be left than it costs, at the rate of the
    ///                     last ones (half as many as it costs), the solve ends with `is_slow`.
    ///                     While fewer have been made than it costs, which tells less of those to
    ///                     come, proportionally more have to be left.
    template <typename Scalar>
    [[nodiscard]] LinearSolution<Dim> solve(const BlockMatrix<Dim, Scalar>& A,
                                            const Preconditioner<Dim>& preconditioner,
                                            const BlockVector<Dim>& b,
                                            const LinearSolveOptions& options,
                                            BlockVector<Dim> guess,
                                            const Halo& halo = {},
                                            const Alternative& alternative = nullptr);

private:
    // r_ = b - A x, after an exchange of ghosts of x; returns relative_residual().
    template <typename Scalar>
    double find_residual(const BlockMatrix<Dim, Scalar>& A,
                         const BlockVector<Dim>& b,
                         BlockVector<Dim>& x);
    // Given r_ = b - A x, scales the guess x to be nearest to the solution in the norm of A, never
    // farther than 0 is, and r_ with it; returns relative_residual(). A guess by inertia alone is
    // far from what stiff bodies do.
    double scale_guess(Eigen::Index rows, const BlockVector<Dim>& b, BlockVector<Dim>& x);
    // |r_| / |b|, the largest over the norms of LinearSolveOptions.
    //
    // @param r_square  |r_|^2 of the rows of this rank.
    [[nodiscard]] double relative_residual(double r_square) const;
    // Iterates from x, whose residual is r_, until the updated residual is `enough`, iterations run
    // out or take too long, or a direction shows that A is not positive definite.
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
    // Ghosts are used in x and p only.
    BlockVector<Dim> r_;  // kept between solves
    BlockVector<Dim> z_;
    BlockVector<Dim> p_;
    BlockVector<Dim> q_;
    std::span<const Eigen::VectorXd> weights_;  // of the current solve, see LinearSolveOptions
    std::vector<double> b_norms_;               // |b|, then |b| in the norm of each of these
};

}  // namespace pent::simulator
