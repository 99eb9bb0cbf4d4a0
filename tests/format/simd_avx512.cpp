#include "simd_checks.h"

namespace pent::test {

const char* simd_fault_avx512() {
    return simd_fault();
}

}  // namespace pent::test
