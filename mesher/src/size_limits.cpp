#include "size_limits.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/surface.h>

#include <string>

namespace pent::mesher {

void require_usual_size(const Positions<3>& points, std::string_view what) {
    constexpr double kSmallest = 1e-30;
    constexpr double kLargest = 1e30;
    const double size = diagonal(points);
    if (!(size >= kSmallest && size <= kLargest)) {
        throw Error(std::string(what)
                    + formatted(" is %.3g m across; expected %g to %g m: scale it first", size,
                                kSmallest, kLargest));
    }
}

}  // namespace pent::mesher
