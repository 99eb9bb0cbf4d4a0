#pragma once

#include <pent/simulator/material.h>

#include <Eigen/Core>

namespace pent::simulator {

/// The cells of one body within the cells of all.
struct CellRange {
    Eigen::Index begin = 0;
    Eigen::Index end = 0;
    Material material;
};

}  // namespace pent::simulator
