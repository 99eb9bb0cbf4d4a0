#pragma once

#include <cstdint>

namespace pent::simulator {

/// In the vertices of a stencil: a point that does not move and has no row.
inline constexpr std::uint32_t kNoVertex = 0xffffffff;

/// The Hessian of an energy of a few vertices, as a view of numbers that must outlive
/// NewtonSystem::finish(). Block (i, j) is
///
///     scale weights[i] weights[j] K
///
/// where there are weights, the numbers being K, Dim x Dim;
///
///     scale sum over k < rank of d_k f_ik f_jk^T
///
/// where there is a rank, the numbers being d_0, d_1, ... and then for each i f_i0, f_i1, ..., Dim
/// of each; else scale times block (i, j) of the numbers, a whole matrix.
struct HessianStencil {
    const std::uint32_t* vertices = nullptr;  ///< `count` of them, each once.
    const double* weights = nullptr;          ///< `count`, or null.
    const double* numbers = nullptr;          ///< Matrices are column-major and symmetric.
    std::int32_t count = 0;
    std::int32_t rank = 0;    ///< At most Dim^2.
    std::int32_t stride = 0;  ///< Numbers from one column of a matrix to the next.
    double scale = 1;
    bool is_checked = false;  ///< Whether NewtonSystem::weigh_masses() compares masses with it; it
                              ///< has weights then, and no kNoVertex.
};

}  // namespace pent::simulator
