#pragma once

#include "linear/aggregates.h"
#include "linear/block_matrix.h"
#include "linear/rigid_modes.h"

#include <pent/simulator/ranks.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Which blocks of a symmetric matrix over aggregates are stored: its lower triangle, and all
/// blocks in ghost columns, those of aggregates of other ranks, which are numbered behind the rows.
struct AggregatePattern {
    AggregatePattern() = default;
    /// @param linked  Columns of each row, increasing: those of both triangles, the row itself, and
    ///                ghosts.
    /// @param ghosts  How many columns have no row.
    AggregatePattern(const std::vector<std::vector<std::uint32_t>>& linked, std::uint32_t ghosts);

    std::vector<std::int64_t> row_start;  ///< rows + 1 entries.
    std::vector<std::uint32_t> columns;   ///< Of a row, increasing: up to itself, then ghosts.
    std::vector<std::int64_t> diagonal;   ///< Index of the diagonal block of each row.
    /// The upper triangle, which is not stored: in row i the transposes of blocks above[k], in
    /// columns above_columns[k], above_start[i] <= k < above_start[i + 1], by increasing column.
    std::vector<std::int64_t> above_start;     ///< rows + 1 entries.
    std::vector<std::uint32_t> above;          ///< Indices of stored blocks.
    std::vector<std::uint32_t> above_columns;  ///< The rows that these are stored in.
    /// Rows [batches[i], batches[i + 1]) are not linked to one another: sweeps relax them in
    /// parallel.
    std::vector<std::int64_t> batches;

    std::uint32_t ghosts = 0;  ///< How many columns have no row.

    [[nodiscard]] std::int64_t rows() const {
        return static_cast<std::int64_t>(row_start.size()) - 1;
    }
    [[nodiscard]] std::int64_t column_count() const { return rows() + ghosts; }
};

/// Calls visit(column, block, is_transposed) for all blocks of a row: those that are stored, then
/// those above the diagonal, whose transposes are stored.
template <typename Visit>
void for_each_in_row(const AggregatePattern& pattern, std::uint32_t row, const Visit& visit) {
    for (std::int64_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
        visit(pattern.columns[static_cast<std::size_t>(k)], k, false);
    }
    for (std::int64_t i = pattern.above_start[row]; i < pattern.above_start[row + 1]; ++i) {
        const auto at = static_cast<std::size_t>(i);
        visit(pattern.above_columns[at], std::int64_t{pattern.above[at]}, true);
    }
}

/// A block for each pair of aggregates whose children share one, in `children` or in `coupling`,
/// which may be null.
[[nodiscard]] AggregatePattern make_aggregate_pattern(const Aggregates& aggregates,
                                                      const BlockPattern& children,
                                                      const BlockPattern* coupling);
[[nodiscard]] AggregatePattern make_aggregate_pattern(const Aggregates& aggregates,
                                                      const AggregatePattern& children);

/// An aggregate in the form that kernels take.
template <int Dim>
[[nodiscard]] AggregateChildren children_of(std::span<const std::uint32_t> members,
                                            const Arm<Dim>* arms) {
    static_assert(sizeof(Arm<Dim>) == (Dim + 1) * sizeof(double));
    return {members.data(), members.size(), arms->x.data()};
}

/// Reads a block over modes from its stored numbers, see block_order.h.
template <int Size, typename Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, Size, Size> read_modes(const Scalar* stored) {
    return Eigen::Matrix<Scalar, Size, Size>::NullaryExpr([&](Eigen::Index i, Eigen::Index j) {
        return stored[mode_entry<Size>(static_cast<int>(i), static_cast<int>(j))];
    });
}
/// Stores a block in that order.
template <int Size, typename Scalar>
void write_modes(const Eigen::Matrix<Scalar, Size, Size>& block, Scalar* stored) {
    for (int j = 0; j < Size; ++j) {
        for (int i = 0; i < Size; ++i) {
            stored[mode_entry<Size>(i, j)] = block(i, j);
        }
    }
}

/// The kernels for matrices over modes, of one precision.
template <typename Scalar>
[[nodiscard]] const ModeKernels<Scalar>& mode_kernels_of(const BlockKernels& kernels) {
    if constexpr (sizeof(Scalar) == sizeof(float)) {
        return kernels.modes_float;
    } else {
        return kernels.modes_double;
    }
}

