#pragma once

#include "near_lanes.h"

namespace pent::contact {

/// One file each, compiled for its instruction set; see near_lanes.cpp for the choice.
template <int Dim>
const NearLanesKernels<Dim>& near_lanes_baseline();
template <int Dim>
const NearLanesKernels<Dim>& near_lanes_avx2();
template <int Dim>
const NearLanesKernels<Dim>& near_lanes_avx512();

}  // namespace pent::contact
