#pragma once

#include "kernels/kernel_vertices.h"
#include "linear/block_kernels.h"

// Products with symmetric matrices of which the upper triangle is stored: each block is read once
// and used twice, for its own row and, transposed, for the row of its column. Rows run in parallel
// only where they touch no common dof, see BlockPattern::coloring.

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

template <int Dim, typename Scalar>
void multiply_rows(const BlockRows<Scalar>& rows, const double* x, double* y) {
    constexpr int kEntries = Dim * Dim;
    for (std::int64_t row = rows.begin; row < rows.end; ++row) {
        double x_row[Dim];
        double sum[Dim];
        for (int i = 0; i < Dim; ++i) {
            x_row[i] = x[row * Dim + i];
            sum[i] = 0;
        }
        std::int64_t block = rows.row_start[row];
        const Scalar* entry = rows.values + block * kEntries;
        for (int j = 0; j < Dim; ++j) {  // the diagonal block
            for (int i = 0; i < Dim; ++i) {
                sum[i] += static_cast<double>(entry[block_entry<Dim>(i, j)]) * x_row[j];
            }
        }
        for (++block; block < rows.row_start[row + 1]; ++block) {
            entry = rows.values + block * kEntries;
            const double* x_column = x + std::int64_t{Dim} * rows.columns[block];
            double* y_column = y + std::int64_t{Dim} * rows.columns[block];
            for (int j = 0; j < Dim; ++j) {
                double dot = 0;
                for (int i = 0; i < Dim; ++i) {
                    const double value = static_cast<double>(entry[block_entry<Dim>(i, j)]);
                    sum[i] += value * x_column[j];
                    dot += value * x_row[i];
                }
                y_column[j] += dot;
            }
        }
        for (int i = 0; i < Dim; ++i) {
            y[row * Dim + i] += sum[i];
        }
    }
}

// Prefetches what lies 64 blocks ahead, in the next page: hardware prefetchers stop at the end of a
// page. Inlined, see ReadAhead.
template <typename Scalar>
[[gnu::always_inline]] inline void prefetch_ahead(const Scalar* block,
                                                  const std::uint32_t* column) {
    constexpr int kAhead = 64;
    constexpr int kLine = 64 / sizeof(Scalar);
    for (int entry = 0; entry < 16; entry += kLine) {
        __builtin_prefetch(block + 16 * kAhead + entry);
    }
    __builtin_prefetch(column + 4 * kAhead);
}

// The same for 4 x 4 blocks, stored by XOR diagonals (see block_order.h): products of the block
// with x_column are summed up as diagonals over the whole row and put in order once at its end;
// those of its transpose take permutations of x_row, made once for the row.
template <typename Scalar>
void multiply_rows_4(const BlockRows<Scalar>& rows, const double* x, double* y) {
    const std::int64_t* row_start = rows.row_start;
    const std::uint32_t* columns = rows.columns;
    for (std::int64_t row = rows.begin, end = rows.end; row < end; ++row) {
        std::int64_t k = row_start[row];
        const std::int64_t last = row_start[row + 1];
        const Scalar* block = rows.values + 16 * k;
        const auto x_row = permuted(load_four(x + 4 * row));
        Diagonals sums = diagonals_of(block);
        for (Four& sum : sums.at) {
            sum *= x_row.at[0];
        }
        for (++k, block += 16; k < last; ++k, block += 16) {
            prefetch_ahead(block, columns + k);
            const std::int64_t at = std::int64_t{4} * columns[k];
            const Four x_column = load_four(x + at);
            const Diagonals of = diagonals_of(block);
            for (int d = 0; d < 4; ++d) {
                sums.at[d] += of.at[d] * x_column;
            }
            const Four even = load_four(y + at) + of.at[0] * x_row.at[0] + of.at[2] * x_row.at[2];
            const Four odd = of.at[1] * x_row.at[1] + of.at[3] * x_row.at[3];
            store(even + odd, y + at);
        }
        store(load_four(y + 4 * row) + rows_of(sums), y + 4 * row);
    }
}

}  // namespace
}  // namespace pent::simulator
