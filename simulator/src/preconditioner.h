#pragma once

#include "block_matrix.h"

#include <memory>
#include <vector>

namespace pent::simulator {

/// z = B r for a symmetric positive definite B near the inverse of a matrix.
template <int Dim>
class Preconditioner {
public:
    virtual ~Preconditioner() = default;
    virtual void apply(const Workers& workers,
                       const BlockVector<Dim>& r,
                       BlockVector<Dim>& z) const = 0;
};

/// Inverses of the diagonal blocks.
template <int Dim, typename Scalar>
[[nodiscard]] std::unique_ptr<Preconditioner<Dim>> block_jacobi(
    const Workers& workers, const BlockMatrix<Dim, Scalar>& matrix);

}  // namespace pent::simulator
