#pragma once

#include "linear/block_matrix.h"
#include "linear/dof_map.h"
#include "linear/hessian_stencil.h"

#include <pent/parallel.h>

#include <memory>
#include <vector>

namespace pent::simulator {

/// A matrix with a pattern of its own.
template <int Dim, typename Scalar>
struct CouplingMatrix {
    explicit CouplingMatrix(BlockPattern own) : pattern(std::move(own)), matrix(pattern) {}
    CouplingMatrix(const CouplingMatrix&) = delete;
    CouplingMatrix& operator=(const CouplingMatrix&) = delete;
    CouplingMatrix(CouplingMatrix&&) = delete;
    CouplingMatrix& operator=(CouplingMatrix&&) = delete;
    ~CouplingMatrix() = default;

    BlockPattern pattern;
    BlockMatrix<Dim, Scalar> matrix;
};

/// Adds stencils to a matrix.
///
/// Blocks that the pattern of `matrix` has a place for go there. The others (of contact all those
/// between the two simplices of a pair) are returned on a pattern of their own, made anew each
/// time, since contacts change; it is small where little touches. Each row is summed by one thread
/// in the order of the stencils.
///
/// @param displacement  Dim x vertices: how far vertices without a dof move, m.
/// @param right         Dim x dofs; the columns of such vertices times displacement are subtracted.
/// @return              Null if no block is left over.
template <int Dim, typename Scalar>
[[nodiscard]] std::unique_ptr<CouplingMatrix<Dim, Scalar>> assemble_stencils(
    const Workers& workers,
    const DofMap& dofs,
    const std::vector<HessianStencil>& stencils,
    const Positions<Dim>& displacement,
    BlockMatrix<Dim, Scalar>& matrix,
    BlockVector<Dim>& right);

}  // namespace pent::simulator
