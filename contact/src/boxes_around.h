#pragma once

#include "gather.h"
#include "paths.h"

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

/// Fits boxes of some vertices around their paths, less the drift, within their inflation and
/// `margin` (m). Parallel.
///
/// @param boxes  Of each vertex of the scene; others stay what they were.
template <int Dim>
void fit_boxes(const Simplices<1>& vertices,
               const Paths<Dim>& paths,
               double margin,
               std::vector<Box>& boxes) {
    constexpr int kChunk = 4096;
    boxes.resize(static_cast<std::size_t>(paths.to.cols()));
    parallel_for(static_cast<std::size_t>(vertices.cols()), kChunk, [&](std::size_t k) {
        const std::uint32_t v = vertices(0, static_cast<Eigen::Index>(k));
        Eigen::Matrix<double, Dim, 2> path;
        path << paths.from.col(v), paths.to.col(v) - paths.drift;
        boxes[v] = box_around<Dim, 2>(path, margin + paths.inflation_of(v));
    });
}

/// The smallest box around those of some vertices; of none one that overlaps nothing.
[[nodiscard]] inline Box hull_of(const Simplices<1>& vertices, const std::vector<Box>& of_vertex) {
    Box all = kNowhere;
    for (const std::uint32_t vertex : vertices.reshaped()) {
        all = hull(all, of_vertex[vertex]);
    }
    return all;
}

/// The smallest boxes around those of the corners of each simplex. Parallel.
///
/// @param of_vertex  Of each vertex of the scene; read for corners.
template <int Count>
[[nodiscard]] std::vector<Box> hulls(const Simplices<Count>& simplices,
                                     const std::vector<Box>& of_vertex) {
    constexpr int kChunk = 4096;
    std::vector<Box> boxes(static_cast<std::size_t>(simplices.cols()));
    parallel_for(boxes.size(), kChunk, [&](std::size_t i) {
        const auto corners = simplices.col(static_cast<Eigen::Index>(i));
        Box box = of_vertex[corners[0]];
        for (int corner = 1; corner < Count; ++corner) {
            box = hull(box, of_vertex[corners[corner]]);
        }
        boxes[i] = box;
    });
    return boxes;
}

}  // namespace pent::contact
