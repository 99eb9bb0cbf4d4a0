#pragma once

#include <pent/simd.h>

// Transposition of small arrays between the layout of lanes (one element a lane) and that of memory
// (one element after another).

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

/// to[column][row] = from[row][column]: by square tiles in registers where tiles as wide as the
/// shorter side fill the array.
template <int Rows, int Columns, typename Scalar>
void transpose(const Scalar (&from)[Rows][Columns], Scalar (&to)[Columns][Rows]) {
    constexpr int kWidth = Rows < Columns ? Rows : Columns;
    constexpr bool kIsPowerOfTwo = (kWidth & (kWidth - 1)) == 0;
    if constexpr (kWidth > 1 && kIsPowerOfTwo && Rows % kWidth == 0 && Columns % kWidth == 0) {
        using Row = Pack<Scalar, kWidth>;
        for (int row = 0; row < Rows; row += kWidth) {
            for (int column = 0; column < Columns; column += kWidth) {
                Row square[kWidth];
                for (int i = 0; i < kWidth; ++i) {
                    square[i] = Row::load(&from[row + i][column]);
                }
                pent::transpose<kWidth>(square);
                for (int i = 0; i < kWidth; ++i) {
                    square[i].store(&to[column + i][row]);
                }
            }
        }
    } else {
        for (int row = 0; row < Rows; ++row) {
            for (int column = 0; column < Columns; ++column) {
                to[column][row] = from[row][column];
            }
        }
    }
}

/// to[i] += from[i], in vectors of Width.
template <int Count, int Width, typename Scalar>
void add_to(const Scalar (&from)[Count], Scalar* to) {
    if constexpr (Width > 1 && Count % Width == 0) {
        using Type = typename Pack<Scalar, Width>::Vector;
        for (int i = 0; i < Count; i += Width) {
            Type sum;
            Type part;
            __builtin_memcpy(&sum, to + i, sizeof(Type));
            __builtin_memcpy(&part, from + i, sizeof(Type));
            sum += part;
            __builtin_memcpy(to + i, &sum, sizeof(Type));
        }
    } else {
        for (int i = 0; i < Count; ++i) {
            to[i] += from[i];
        }
    }
}

}  // namespace
}  // namespace pent::simulator
