#pragma once

#include "linear/coloring.h"
#include "linear/dof_map.h"

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Which blocks of a symmetric block matrix are stored: the upper triangle, row by row.
///
/// The diagonal block comes first in its row, the others by increasing column. There may be more
/// columns than rows: those of other ranks.
struct BlockPattern {
    std::vector<std::int64_t> row_start;  ///< rows + 1 entries.
    std::vector<std::uint32_t> columns;
    std::vector<bool> is_cut;  ///< Rows of vertices that share an element with one without a dof.
    int chunks = 0;            ///< Chunks of kChunkRows rows, for products in parallel.
    Coloring coloring;         ///< Of the chunks, by the rows and columns they touch.

    static constexpr std::int64_t kChunkRows = 512;

    [[nodiscard]] std::int64_t rows() const {
        return static_cast<std::int64_t>(row_start.size()) - 1;
    }
    [[nodiscard]] std::int64_t blocks() const { return row_start.back(); }

    /// Index of block (row, column), row <= column, which must be there.
    [[nodiscard]] std::int64_t find(std::uint32_t row, std::uint32_t column) const;
};

/// Cuts the rows of a pattern into chunks and colors these, for products in parallel.
///
/// @param columns  Above all columns there are.
void color_rows(BlockPattern& pattern, std::int64_t columns);

/// Columns that have no row, increasing: those of other ranks.
[[nodiscard]] std::vector<std::uint32_t> ghost_columns(const BlockPattern& pattern,
                                                       const BlockPattern* coupling = nullptr);

/// Vertices of elements that have different numbers of them: those of element e are
/// corners[start[e]] .. corners[start[e + 1] - 1].
struct CornerLists {
    std::vector<std::int64_t> start = {0};
    std::vector<std::uint32_t> corners;
};

/// Blocks of all pairs of dofs that share a cell, one of them at least with a row.
template <int Dim>
[[nodiscard]] BlockPattern make_pattern(const Simplices<Dim + 1>& cells, const DofMap& dofs);

/// The same for elements of some lists.
[[nodiscard]] BlockPattern make_pattern(const std::vector<const CornerLists*>& lists,
                                        const DofMap& dofs);

}  // namespace pent::simulator
