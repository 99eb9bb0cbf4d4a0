#pragma once

#include <pent/error.h>

#include <string>
#include <type_traits>

namespace pent {

/// What work(constant) returns, with a dimension that is known only when the program runs, 3 or 4,
/// as a std::integral_constant<int, Dim>: from here on code is that of one dimension.
///
/// Throws an Error for 3 where the build has 4 alone (PENT_ONLY_4D, see dimensions.h).
template <typename Work>
decltype(auto) with_dimension(int dimension, const Work& work) {
#ifdef PENT_ONLY_4D
    if (dimension != 4) {
        throw Error("the dimension is " + std::to_string(dimension) + "; here it must be 4");
    }
#else
    if (dimension == 3) {
        return work(std::integral_constant<int, 3>());
    }
#endif
    return work(std::integral_constant<int, 4>());
}

}  // namespace pent
