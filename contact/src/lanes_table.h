#pragma once

#include "lanes.h"
#include "motion_lanes_kernel.h"
#include "near_lanes_kernel.h"
#include "spectra_lanes_kernel.h"

// Included once for each instruction set, by a file that is compiled for it.

namespace pent::contact {
namespace {

template <int Dim>
constexpr LanesKernels<Dim> kLanesKernels{
    find_near_lanes<Dim, 1, Dim>, find_near_lanes<Dim, 2, Dim - 1>, find_spectra, bound_motions};

}  // namespace
}  // namespace pent::contact
