#pragma once

#include "kernels/kernels.h"

namespace pent::simulator {

/// The tables of kernels: one file for each instruction set, compiled for it; kernels.cpp chooses.
const Kernels<3>& kernels_3_scalar();
const Kernels<4>& kernels_4_scalar();
const Kernels<3>& kernels_3_baseline();
const Kernels<4>& kernels_4_baseline();
const Kernels<3>& kernels_3_avx2();
const Kernels<4>& kernels_4_avx2();
const Kernels<3>& kernels_3_avx512();
const Kernels<4>& kernels_4_avx512();

}  // namespace pent::simulator
