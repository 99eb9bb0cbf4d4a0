#include "ceilings_isa.h"

namespace pent::simulator::bench {

CeilingLoops ceiling_loops_avx512() {
    return {&triad_loop, &chains<float, 64>, &chains<double, 64>};
}

}  // namespace pent::simulator::bench
