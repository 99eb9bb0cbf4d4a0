#include "size_limits.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/number_bounds.h>

#include <string>

namespace pent::mesher {

template <int Dim>
void require_usual_size(const Positions<Dim>& points, std::string_view what) {
    const double size = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).stableNorm();
    if (!(size >= kSmallestNumber && size <= kLargestNumber)) {
        throw Error(std::string(what)
                    + formatted(" is %.3g m across; expected %g to %g m: scale it first", size,
                                kSmallestNumber, kLargestNumber));
    }
}

template void require_usual_size(const Positions<3>&, std::string_view);
template void require_usual_size(const Positions<4>&, std::string_view);

}  // namespace pent::mesher
