#include "ceilings_isa.h"

namespace pent::simulator::bench {

CeilingLoops ceiling_loops_avx2() {
    return {&triad_loop, &chains<float, 32>, &chains<double, 32>};
}

}  // namespace pent::simulator::bench
