#include "half_edges.h"

#include <tuple>

namespace pent::mesher {

std::vector<HalfEdge> sorted_half_edges(const Simplices<3>& triangles) {
    std::vector<HalfEdge> half_edges;
    half_edges.reserve(3 * triangles.cols());
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
        for (std::uint8_t side = 0; side < 3; ++side) {
            const std::uint32_t from = triangles(side, t);
            const std::uint32_t to = triangles((side + 1) % 3, t);
            half_edges.push_back({std::min(from, to), std::max(from, to),
                                  static_cast<std::uint32_t>(t), side, from < to});
        }
    }
    std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.triangle, a.side)
               < std::tie(b.low, b.high, b.triangle, b.side);
    });
    return half_edges;
}

}  // namespace pent::mesher
