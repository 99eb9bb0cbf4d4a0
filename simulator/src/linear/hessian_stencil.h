#pragma once

#include <cstdint>

namespace pent::simulator {

/// Stands in the vertices of a stencil for a point that does not move, which has no row.
inline constexpr std::uint32_t kNoVertex = 0xffffffff;

/// The second derivatives of one energy by a few vertices: a view of numbers that must last until
/// the system is assembled. Block (i, j) is
///
///     scale weights[i] weights[j] K,     K = the first Dim x Dim numbers at `matrix`,
///
/// where there are weights, else scale times block (i, j) of the whole matrix.
struct HessianStencil {
    const std::uint32_t* vertices = nullptr;  ///< `count` of them, each once.
    const double* weights = nullptr;          ///< `count`, or null.
    const double* matrix = nullptr;           ///< Column-major, symmetric.
    std::int32_t count = 0;
    std::int32_t stride = 0;  ///< Numbers from one column of `matrix` to the next.
    double scale = 1;
    bool is_checked = false;  ///< Whether masses must not be lost next to it, see
                              ///< NewtonSystem::weigh_masses().
};

}  // namespace pent::simulator
