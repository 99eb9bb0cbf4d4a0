#include "kernels/kernel_table.h"
#include "kernels/kernels_isa.h"

namespace pent::simulator {

#ifndef PENT_ONLY_4D
const Kernels<3>& kernels_3_baseline() {
    static constexpr Kernels<3> kTable = kernel_table<3, Widest<float>, Widest<double>>();
    return kTable;
}
#endif

const Kernels<4>& kernels_4_baseline() {
    static constexpr Kernels<4> kTable = kernel_table<4, Widest<float>, Widest<double>>();
    return kTable;
}

}  // namespace pent::simulator
