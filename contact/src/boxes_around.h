#pragma once

#include "gather.h"

#include <pent/contact/box_tree.h>
#include <pent/parallel.h>

#include <vector>

namespace pent::contact {

/// Boxes around simplices at given positions, within `margin` (m). Parallel.
template <int Dim, int Count>
[[nodiscard]] std::vector<Box> boxes_around(const Simplices<Count>& simplices,
                                            const PositionsView<Dim>& positions,
                                            double margin) {
    constexpr int kChunk = 1024;
    std::vector<Box> boxes(static_cast<std::size_t>(simplices.cols()));
    parallel_for(boxes.size(), kChunk, [&](std::size_t i) {
        boxes[i] = box_around<Dim, Count>(
            gather<Dim, Count>(simplices, static_cast<Eigen::Index>(i), positions), margin);
    });
    return boxes;
}

}  // namespace pent::contact
