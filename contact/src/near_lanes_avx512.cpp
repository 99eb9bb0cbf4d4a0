#include "near_lanes_isa.h"
#include "near_lanes_kernel.h"

#include <pent/dimensions.h>

namespace pent::contact {

template <int Dim>
const NearLanesKernels<Dim>& near_lanes_avx512() {
    return kNearLanesKernels<Dim>;
}

#define PENT_INSTANTIATE(Dim) template const NearLanesKernels<Dim>& near_lanes_avx512();
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
