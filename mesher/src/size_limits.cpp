#include "size_limits.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/surface.h>
#include <pent/number_bounds.h>

#include <string>

namespace pent::mesher {

void require_usual_size(const Positions<3>& points, std::string_view what) {
    const double size = diagonal(points);
    if (!(size >= kSmallestNumber && size <= kLargestNumber)) {
        throw Error(std::string(what)
                    + formatted(" is %.3g m across; expected %g to %g m: scale it first", size,
                                kSmallestNumber, kLargestNumber));
    }
}

}  // namespace pent::mesher
