#pragma once

#include <cstdint>

namespace pent::simulator {

/// Rows [begin, end) of a symmetric block matrix.
template <typename Scalar>
struct BlockRows {
    const Scalar* values = nullptr;  ///< Blocks, column-major.
    const std::int64_t* row_start =
        nullptr;                             ///< Blocks of row i: [row_start[i], row_start[i + 1]).
    const std::uint32_t* columns = nullptr;  ///< Of blocks.
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// Parts of rows [begin, end) of a block matrix: the blocks [first[i], last[i]) of row i.
template <typename Scalar>
struct BlockSpans {
    const Scalar* values = nullptr;  ///< Blocks, column-major.
    const std::int64_t* first = nullptr;
    const std::int64_t* last = nullptr;
    const std::uint32_t* columns = nullptr;  ///< Of blocks.
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// The inner loops of linear algebra.
struct BlockKernels {
    /// y += A x for Dim x Dim blocks. Rows hold the upper triangle, the diagonal block first; their
    /// blocks count in both triangles.
    void (*multiply_float)(const BlockRows<float>& rows, const double* x, double* y);
    void (*multiply_double)(const BlockRows<double>& rows, const double* x, double* y);

    /// y = A x for blocks of Dim (Dim + 1) / 2 rows, that many modes. Sums have the precision of
    /// the blocks: preconditioners need no more.
    void (*multiply_modes_float)(const BlockSpans<float>& rows, const float* x, float* y);
    void (*multiply_modes_double)(const BlockSpans<double>& rows, const double* x, double* y);
};

}  // namespace pent::simulator
