#pragma once

namespace pent::test {

/// What is wrong with packs as compiled for an instruction set, nullptr if nothing is.
const char* simd_fault_baseline();
const char* simd_fault_avx2();
const char* simd_fault_avx512();

}  // namespace pent::test
