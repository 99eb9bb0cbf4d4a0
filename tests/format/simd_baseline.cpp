#include "simd_checks.h"

namespace pent::test {

const char* simd_fault_baseline() {
    return simd_fault();
}

}  // namespace pent::test
