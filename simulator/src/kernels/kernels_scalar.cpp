#include "kernels/kernel_table.h"
#include "kernels/kernels_isa.h"

namespace pent::simulator {

const Kernels<3>& kernels_3_scalar() {
    static constexpr Kernels<3> kTable = kernel_table<3, float, double>();
    return kTable;
}

const Kernels<4>& kernels_4_scalar() {
    static constexpr Kernels<4> kTable = kernel_table<4, float, double>();
    return kTable;
}

}  // namespace pent::simulator