/// Symmetric matrix over the rigid modes of aggregates: a coarse matrix. It has the rows of this
/// rank.
template <int Dim, typename Scalar>
struct AggregateMatrix {
    static constexpr int kSize = kModes<Dim>;
    static constexpr std::int64_t kEntries = std::int64_t{kSize} * kSize;
    using Block = Eigen::Matrix<Scalar, kSize, kSize>;
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
    /// Scratch for ModeRows::shares; one serves all levels, as nothing in it outlives a product or
    /// sweep.
    using Shares = std::vector<Scalar, LineAllocator<Scalar>>;

    const AggregatePattern* pattern = nullptr;
    std::vector<Scalar, LineAllocator<Scalar>> values;  ///< Blocks in the order of mode_entry().
    GhostExchange* ghosts = nullptr;  ///< Of vectors over the columns; null without ranks.

    // A copy. NOLINTNEXTLINE(readability-const-return-type): so that nobody assigns to it
    [[nodiscard]] const Block block(std::int64_t index) const {
        return read_modes<kSize>(values.data() + index * kEntries);
    }
    void set_block(std::int64_t index, const Block& block) {
        write_modes<kSize>(block, values.data() + index * kEntries);
    }

    /// All rows in the form that Galerkin products take.
    [[nodiscard]] BlockRows<Scalar> all_rows() const {
        return {values.data(), pattern->row_start.data(), pattern->columns.data(), 0,
                pattern->rows()};
    }
    /// Rows [begin, end) in the form that sweeps and products take.
    [[nodiscard]] ModeRows<Scalar> mode_rows(std::int64_t begin,
                                             std::int64_t end,
                                             Shares& shares) const {
        return {values.data(),
                pattern->row_start.data(),
                pattern->diagonal.data(),
                pattern->columns.data(),
                pattern->above_start.data(),
                pattern->above.data(),
                shares.data(),
                begin,
                end};
    }
    /// Enlarges `shares` to what this matrix needs.
    void fit(Shares& shares) const {
        shares.resize(std::max(shares.size(), kSize * pattern->columns.size()));
    }

    /// Halo exchange: sets the ghosts in a vector over the columns to what their ranks have.
    void update_ghosts(Vector& x) const {
        if (ghosts != nullptr) {
            ghosts->update(x.data(), kSize);
        }
    }

    /// left = r - A x; x over the columns, ghosts up to date, the others over the rows.
    ///
    /// @param shares  After fit().
    void subtract_product(const Workers& workers,
                          const BlockKernels& kernels,
                          const Vector& r,
                          const Vector& x,
                          Vector& left,
                          Shares& shares) const;
    /// Its second half: left -= L^T x, from the shares of x, and the products of ghost columns with
    /// x.
    void subtract_above(const Workers& workers,
                        const BlockKernels& kernels,
                        const Vector& x,
                        Vector& left,
                        Shares& shares) const;
};

/// The Galerkin product P^T A P, P being the rigid modes of the aggregates: sums of T_i^T A_ij T_j
/// over their children, added in the same order for any number of threads. A block between ranks is
/// on both; each adds it up in an order of its own, so that the two are transposes of one another
/// but for rounding.
///
/// @param arms     One a child, ghosts among them.
/// @param pattern  Of the product; must outlive it.
template <int Dim, typename Scalar>
[[nodiscard]] AggregateMatrix<Dim, Scalar> galerkin_product(const Workers& workers,
                                                            const BlockKernels& kernels,
                                                            const BlockMatrix<Dim, Scalar>& A,
                                                            const Aggregates& aggregates,
                                                            const Arms<Dim>& arms,
                                                            const AggregatePattern& pattern);
template <int Dim, typename Scalar>
[[nodiscard]] AggregateMatrix<Dim, Scalar> galerkin_product(const Workers& workers,
                                                            const BlockKernels& kernels,
                                                            const AggregateMatrix<Dim, Scalar>& A,
                                                            const Aggregates& aggregates,
                                                            const Arms<Dim>& arms,
                                                            const AggregatePattern& pattern);

}  // namespace pent::simulator
