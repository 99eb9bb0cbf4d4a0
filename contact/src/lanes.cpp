#include "lanes.h"

#include "lanes_isa.h"

#include <pent/dimensions.h>
#include <pent/processor.h>

namespace pent::contact {

bool is_supported(LanesIsa isa) {
#ifdef PENT_X86_LANES
    return isa == LanesIsa::Baseline || (isa == LanesIsa::Avx2 ? has_avx2() : has_avx512());
#else
    return isa == LanesIsa::Baseline;
#endif
}

template <int Dim>
const LanesKernels<Dim>& lanes_kernels(LanesIsa isa) {
    switch (isa) {
#ifdef PENT_X86_LANES
        case LanesIsa::Avx2:
            return lanes_avx2<Dim>();
        case LanesIsa::Avx512:
            return lanes_avx512<Dim>();
#endif
        default:
            return lanes_baseline<Dim>();
    }
}

template <int Dim>
const LanesKernels<Dim>& lanes_kernels() {
    static const LanesKernels<Dim>& widest =
        lanes_kernels<Dim>(is_supported(LanesIsa::Avx512) ? LanesIsa::Avx512
                           : is_supported(LanesIsa::Avx2) ? LanesIsa::Avx2
                                                          : LanesIsa::Baseline);
    return widest;
}

#define PENT_INSTANTIATE(Dim)                                  \
    template const LanesKernels<Dim>& lanes_kernels(LanesIsa); \
    template const LanesKernels<Dim>& lanes_kernels();
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
