#pragma once

#include <pent/simulator/material.h>

#include <Eigen/Core>

#include <cstddef>

namespace pent::simulator {

/// Cells of one body and one material within the cells of all.
struct CellRange {
    Eigen::Index begin = 0;
    Eigen::Index end = 0;
    Material material;
    std::size_t body = 0;
    std::size_t region = 0;  ///< 0: of no region; else its place in the body plus 1.
};

}  // namespace pent::simulator
