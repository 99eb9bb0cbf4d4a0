#pragma once

#include "model/bodies.h"

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Some things of a body, those of one material after those of another.
struct SortedByMaterial {
    std::vector<Eigen::Index> order;  ///< Else as they were.
    std::vector<Eigen::Index> first;  ///< Materials + 1 entries.
};

/// @param materials  One a thing, below `count`.
[[nodiscard]] SortedByMaterial sort_by_material(const std::vector<std::uint16_t>& materials,
                                                std::size_t count);

/// Appends a range for each material of a body.
///
/// @param place  Of the body in the scene.
/// @param first  Of SortedByMaterial.
/// @param begin  So many things of others are in front.
void append_ranges(const Body& body,
                   std::size_t place,
                   const std::vector<Eigen::Index>& first,
                   Eigen::Index begin,
                   std::vector<CellRange>& ranges);

/// Places the meshes of `bodies` and puts their vertices, cells and quadratic cells one after the
/// other, those of a body by their materials.
template <int Dim>
void append_bodies(const Scene& scene, Bodies<Dim>& bodies);

}  // namespace pent::simulator
