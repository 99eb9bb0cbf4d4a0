#pragma once

#include "linear/block_kernels.h"
#include "linear/block_order.h"
#include "linear/block_pattern.h"
#include "linear/line_allocator.h"

#include <pent/parallel.h>

#include <Eigen/Core>

#include <algorithm>
#include <utility>
#include <vector>

namespace pent::simulator {

/// Reads a block from its Dim^2 stored numbers, see block_order.h.
template <int Dim, typename Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, Dim, Dim> read_block(const Scalar* stored) {
    Eigen::Matrix<Scalar, Dim, Dim> block;
    for (int j = 0; j < Dim; ++j) {
        for (int i = 0; i < Dim; ++i) {
            block(i, j) = stored[block_entry<Dim>(i, j)];
        }
    }
    return block;
}
/// Stores a block in that order.
template <int Dim, typename Scalar>
void write_block(const Eigen::Matrix<Scalar, Dim, Dim>& block, Scalar* stored) {
    for (int j = 0; j < Dim; ++j) {
        for (int i = 0; i < Dim; ++i) {
            stored[block_entry<Dim>(i, j)] = block(i, j);
        }
    }
}

/// A vector over the dofs: Dim x dofs, a column for each dof.
template <int Dim>
using BlockVector = Positions<Dim>;

/// Symmetric matrix of Dim x Dim blocks on a fixed pattern, upper triangle stored.
///
/// Products also include an optional second part on a pattern of its own over the same dofs (what
/// contact couples and elasticity does not), and the corrections found by compensate().
template <int Dim, typename Scalar>
class BlockMatrix {
    using DoubleBlock = Eigen::Matrix<double, Dim, Dim>;

public:
    using Block = Eigen::Matrix<Scalar, Dim, Dim>;
    static constexpr std::int64_t kEntries = std::int64_t{Dim} * Dim;

    explicit BlockMatrix(const BlockPattern& pattern)
        : pattern_(&pattern), values_(static_cast<std::size_t>(pattern.blocks() * kEntries), 0) {}

    [[nodiscard]] const BlockPattern& pattern() const { return *pattern_; }
    [[nodiscard]] Scalar* values() { return values_.data(); }
    [[nodiscard]] const Scalar* values() const { return values_.data(); }
    [[nodiscard]] std::int64_t rows() const { return pattern_->rows(); }
    /// All rows in the form that kernels take, without the second part.
    [[nodiscard]] BlockRows<Scalar> all_rows() const {
        return {values_.data(), pattern_->row_start.data(), pattern_->columns.data(), 0, rows()};
    }

    // Copies. NOLINTBEGIN(readability-const-return-type): so that nobody assigns to one
    [[nodiscard]] const Block block(std::int64_t index) const {
        return read_block<Dim>(values_.data() + index * kEntries);
    }
    [[nodiscard]] const Block diagonal(std::int64_t row) const { return block(diagonal_of(row)); }
    // NOLINTEND(readability-const-return-type)
    /// A block of a row as products use it: corrected by what compensate() has found.
    [[nodiscard]] DoubleBlock compensated_block(std::int64_t row, std::int64_t index) const {
        DoubleBlock block = this->block(index).template cast<double>();
        if (!compensation_.empty() && index == diagonal_of(row)) {
            block += compensation_[static_cast<std::size_t>(row)];
        }
        return block;
    }
    /// Index of the diagonal block of a row.
    [[nodiscard]] std::int64_t diagonal_of(std::int64_t row) const {
        return pattern_->row_start[static_cast<std::size_t>(row)];
    }
    void set_block(std::int64_t index, const Block& block) {
        write_block<Dim>(block, values_.data() + index * kEntries);
    }
    void add_to_block(std::int64_t index, const Block& block) {
        set_block(index, this->block(index) + block);
    }
    /// Adds `number` times the identity to the diagonal block of a row.
    void add_to_diagonal(std::int64_t row, Scalar number) {
        Scalar* values = values_.data() + diagonal_of(row) * kEntries;
        for (int i = 0; i < Dim; ++i) {
            values[block_entry<Dim>(i, i)] += number;
        }
    }

    /// The second part, or null.
    [[nodiscard]] const BlockMatrix* coupling() const { return coupling_; }
    /// @param coupling  Must outlive its use here; null for none.
    void set_coupling(const BlockMatrix* coupling) { coupling_ = coupling; }

    void set_zero(const Workers& workers) {
        compensation_.clear();
        for_each_row_chunk(workers, [&](std::int64_t begin, std::int64_t end) {
            const auto& start = pattern_->row_start;
            std::fill(values_.begin() + start[static_cast<std::size_t>(begin)] * kEntries,
                      values_.begin() + start[static_cast<std::size_t>(end)] * kEntries, Scalar(0));
        });
    }

    /// A += factor other, on the same pattern.
    template <typename Other>
    void add_scaled(const Workers& workers, double factor, const BlockMatrix<Dim, Other>& other) {
        for_each_row_chunk(workers, [&](std::int64_t begin, std::int64_t end) {
            const auto& start = pattern_->row_start;
            const std::int64_t last = start[static_cast<std::size_t>(end)] * kEntries;
            for (std::int64_t k = start[static_cast<std::size_t>(begin)] * kEntries; k < last;
                 ++k) {
                values_[static_cast<std::size_t>(k)] +=
                    static_cast<Scalar>(factor * static_cast<double>(other.values()[k]));
            }
        });
    }

