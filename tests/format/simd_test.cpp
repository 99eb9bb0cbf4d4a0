#include "simd_faults.h"

#include <pent/simd.h>

#include <gtest/gtest.h>

namespace pent {
namespace {

TEST(Pack, DoesLaneByLaneWhatNumbersDo) {
    EXPECT_STREQ(test::simd_fault_baseline(), nullptr);
}

#ifdef PENT_X86
TEST(Pack, DoesLaneByLaneWhatNumbersDoWithAvx2) {
    if (__builtin_cpu_supports("avx2") == 0 || __builtin_cpu_supports("fma") == 0) {
        GTEST_SKIP() << "this machine has no AVX2";
    }
    EXPECT_STREQ(test::simd_fault_avx2(), nullptr);
}

TEST(Pack, DoesLaneByLaneWhatNumbersDoWithAvx512) {
    if (__builtin_cpu_supports("avx512f") == 0 || __builtin_cpu_supports("fma") == 0) {
        GTEST_SKIP() << "this machine has no AVX-512";
    }
    EXPECT_STREQ(test::simd_fault_avx512(), nullptr);
}
#endif

TEST(Pack, TakesTheRightBytesFromAnAlignedAddress) {
    alignas(16) const float values[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    EXPECT_EQ((Pack<float, 4>::load_aligned(values + 4).lanes[3]), 8);
}

}  // namespace
}  // namespace pent
