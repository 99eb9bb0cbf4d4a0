#pragma once

#include "motion_lanes.h"
#include "near_lanes.h"
#include "spectra_lanes.h"

#include <cstdint>

// Kernels of loops over several things side by side (SIMD), compiled for several instruction sets:
// nothing in them is shared with other files but plain data.

namespace pent::contact {

template <int Dim>
struct LanesKernels {
    FindNearLanes near_points = nullptr;  ///< First patches of vertices, second ones of facets.
    FindNearLanes near_mixed = nullptr;   ///< Of edges and of ridges.
    FindSpectra find_spectra = nullptr;
    BoundMotions bound_motions = nullptr;

    /// The kernel for first patches of simplices with K corners.
    template <int K>
    [[nodiscard]] FindNearLanes find_near() const {
        return K == 1 ? near_points : near_mixed;
    }
};

/// Instruction sets that there are kernels for, and this machine runs.
enum class LanesIsa : std::uint8_t { Baseline, Avx2, Avx512 };
[[nodiscard]] bool is_supported(LanesIsa isa);

template <int Dim>
[[nodiscard]] const LanesKernels<Dim>& lanes_kernels(LanesIsa isa);

/// The kernels of the widest instruction set that is supported.
template <int Dim>
[[nodiscard]] const LanesKernels<Dim>& lanes_kernels();

}  // namespace pent::contact
