#pragma once

#include <cstdint>

namespace pent::simulator {

/// Rows [begin, end) of a symmetric block matrix stored by the upper triangle.
template <typename Scalar>
struct BlockRows {
    const Scalar* values = nullptr;  ///< Dim x Dim blocks, column-major.
    const std::int64_t* row_start =
        nullptr;                             ///< Blocks of row i: [row_start[i], row_start[i + 1]).
    const std::uint32_t* columns = nullptr;  ///< The diagonal block comes first in its row.
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// The inner loops of linear algebra: y += A x for the blocks of the rows, in both triangles.
struct BlockKernels {
    void (*multiply_float)(const BlockRows<float>& rows, const double* x, double* y);
    void (*multiply_double)(const BlockRows<double>& rows, const double* x, double* y);
};

}  // namespace pent::simulator
