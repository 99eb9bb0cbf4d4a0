#pragma once

#include "kernels/kernel_lanes.h"
#include "linear/block_kernels.h"

#include <cstddef>

// Dense Cholesky factorization of fronts, see Front: left-looking over blocks of kFrontColumns
// columns. Most of the work is in subtract_tile(), a register-blocked product.

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

// Columns of a tile, and registers of rows in it: with AVX2 twelve of the sixteen registers hold
// sums, three hold rows of A, and one a number of B.
inline constexpr std::size_t kFrontColumns = 4;
inline constexpr int kFrontRegisters = 3;

// A column-major matrix.
struct DenseMatrix {
    double* values = nullptr;
    std::size_t stride = 0;  // from a column to the next

    [[nodiscard]] double* at(std::size_t row, std::size_t column) const {
        return values + column * stride + row;
    }
};

// C -= A B^T for a tile C of Registers registers of rows and Count columns; A and B have `depth`
// columns.
template <typename Real, int Registers, int Count>
void subtract_tile(const DenseMatrix& A,
                   const DenseMatrix& B,
                   std::size_t depth,
                   const DenseMatrix& C) {
    using L = Lanes<Real>;
    Real sums[Count][Registers];
    for (int j = 0; j < Count; ++j) {
        for (int i = 0; i < Registers; ++i) {
            sums[j][i] = L::load(C.at(i * L::kCount, j));
        }
    }
    for (std::size_t k = 0; k < depth; ++k) {
        Real rows[Registers];
        for (int i = 0; i < Registers; ++i) {
            rows[i] = L::load(A.at(i * L::kCount, k));
        }
        for (int j = 0; j < Count; ++j) {
            const Real factor(-*B.at(j, k));
            for (int i = 0; i < Registers; ++i) {
                sums[j][i] = L::multiply_add(rows[i], factor, sums[j][i]);
            }
        }
    }
    for (int j = 0; j < Count; ++j) {
        for (int i = 0; i < Registers; ++i) {
            L::store(sums[j][i], C.at(i * L::kCount, j));
        }
    }
}

// The same for any number of rows that is a multiple of the lanes.
template <typename Real, int Count>
void subtract_columns(const DenseMatrix& A,
                      const DenseMatrix& B,
                      std::size_t depth,
                      std::size_t rows,
                      const DenseMatrix& C) {
    constexpr std::size_t kLanes = Lanes<Real>::kCount;
    constexpr std::size_t kTile = kFrontRegisters * kLanes;
    std::size_t row = 0;
    for (; row + kTile <= rows; row += kTile) {
        subtract_tile<Real, kFrontRegisters, Count>({A.at(row, 0), A.stride}, B, depth,
                                                    {C.at(row, 0), C.stride});
    }
    for (; row < rows; row += kLanes) {
        subtract_tile<Real, 1, Count>({A.at(row, 0), A.stride}, B, depth, {C.at(row, 0), C.stride});
    }
}

// And for up to kFrontColumns columns.
template <typename Real>
void subtract_product(const DenseMatrix& A,
                      const DenseMatrix& B,
                      std::size_t depth,
                      std::size_t rows,
                      std::size_t columns,
                      const DenseMatrix& C) {
    switch (columns) {
        case 1:
            return subtract_columns<Real, 1>(A, B, depth, rows, C);
        case 2:
            return subtract_columns<Real, 2>(A, B, depth, rows, C);
        case 3:
            return subtract_columns<Real, 3>(A, B, depth, rows, C);
        default:
            return subtract_columns<Real, kFrontColumns>(A, B, depth, rows, C);
    }
}

// Cholesky factor of a small block, in place; false where a pivot is not positive and finite.
inline bool factor_block(const DenseMatrix& A, std::size_t size) {
    for (std::size_t j = 0; j < size; ++j) {
        for (std::size_t k = 0; k < j; ++k) {
            for (std::size_t i = j; i < size; ++i) {
                *A.at(i, j) -= *A.at(i, k) * *A.at(j, k);
            }
        }
        const double pivot = *A.at(j, j);
        if (!(pivot > 0) || !(pivot <= __DBL_MAX__)) {
            return false;
        }
        const double inverse = 1 / __builtin_sqrt(pivot);
        for (std::size_t i = j; i < size; ++i) {
            *A.at(i, j) *= inverse;
        }
    }
    return true;
}

// R = R L^-T, for rows R of a panel below a factored block L.
template <typename Real>
void solve_rows(const DenseMatrix& L, std::size_t size, std::size_t rows, const DenseMatrix& R) {
    using Pack = Lanes<Real>;
    double inverses[kFrontColumns];
    for (std::size_t j = 0; j < size; ++j) {
        inverses[j] = 1 / *L.at(j, j);
    }
    for (std::size_t row = 0; row < rows; row += Pack::kCount) {
        Real solved[kFrontColumns];
        for (std::size_t j = 0; j < size; ++j) {
            Real sum = Pack::load(R.at(row, j));
            for (std::size_t k = 0; k < j; ++k) {
                sum = Pack::multiply_add(solved[k], Real(-*L.at(j, k)), sum);
            }
            solved[j] = sum * Real(inverses[j]);
            Pack::store(solved[j], R.at(row, j));
        }
    }
}

template <typename Real>
bool eliminate_front(const Front& front) {
    constexpr std::size_t kLanes = Lanes<Real>::kCount;
    const auto whole = [](std::size_t rows) { return (rows + kLanes - 1) / kLanes * kLanes; };
    const DenseMatrix panel{front.panel, front.panel_stride};
    const std::size_t rows = front.width + front.below;
    for (std::size_t j = 0; j < front.width; j += kFrontColumns) {
        const std::size_t left = front.width - j;
        const std::size_t size = left < kFrontColumns ? left : kFrontColumns;
        subtract_product<Real>({panel.at(j, 0), panel.stride}, {panel.at(j, 0), panel.stride}, j,
                               whole(rows - j), size, {panel.at(j, j), panel.stride});
        const DenseMatrix pivots{panel.at(j, j), panel.stride};
        if (!factor_block(pivots, size)) {
            return false;
        }
        solve_rows<Real>(pivots, size, whole(rows - j - size),
                         {panel.at(j + size, j), panel.stride});
    }
    const DenseMatrix update{front.update, front.update_stride};
    for (std::size_t j = 0; j < front.below; j += kFrontColumns) {
        const std::size_t left = front.below - j;
        const DenseMatrix from_here{panel.at(front.width + j, 0), panel.stride};
        subtract_product<Real>(from_here, from_here, front.width, whole(left),
                               left < kFrontColumns ? left : kFrontColumns,
                               {update.at(j, j), update.stride});
    }
    return true;
}

}  // namespace
}  // namespace pent::simulator
