#include "kernels/kernels.h"

#include "kernels/kernels_isa.h"

#include <pent/processor.h>

namespace pent::simulator {

std::string_view isa_name(Isa isa) {
    switch (isa) {
        case Isa::Scalar:
            return "scalar";
        case Isa::Baseline:
            return "baseline";
        case Isa::Avx2:
            return "avx2";
        case Isa::Avx512:
            return "avx512";
    }
    return "";  // GCOVR_EXCL_LINE: there are no others
}

bool is_supported(Isa isa) {
    switch (isa) {
        case Isa::Scalar:
#ifdef PENT_NO_SCALAR_KERNELS
            return false;
#endif
        case Isa::Baseline:
            return true;
#ifdef PENT_X86_KERNELS
        case Isa::Avx2:
            return has_avx2();
        case Isa::Avx512:
            return has_avx512();
#else
        case Isa::Avx2:
        case Isa::Avx512:
            return false;
#endif
    }
    return false;  // GCOVR_EXCL_LINE: there are no others
}

Isa best_isa() {
    if (is_supported(Isa::Avx512)) {
        return Isa::Avx512;
    }
    return is_supported(Isa::Avx2) ? Isa::Avx2 : Isa::Baseline;  // GCOVR_EXCL_LINE: no AVX-512
}

#ifndef PENT_ONLY_4D
template <>
const Kernels<3>& kernels<3>(Isa isa) {
    switch (isa) {
#ifndef PENT_NO_SCALAR_KERNELS
        case Isa::Scalar:
            return kernels_3_scalar();
#endif
#ifdef PENT_X86_KERNELS
        case Isa::Avx2:
            return kernels_3_avx2();
        case Isa::Avx512:
            return kernels_3_avx512();
#endif
        default:
            return kernels_3_baseline();
    }
}
#endif

template <>
const Kernels<4>& kernels<4>(Isa isa) {
    switch (isa) {
#ifndef PENT_NO_SCALAR_KERNELS
        case Isa::Scalar:
            return kernels_4_scalar();
#endif
#ifdef PENT_X86_KERNELS
        case Isa::Avx2:
            return kernels_4_avx2();
        case Isa::Avx512:
            return kernels_4_avx512();
#endif
        default:
            return kernels_4_baseline();
    }
}

}  // namespace pent::simulator
