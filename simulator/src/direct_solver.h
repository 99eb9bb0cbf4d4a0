#pragma once

#include "conjugate_gradients.h"

namespace pent::simulator {

/// Most free vertices a direct solve takes: in 4D that many take ten seconds a solve, and the time
/// grows with their number to the power 2.9.
inline constexpr std::int64_t kMostDirectVertices = 2500;

/// A x = b by sparse L D L^T in double: the reference that iterations are compared with. The residual is
/// that of rounding; a pivot that is not positive counts as breakdown.
template <int Dim, typename Scalar>
[[nodiscard]] LinearSolveReport solve_directly(const BlockMatrix<Dim, Scalar>& A,
                                               const BlockVector<Dim>& b,
                                               BlockVector<Dim>& x);

}  // namespace pent::simulator