    /// Makes up for rounding by diagonal compensation [axelsson1994]. A stiffness matrix maps
    /// translations to zero, so the blocks of a row have to add up to its mass times the identity.
    /// What rounding has taken of that is kept beside the diagonal block in double, where it is not
    /// rounded again. Cut rows stay as they are: the matrix has not all blocks of their sums.
    ///
    /// @param masses  One a row: the mass that has been added to its diagonal.
    void compensate(const Workers& workers, const Eigen::VectorXd& masses) {
        std::vector<DoubleBlock> sums(static_cast<std::size_t>(rows()), DoubleBlock::Zero());
        for_each_colored_chunk(
            workers, [&](std::int64_t begin, std::int64_t end) { add_row_sums(begin, end, sums); });
        for_each_row_chunk(workers, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t row = begin; row < end; ++row) {
                DoubleBlock& sum = sums[static_cast<std::size_t>(row)];
                const DoubleBlock found = sum;
                sum = -0.5 * (found + found.transpose());
                sum.diagonal().array() += masses[row];
                if (pattern_->is_cut[static_cast<std::size_t>(row)]) {
                    sum.setZero();
                }
            }
        });
        compensation_ = std::move(sums);
    }

    /// result = A x.
    void multiply(const Workers& workers,
                  const BlockKernels& kernels,
                  const BlockVector<Dim>& x,
                  BlockVector<Dim>& result) const {
        for_each_row_chunk(workers, [&](std::int64_t begin, std::int64_t end) {
            result.middleCols(begin, end - begin).setZero();
        });
        add_product(workers, kernels, x, result);
        if (coupling_ != nullptr) {
            coupling_->add_product(workers, kernels, x, result);
        }
    }

    /// Sum of work(begin, end) over chunks of rows, which are added in their order.
    template <typename Work>
    [[nodiscard]] auto sum_row_chunks(const Workers& workers, const Work& work) const {
        return workers.sum(pattern_->chunks, [&](int chunk) {
            const std::int64_t begin = chunk * BlockPattern::kChunkRows;
            return work(begin, std::min(begin + BlockPattern::kChunkRows, rows()));
        });
    }

    /// Calls work(begin, end) for chunks of rows, in parallel.
    template <typename Work>
    void for_each_row_chunk(const Workers& workers, const Work& work) const {
        workers.for_each(pattern_->chunks, [&](int chunk) {
            const std::int64_t begin = chunk * BlockPattern::kChunkRows;
            work(begin, std::min(begin + BlockPattern::kChunkRows, rows()));
        });
    }

private:
    // Calls work(begin, end) for chunks of rows, in parallel for those that touch no common dof.
    template <typename Work>
    void for_each_colored_chunk(const Workers& workers, const Work& work) const {
        for (const std::vector<int>& chunks : pattern_->coloring.colors) {
            workers.for_each(static_cast<int>(chunks.size()), [&](int i) {
                const std::int64_t begin =
                    chunks[static_cast<std::size_t>(i)] * BlockPattern::kChunkRows;
                work(begin, std::min(begin + BlockPattern::kChunkRows, rows()));
            });
        }
    }

    // result += A x, without the second part.
    void add_product(const Workers& workers,
                     const BlockKernels& kernels,
                     const BlockVector<Dim>& x,
                     BlockVector<Dim>& result) const {
        for_each_colored_chunk(workers, [&](std::int64_t begin, std::int64_t end) {
            BlockRows<Scalar> rows = all_rows();
            rows.begin = begin;
            rows.end = end;
            if constexpr (sizeof(Scalar) == sizeof(float)) {
                kernels.multiply_float(rows, x.data(), result.data());
            } else {
                kernels.multiply_double(rows, x.data(), result.data());
            }
            if (!compensation_.empty()) {
                for (std::int64_t row = begin; row < end; ++row) {
                    result.col(row) += compensation_[static_cast<std::size_t>(row)] * x.col(row);
                }
            }
        });
    }

    // Adds up the blocks of each row: those of the stored upper triangle, and those of the lower
    // one whose columns have rows here. The latter are not transposed: only the symmetric part of a
    // sum is used, which a block and its transpose have in common.
    void add_row_sums(std::int64_t begin, std::int64_t end, std::vector<DoubleBlock>& sums) const {
        const auto& start = pattern_->row_start;
        for (std::int64_t row = begin; row < end; ++row) {
            const std::int64_t diagonal = start[static_cast<std::size_t>(row)];
            DoubleBlock sum = block(diagonal).template cast<double>();
            for (std::int64_t k = diagonal + 1; k < start[static_cast<std::size_t>(row) + 1]; ++k) {
                const DoubleBlock entry = block(k).template cast<double>();
                const std::uint32_t column = pattern_->columns[static_cast<std::size_t>(k)];
                sum += entry;
                if (column < rows()) {
                    sums[column] += entry;
                }
            }
            sums[static_cast<std::size_t>(row)] += sum;
        }
    }

    const BlockPattern* pattern_;
    const BlockMatrix* coupling_ = nullptr;
    std::vector<Scalar, LineAllocator<Scalar>> values_;
    std::vector<DoubleBlock> compensation_;  // of each row; empty for none
};

}  // namespace pent::simulator
