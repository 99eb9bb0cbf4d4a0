#pragma once

#include "linear/block_kernels.h"

#include <pent/simulator/material.h>
#include <pent/simulator/solver_options.h>

#include <cstdint>
#include <string_view>

namespace pent::simulator {

/// The inner loops, compiled once for each instruction set and chosen at run time.
///
/// This header, and what the kernels are made of, use plain pointers and no inline function of a
/// library: a function the linker shares between files must not hold instructions a machine lacks.

/// Elements are stored in groups of this many, one element a lane, whatever the vector width.
inline constexpr int kGroup = 16;

/// Blocks of the upper triangle of an element matrix: pairs a <= b of its corners. As any function
/// outside of unnamed namespaces, kernels may use it at compile time only, see above.
constexpr int pairs_of(int corners) {
    return corners * (corners + 1) / 2;
}

/// The same for a simplex.
template <int Dim>
inline constexpr int kPairs = pairs_of(Dim + 1);

/// In ElementRun::blocks: no block, as one of the corners is held.
inline constexpr std::int32_t kNoBlock = -1;

/// Where the matrix stores the transpose of a block instead: kTurnedBlock - index.
inline constexpr std::int32_t kTurnedBlock = -2;

/// A run of element groups of one kind, one material and one number of corners. Arrays are
/// [group][row][lane].
///
/// An element that is not quadratic has the deformation gradient F = sum over corners a of
/// x_a g_a^T, with rest gradients g_a that add up to zero: a simplex has Dim + 1 corners, a
/// smoothing domain may have more. They are in increasing order of their dof, held ones last; an
/// element with fewer than the others repeats its first, with zeros for gradients.
///
/// A quadratic simplex has kQuadraticNodes corners, its nodes in their own order; QuadraticRule
/// says how it deforms. Lanes behind the last element of a run repeat a real element with volume 0,
/// so that their numbers are finite, and are not scattered.
struct ElementRun {
    ElementKind kind = ElementKind::Linear;
    Material material;         ///< Of quadratic elements with the lambda that acts at every point.
    double mean_lambda = 0;    ///< Pa, >= 0: the part of lambda that acts on mean dilatation.
    double collapse_norm = 0;  ///< An element with |F|^2 below this has collapsed; 0: none can.
    int elements = 0;          ///< Elements in the run; groups = ceil(elements / kGroup).
    int corners = 0;           ///< Of every element, at least Dim + 1.
    const double* rest =
        nullptr;  ///< (corners - 1) * Dim + 1 rows: the gradients of all corners but
                  ///< the first, of a simplex the inverse of Dm; rest volume. Of a quadratic
                  ///< simplex for each of its points: the inverse of Dm of the linear simplex it
                  ///< deforms as, share of the volume; then the volume.
    const std::uint32_t* vertices = nullptr;  ///< `corners` rows.
    const std::uint32_t* dofs = nullptr;      ///< One a vertex; >= dof_count where it is held.
    const std::int32_t* blocks =
        nullptr;  ///< pairs_of(corners) rows: index of the matrix block, kNoBlock, or
                  ///< kTurnedBlock - index.
    std::uint32_t dof_count = 0;
};

struct RunEnergy {
    double energy = 0;           ///< J, of all elements of the run.
    std::int64_t inverted = 0;   ///< Elements with J <= 0.
    std::int64_t collapsed = 0;  ///< Elements with |F|^2 < ElementRun::collapse_norm.
};

/// Where Hessian blocks go.
template <typename Scalar>
struct HessianTarget {
    Scalar* values = nullptr;  ///< Dim x Dim blocks in the order of block_order.h; added to.
    double scale = 1;          ///< Factor on every block.
    Filter filter = Filter::Clamp;
    /// Dim x vertices: how far held vertices move, m.
    const double* prescribed_displacement = nullptr;
    /// Dim x dofs: block * prescribed_displacement is subtracted for held columns.
    double* right = nullptr;
};

/// The kernels of one instruction set.
template <int Dim>
struct Kernels {
    /// Adds dPsi/dx of every element to `gradient` (Dim x vertices) and returns the energy.
    RunEnergy (*gradient)(const ElementRun& run, const double* positions, double* gradient);

    /// Adds the filtered Hessian of every element; returns how many of them the filter changed.
    std::int64_t (*hessian_float)(const ElementRun& run,
                                  const double* positions,
                                  const HessianTarget<float>& target);
    std::int64_t (*hessian_double)(const ElementRun& run,
                                   const double* positions,
                                   const HessianTarget<double>& target);

    BlockKernels blocks;
};

/// Instruction sets that there are kernels for. Scalar is without vectors: the others are tested
/// against it.
enum class Isa { Scalar, Baseline, Avx2, Avx512 };

[[nodiscard]] std::string_view isa_name(Isa isa);

/// Whether this build has kernels for it and this machine can run them.
[[nodiscard]] bool is_supported(Isa isa);

/// The widest supported one.
[[nodiscard]] Isa best_isa();

/// Kernels for a supported instruction set.
template <int Dim>
[[nodiscard]] const Kernels<Dim>& kernels(Isa isa);

}  // namespace pent::simulator
