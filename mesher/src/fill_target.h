#pragma once

#include <pent/mesher/tetrahedralize.h>

#include <functional>

namespace pent::mesher {

/// Tetrahedra of about a wanted number, and how they were found.
struct TargetFilling {
    Tetrahedra tetrahedra;
    double edge_length = 0;  ///< m.
    int fillings = 0;
};

/// Fills with one edge length after the other until the number of tetrahedra is as wanted to 2%:
/// secants of log(count) over log(length), kept between the nearest lengths on either side.
///
/// @param fill   Fills with an edge length, m; shorter gives more.
/// @param start  Edge length to begin with, m.
/// Throws an Error that gives the nearest number if 20 fillings are not enough.
[[nodiscard]] TargetFilling fill_to_target(const std::function<Tetrahedra(double)>& fill,
                                           double wanted,
                                           double start);

}  // namespace pent::mesher
