#pragma once

#include <pent/contact/surface.h>

namespace pent::contact {

/// Corners of one simplex, one a column.
template <int Dim, int Count>
[[nodiscard]] Corners<Dim, Count> gather(const Simplices<Count>& simplices,
                                         Eigen::Index which,
                                         const PositionsView<Dim>& positions) {
    Corners<Dim, Count> corners;
    for (int i = 0; i < Count; ++i) {
        corners.col(i) = positions.col(simplices(i, which));
    }
    return corners;
}

}  // namespace pent::contact
