#pragma once

#include <pent/simplex_mesh.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace pent::mesher {

/// One side of a triangle: its edge from corner `side` to the next corner.
struct HalfEdge {
    std::uint32_t low = 0;  ///< The lower one of the edge's two points.
    std::uint32_t high = 0;
    std::uint32_t triangle = 0;
    std::uint8_t side = 0;
    bool is_forward = false;  ///< The triangle runs through it from low to high.
};

/// All sides of all triangles, those of one edge together, then by triangle.
[[nodiscard]] std::vector<HalfEdge> sorted_half_edges(const Simplices<3>& triangles);

/// Calls visit(first, last) for the half-edges of each edge in turn.
template <typename Visit>
void for_each_edge(const std::vector<HalfEdge>& half_edges, Visit visit) {
    auto first = half_edges.begin();
    while (first != half_edges.end()) {
        const auto last = std::find_if(first, half_edges.end(), [&](const HalfEdge& other) {
            return other.low != first->low || other.high != first->high;
        });
        visit(first, last);
        first = last;
    }
}

}  // namespace pent::mesher
