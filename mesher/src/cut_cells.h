#pragma once

#include "cells.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pent::mesher {

/// Cells of a file cut into tetrahedra.
struct CutCells {
    std::vector<std::array<std::uint32_t, 4>> tets;  ///< In the order of the cells.
    std::vector<std::uint32_t> cells;                ///< Which of the soup's each comes from.
    std::vector<std::int64_t> labels;                ///< One a tetrahedron, or empty.
    std::int64_t turned_cells = 0;  ///< Cells of the file that were negatively oriented.
    std::string cut;  ///< As in "2 hexahedra into 12 tetrahedra"; empty if all were tetrahedra.
};

/// Cuts cells of all kinds into tetrahedra, without added points, so that neighbors agree.
///
/// The vertices are ordered. A cell is pulled at its first vertex: every face that does not have it
/// is cut from its own first vertex, and joined with it. What a face sees depends on the order of
/// its own vertices alone, as with prisms in 4D [shi2025, Sec. 3]; quadrilaterals are cut by the
/// diagonal from their first vertex [dompierre1999]. The order is that of the file, unless a
/// quadrilateral lies against triangles that cut it the other way: then vertices at their diagonals
/// go first, wherever any order serves them all. Cells with corners that coincide by index, as
/// prisms written as hexahedra, are cut as what they are.
///
/// Tetrahedra come out positively oriented.
/// @param name  Goes in front of errors.
/// Throws an Error with their numbers for cells that are not cut (polyhedra, pentagonal and
/// hexagonal prisms), cells of which a tetrahedron would be inverted or flat, and quadrilaterals
/// against triangles that no order serves.
[[nodiscard]] CutCells cut_cells(const CellSoup& soup, const std::string& name);

}  // namespace pent::mesher
