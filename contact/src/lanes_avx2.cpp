#include "lanes_isa.h"
#include "lanes_table.h"

#include <pent/dimensions.h>

namespace pent::contact {

template <int Dim>
const LanesKernels<Dim>& lanes_avx2() {
    return kLanesKernels<Dim>;
}

#define PENT_INSTANTIATE(Dim) template const LanesKernels<Dim>& lanes_avx2();
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
