#pragma once

#include "linear/block_kernels.h"
#include "linear/block_matrix.h"
#include "linear/elimination.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace pent::simulator {

/// Cholesky factorization A = L L^T of a symmetric positive definite matrix by the multifrontal
/// method [liu1992]: each supernode assembles its part of A and the updates of its children in a
/// dense front, eliminates its columns there, and hands the update of the rows below to its parent.
template <int Dim>
class Factorization {
public:
    /// @param elimination  Of the links of both parts of the matrix; must outlive this.
    /// @return             Nothing where a pivot is not positive.
    template <typename Scalar>
    [[nodiscard]] static std::optional<Factorization> make(const BlockKernels& kernels,
                                                           const BlockMatrix<Dim, Scalar>& A,
                                                           const Elimination& elimination);

    /// A^-1 b.
    [[nodiscard]] BlockVector<Dim> solve(const BlockVector<Dim>& b) const;

private:
    explicit Factorization(const Elimination& elimination) : elimination_(&elimination) {}

    // The factor below the diagonal block of a supernode.
    [[nodiscard]] auto rows_below(std::size_t s) const;

    const Elimination* elimination_;
    std::vector<Eigen::MatrixXd> panels_;  // of each supernode, see Front
};

}  // namespace pent::simulator
