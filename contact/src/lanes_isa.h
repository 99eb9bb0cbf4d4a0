#pragma once

#include "lanes.h"

namespace pent::contact {

/// Each is in a file of its own, compiled for its instruction set; see lanes.cpp for the choice.
template <int Dim>
const LanesKernels<Dim>& lanes_baseline();
template <int Dim>
const LanesKernels<Dim>& lanes_avx2();
template <int Dim>
const LanesKernels<Dim>& lanes_avx512();

}  // namespace pent::contact
