#include "ceilings_isa.h"

namespace pent::simulator::bench {

CeilingLoops ceiling_loops_baseline() {
    return {&triad_loop, &chains<float, 16>, &chains<double, 16>};
}

}  // namespace pent::simulator::bench
