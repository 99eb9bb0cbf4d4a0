#pragma once

#include "linear/coloring.h"
#include "linear/dof_map.h"

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Which blocks of a symmetric block matrix are stored: the upper triangle, row by row.
///
/// The diagonal block comes first in its row, the others by increasing column. Columns behind those
/// that have rows are ghosts: dofs of other ranks.
struct BlockPattern {
    std::vector<std::int64_t> row_start;  ///< rows + 1 entries.
    std::vector<std::uint32_t> columns;
    std::vector<bool> is_cut;  ///< Of each row: whether it lacks blocks of vertices without a dof.
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
/// @param columns  How many columns there are, ghosts among them.
void color_rows(BlockPattern& pattern, std::int64_t columns);

/// The ghosts among the columns of a pattern, and of its coupling if any, increasing.
[[nodiscard]] std::vector<std::uint32_t> ghost_columns(const BlockPattern& pattern,
                                                       const BlockPattern* coupling = nullptr);

/// Corners of elements that need not have equally many: those of element e are
/// corners[start[e]] .. corners[start[e + 1] - 1].
struct CornerLists {
    std::vector<std::int64_t> start = {0};
    std::vector<std::uint32_t> corners;
};

/// A block for each pair of dofs that share a cell, at least one of which has a row.
template <int Dim>
[[nodiscard]] BlockPattern make_pattern(const Simplices<Dim + 1>& cells, const DofMap& dofs);

/// The same for elements given by their corners.
[[nodiscard]] BlockPattern make_pattern(const std::vector<const CornerLists*>& lists,
                                        const DofMap& dofs);

}  // namespace pent::simulator
