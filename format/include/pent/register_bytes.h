#pragma once

namespace pent {

/// Bytes of the widest SIMD register of the instruction set for which the file that includes this
/// is compiled. For kernels, which are compiled for several instruction sets: each has its own, of
/// internal linkage, so that the linker never takes one for another.
#if defined(__AVX512F__)
constexpr int kRegisterBytes = 64;
#elif defined(__AVX__)
constexpr int kRegisterBytes = 32;
#else
constexpr int kRegisterBytes = 16;
#endif

}  // namespace pent
