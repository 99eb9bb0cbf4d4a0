#pragma once

#include <pent/simd.h>

#include <cstddef>
#include <utility>

// Small arrays from one lane an element to one element after the other, and on into memory. By the
// vector types of the compiler, which have shuffles.

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

// One butterfly of a transposition: where a lane has the bit Step it takes from `high`.
template <int Step, typename Type, std::size_t... Lane>
void exchange(Type& low, Type& high, std::index_sequence<Lane...> /*lanes*/) {
    constexpr auto kWidth = sizeof...(Lane);
    const Type first = low;
    low = __builtin_shufflevector(
        first, high, static_cast<int>((Lane & Step) != 0 ? kWidth + Lane - Step : Lane)...);
    high = __builtin_shufflevector(
        first, high, static_cast<int>((Lane & Step) != 0 ? kWidth + Lane : Lane + Step)...);
}

/// Transposes as many vectors as they have lanes. Inlined, or they would go through memory.
template <int Width, typename Type, int Step = Width / 2>
[[gnu::always_inline]] inline void transpose(Type (&rows)[Width]) {
    if constexpr (Step > 0) {
        for (int i = 0; i < Width; ++i) {
            if ((i & Step) == 0) {
                exchange<Step>(rows[i], rows[i + Step], std::make_index_sequence<Width>());
            }
        }
        transpose<Width, Type, Step / 2>(rows);
    }
}

/// to[column][row] = from[row][column]: in squares as wide as the shorter side where they fill it.
template <int Rows, int Columns, typename Scalar>
void transpose(const Scalar (&from)[Rows][Columns], Scalar (&to)[Columns][Rows]) {
    constexpr int kWidth = Rows < Columns ? Rows : Columns;
    constexpr bool kIsPowerOfTwo = (kWidth & (kWidth - 1)) == 0;
    if constexpr (kWidth > 1 && kIsPowerOfTwo && Rows % kWidth == 0 && Columns % kWidth == 0) {
        using Type = typename Pack<Scalar, kWidth>::Vector;
        for (int row = 0; row < Rows; row += kWidth) {
            for (int column = 0; column < Columns; column += kWidth) {
                Type rows[kWidth];
                for (int i = 0; i < kWidth; ++i) {
                    __builtin_memcpy(&rows[i], &from[row + i][column], sizeof(Type));
                }
                transpose(rows);
                for (int i = 0; i < kWidth; ++i) {
                    __builtin_memcpy(&to[column + i][row], &rows[i], sizeof(Type));
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
