#pragma once

namespace pent {

/// Whether this machine runs what is compiled for AVX2 with fused multiply-add. Never where x86-64
/// is not what is compiled for.
[[nodiscard]] bool has_avx2();

/// The same for the parts F, DQ, BW and VL of AVX-512.
[[nodiscard]] bool has_avx512();

}  // namespace pent
