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

/// Which blocks of a symmetric matrix over aggregates are stored: its lower triangle.
///
/// There may be more columns than rows: those of other ranks, behind, whose blocks are stored, too.
struct AggregatePattern {
    AggregatePattern() = default;
    /// @param linked  Columns of each row, increasing, from both triangles; the row itself, too.
    /// @param ghosts  How many columns have no row.
    AggregatePattern(const std::vector<std::vector<std::uint32_t>>& linked, std::uint32_t ghosts);

    std::vector<std::int64_t> row_start;  ///< rows + 1 entries.
    std::vector<std::uint32_t> columns;   ///< Of a row, increasing: up to itself, then of others.
    std::vector<std::int64_t> diagonal;   ///< Index of the diagonal block of each row.
    /// Blocks below the diagonal by columns: of column i those from above_start[i] on, of which
    /// there are rows + 1, by their rows. Transposed they are what row i has above the diagonal.
    std::vector<std::int64_t> above_start;
    std::vector<std::uint32_t> above;          ///< Their indices.
    std::vector<std::uint32_t> above_columns;  ///< Their rows: columns of their transposes.
    /// Rows [batches[i], batches[i + 1]) share no block: sweeps take them at the same time.
    std::vector<std::int64_t> batches;

    std::uint32_t ghosts = 0;  ///< How many columns have no row.

    [[nodiscard]] std::int64_t rows() const {
        return static_cast<std::int64_t>(row_start.size()) - 1;
    }
    [[nodiscard]] std::int64_t column_count() const { return rows() + ghosts; }
};

/// Calls visit(column, block, is_transposed) for all blocks of a row: those that are stored, then
/// those above the diagonal, of which the transposes are.
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

/// Blocks of all pairs of aggregates whose children share a block; with `coupling` or null.
[[nodiscard]] AggregatePattern make_aggregate_pattern(const Aggregates& aggregates,
                                                      const BlockPattern& children,
                                                      const BlockPattern* coupling);
[[nodiscard]] AggregatePattern make_aggregate_pattern(const Aggregates& aggregates,
                                                      const AggregatePattern& children);

/// An aggregate as kernels take it.
template <int Dim>
[[nodiscard]] AggregateChildren children_of(std::span<const std::uint32_t> members,
                                            const Arm<Dim>* arms) {
    static_assert(sizeof(Arm<Dim>) == (Dim + 1) * sizeof(double));
    return {members.data(), members.size(), arms->x.data()};
}

/// A block of modes from the numbers that it is stored in.
template <int Size, typename Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, Size, Size> read_modes(const Scalar* stored) {
    return Eigen::Matrix<Scalar, Size, Size>::NullaryExpr([&](Eigen::Index i, Eigen::Index j) {
        return stored[mode_entry<Size>(static_cast<int>(i), static_cast<int>(j))];
    });
}
template <int Size, typename Scalar>
void write_modes(const Eigen::Matrix<Scalar, Size, Size>& block, Scalar* stored) {
    for (int j = 0; j < Size; ++j) {
        for (int i = 0; i < Size; ++i) {
            stored[mode_entry<Size>(i, j)] = block(i, j);
        }
    }
}

/// The kernels for matrices of modes of one precision.
template <typename Scalar>
[[nodiscard]] const ModeKernels<Scalar>& mode_kernels_of(const BlockKernels& kernels) {
    if constexpr (sizeof(Scalar) == sizeof(float)) {
        return kernels.modes_float;
    } else {
        return kernels.modes_double;
    }
}

/// Symmetric matrix over the rigid modes of aggregates; rows of this rank.
template <int Dim, typename Scalar>
struct AggregateMatrix {
    static constexpr int kSize = kModes<Dim>;
    static constexpr std::int64_t kEntries = std::int64_t{kSize} * kSize;
    using Block = Eigen::Matrix<Scalar, kSize, kSize>;
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
    /// Room for ModeRows::shares of one product at a time.
    using Shares = std::vector<Scalar, LineAllocator<Scalar>>;

    const AggregatePattern* pattern = nullptr;
    std::vector<Scalar, LineAllocator<Scalar>> values;  ///< Blocks by mode_entry().
    GhostExchange* ghosts = nullptr;  ///< Of the columns; null where nothing is shared.

    // A copy. NOLINTNEXTLINE(readability-const-return-type): so that nobody assigns to it
    [[nodiscard]] const Block block(std::int64_t index) const {
        return read_modes<kSize>(values.data() + index * kEntries);
    }
    void set_block(std::int64_t index, const Block& block) {
        write_modes<kSize>(block, values.data() + index * kEntries);
    }

    /// All rows as kernels for blocks of children take them.
    [[nodiscard]] BlockRows<Scalar> all_rows() const {
        return {values.data(), pattern->row_start.data(), pattern->columns.data(), 0,
                pattern->rows()};
    }
    /// Rows [begin, end) as sweeps and products take them.
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
    /// Makes room for the shares of this matrix, if there is less.
    void fit(Shares& shares) const {
        shares.resize(std::max(shares.size(), kSize * pattern->columns.size()));
    }

    /// Gives the entries of other ranks in a vector over the columns what they are there.
    void update_ghosts(Vector& x) const {
        if (ghosts != nullptr) {
            ghosts->update(x.data(), kSize);
        }
    }

    /// left = r - A x; x over the columns, the others over the rows.
    ///
    /// @param shares  That fit.
    void subtract_product(const Workers& workers,
                          const BlockKernels& kernels,
                          const Vector& r,
                          const Vector& x,
                          Vector& left,
                          Shares& shares) const;
    /// The last part of it: left -= L^T x, by shares of x, and what other ranks have of A x.
    void subtract_above(const Workers& workers,
                        const BlockKernels& kernels,
                        const Vector& x,
                        Vector& left,
                        Shares& shares) const;
};

/// The Galerkin product P^T A P, P being the rigid modes of the aggregates: a sum of T_i^T A_ij T_j
/// over their children, in one order for any number of threads. Blocks between ranks are the
/// transposes of one another but for rounding: each of both adds them up in an order of its own.
///
/// @param arms     One a child, of other ranks, too.
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
