#pragma once

#include "kernels.h"

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

}  // namespace
}  // namespace pent::simulator
