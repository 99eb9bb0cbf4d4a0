#include "kernel_table.h"
#include "kernels_isa.h"

namespace pent::simulator {

const Kernels<3>& kernels_3_avx2() {
    static constexpr Kernels<3> kTable = kernel_table<3, std::experimental::native_simd<float>,
                                                      std::experimental::native_simd<double>>();
    return kTable;
}

const Kernels<4>& kernels_4_avx2() {
    static constexpr Kernels<4> kTable = kernel_table<4, std::experimental::native_simd<float>,
                                                      std::experimental::native_simd<double>>();
    return kTable;
}

}  // namespace pent::simulator
