#pragma once

#include "linear/aggregates.h"
#include "linear/block_matrix.h"
#include "linear/rigid_modes.h"

#include <pent/simulator/ranks.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Which blocks of a matrix over aggregates are stored: both triangles, so that rows of a product
/// need nothing of one another.
///
/// There may be more columns than rows: those of other ranks, behind.
struct AggregatePattern {
    std::vector<std::int64_t> row_start;  ///< rows + 1 entries.
    std::vector<std::uint32_t> columns;   ///< Increasing within a row, the row itself among them.
    std::vector<std::int64_t> diagonal;   ///< Index of the diagonal block of each row.
    std::vector<std::int64_t> above;      ///< One more: of the first block behind it.
    /// Rows [batches[i], batches[i + 1]) share no block: sweeps take them at the same time.
    std::vector<std::int64_t> batches;

    std::uint32_t ghosts = 0;  ///< How many columns have no row.

    [[nodiscard]] std::int64_t rows() const {
        return static_cast<std::int64_t>(row_start.size()) - 1;
    }
    [[nodiscard]] std::int64_t column_count() const { return rows() + ghosts; }
    /// Index of block (row, column), which must be there.
    [[nodiscard]] std::int64_t find(std::uint32_t row, std::uint32_t column) const;
};

/// Blocks of all pairs of aggregates whose children share a block; with `coupling` or null.
[[nodiscard]] AggregatePattern make_aggregate_pattern(const Aggregates& aggregates,
                                                      const BlockPattern& children,
                                                      const BlockPattern* coupling);
[[nodiscard]] AggregatePattern make_aggregate_pattern(const Aggregates& aggregates,
                                                      const AggregatePattern& children);

/// An aggregate and the arms of all children, as kernels take them.
template <int Dim>
[[nodiscard]] AggregateChildren children_of(const std::vector<std::uint32_t>& members,
                                            const std::vector<Arm<Dim>>& arms) {
    static_assert(offsetof(Arm<Dim>, ratio) == Dim * sizeof(double));
    return {members.data(), members.size(), arms.data()->x.data(),
            sizeof(Arm<Dim>) / sizeof(double)};
}

enum class BlockPart { Whole, BelowDiagonal, AboveDiagonal };

/// Symmetric matrix over the rigid modes of aggregates; rows of this rank.
template <int Dim, typename Scalar>
struct AggregateMatrix {
    static constexpr std::int64_t kEntries = std::int64_t{kModes<Dim>} * kModes<Dim>;
    using Block = Eigen::Matrix<Scalar, kModes<Dim>, kModes<Dim>>;
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

    const AggregatePattern* pattern = nullptr;
    std::vector<Scalar, LineAllocator<Scalar>> values;
    GhostExchange* ghosts = nullptr;  ///< Of the columns; null where nothing is shared.

    [[nodiscard]] Eigen::Map<Block> block(std::int64_t index) {
        return Eigen::Map<Block>(values.data() + index * kEntries);
    }
    [[nodiscard]] Eigen::Map<const Block> block(std::int64_t index) const {
        return Eigen::Map<const Block>(values.data() + index * kEntries);
    }

    /// All rows as kernels take them.
    [[nodiscard]] BlockRows<Scalar> all_rows() const {
        return {values.data(), pattern->row_start.data(), pattern->columns.data(), 0,
                pattern->rows()};
    }

    /// Gives the entries of other ranks in a vector over the columns what they are there.
    void update_ghosts(Vector& x) const {
        if (ghosts != nullptr) {
            ghosts->update(x.data(), kModes<Dim>);
        }
    }

    /// y = A x, or the product with a part of A; x over the columns, y over the rows.
    void multiply(const Workers& workers,
                  const BlockKernels& kernels,
                  BlockPart part,
                  const Vector& x,
                  Vector& y) const;

    /// The same for rows [rows.begin, rows.end).
    struct RowRange {
        std::int64_t begin = 0;
        std::int64_t end = 0;
    };
    void multiply_rows(const BlockKernels& kernels,
                       BlockPart part,
                       RowRange rows,
                       const Scalar* x,
                       Scalar* y) const;
};

/// The Galerkin product P^T A P, P being the rigid modes of the aggregates: a sum of T_i^T A_ij T_j
/// over their children, in one order for any number of threads. Symmetric to the bit, but for
/// blocks between ranks, which each of both adds up in an order of its own.
///
/// @param arms     One a child, of other ranks, too.
/// @param pattern  Of the product; must outlive it.
template <int Dim, typename Scalar>
[[nodiscard]] AggregateMatrix<Dim, Scalar> galerkin_product(const Workers& workers,
                                                            const BlockKernels& kernels,
                                                            const BlockMatrix<Dim, Scalar>& A,
                                                            const Aggregates& aggregates,
                                                            const std::vector<Arm<Dim>>& arms,
                                                            const AggregatePattern& pattern);
template <int Dim, typename Scalar>
[[nodiscard]] AggregateMatrix<Dim, Scalar> galerkin_product(const Workers& workers,
                                                            const BlockKernels& kernels,
                                                            const AggregateMatrix<Dim, Scalar>& A,
                                                            const Aggregates& aggregates,
                                                            const std::vector<Arm<Dim>>& arms,
                                                            const AggregatePattern& pattern);

}  // namespace pent::simulator
