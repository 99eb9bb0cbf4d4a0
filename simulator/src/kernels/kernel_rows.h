#pragma once

#include "linear/block_kernels.h"

// Products with symmetric block rows.

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
                sum[i] += static_cast<double>(entry[j * Dim + i]) * x_row[j];
            }
        }
        for (++block; block < rows.row_start[row + 1]; ++block) {
            entry = rows.values + block * kEntries;
            const double* x_column = x + std::int64_t{Dim} * rows.columns[block];
            double* y_column = y + std::int64_t{Dim} * rows.columns[block];
            for (int j = 0; j < Dim; ++j) {
                double dot = 0;
                for (int i = 0; i < Dim; ++i) {
                    const double value = static_cast<double>(entry[j * Dim + i]);
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

// The same for 4 x 4 blocks, a column of a block in one vector. Written with the vector types of
// the compiler, for packs have no shuffles; a machine without vectors of four gets pairs.
using Four [[gnu::vector_size(32)]] = double;

template <typename Scalar>
Four load_four(const Scalar* from) {
    using Narrow [[gnu::vector_size(4 * sizeof(Scalar))]] = Scalar;
    Narrow narrow;
    __builtin_memcpy(&narrow, from, sizeof narrow);
    return __builtin_convertvector(narrow, Four);
}

inline void add_four(const Four& value, double* to) {
    const Four sum = load_four(to) + value;
    __builtin_memcpy(to, &sum, sizeof sum);
}

// Sums of the entries of four vectors.
inline Four sums_of(const Four& a, const Four& b, const Four& c, const Four& d) {
    const Four ab =
        __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Four cd =
        __builtin_shufflevector(c, d, 0, 4, 2, 6) + __builtin_shufflevector(c, d, 1, 5, 3, 7);
    return __builtin_shufflevector(ab, cd, 0, 1, 4, 5)
           + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

template <typename Scalar>
void multiply_rows_4(const BlockRows<Scalar>& rows, const double* x, double* y) {
    for (std::int64_t row = rows.begin; row < rows.end; ++row) {
        const Four x_row = load_four(x + 4 * row);
        const Scalar* block = rows.values + 16 * rows.row_start[row];
        Four sum = load_four(block) * x_row[0] + load_four(block + 4) * x_row[1];
        Four sum_2 = load_four(block + 8) * x_row[2] + load_four(block + 12) * x_row[3];
        for (std::int64_t k = rows.row_start[row] + 1; k < rows.row_start[row + 1]; ++k) {
            block += 16;
            const std::int64_t at = std::int64_t{4} * rows.columns[k];
            const Four c0 = load_four(block);
            const Four c1 = load_four(block + 4);
            const Four c2 = load_four(block + 8);
            const Four c3 = load_four(block + 12);
            sum += c0 * x[at];
            sum_2 += c1 * x[at + 1];
            sum += c2 * x[at + 2];
            sum_2 += c3 * x[at + 3];
            add_four(sums_of(c0 * x_row, c1 * x_row, c2 * x_row, c3 * x_row), y + at);
        }
        add_four(sum + sum_2, y + 4 * row);
    }
}

// Parts of rows of Size x Size blocks: y = A x.
template <int Size, typename Scalar>
void multiply_spans(const BlockSpans<Scalar>& rows, const Scalar* x, Scalar* y) {
    for (std::int64_t row = rows.begin; row < rows.end; ++row) {
        Scalar sum[Size] = {};
        for (std::int64_t k = rows.first[row]; k < rows.last[row]; ++k) {
            const Scalar* entry = rows.values + k * Size * Size;
            const Scalar* x_column = x + std::int64_t{Size} * rows.columns[k];
            for (int j = 0; j < Size; ++j) {
                for (int i = 0; i < Size; ++i) {
                    sum[i] += entry[j * Size + i] * x_column[j];
                }
            }
        }
        for (int i = 0; i < Size; ++i) {
            y[row * Size + i] = sum[i];
        }
    }
}

// The same in vectors of at most 32 bytes: the last ends with the column, so that some rows are in
// two vectors, and computed twice. Four columns have sums of their own.
template <int Size, typename Scalar>
void multiply_spans_by_vectors(const BlockSpans<Scalar>& rows, const Scalar* x, Scalar* y) {
    constexpr int kWide = sizeof(Scalar) == sizeof(float) && Size >= 8 ? 8 : 4;
    static_assert(Size >= kWide);
    constexpr int kVectors = (Size + kWide - 1) / kWide;
    constexpr int kSums = 4;
    using Pack [[gnu::vector_size(kWide * sizeof(Scalar))]] = Scalar;
    for (std::int64_t row = rows.begin; row < rows.end; ++row) {
        Pack sums[kSums][kVectors] = {};
        for (std::int64_t k = rows.first[row]; k < rows.last[row]; ++k) {
            const Scalar* block = rows.values + k * Size * Size;
            const Scalar* x_column = x + std::int64_t{Size} * rows.columns[k];
            for (int j = 0; j < Size; ++j) {
                for (int v = 0; v < kVectors; ++v) {
                    const int at = v + 1 < kVectors ? kWide * v : Size - kWide;
                    Pack column;
                    __builtin_memcpy(&column, block + j * Size + at, sizeof column);
                    sums[j % kSums][v] += column * x_column[j];
                }
            }
        }
        for (int v = 0; v < kVectors; ++v) {
            const Pack sum = (sums[0][v] + sums[1][v]) + (sums[2][v] + sums[3][v]);
            const int at = v + 1 < kVectors ? kWide * v : Size - kWide;
            __builtin_memcpy(y + row * Size + at, &sum, sizeof sum);
        }
    }
}

}  // namespace
}  // namespace pent::simulator
