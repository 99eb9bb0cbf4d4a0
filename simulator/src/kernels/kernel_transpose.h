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

/// to[lane][row] = from[row][lane].
template <int Rows, int Width, typename Scalar>
void transpose(const Scalar (&from)[Rows][Width], Scalar (&to)[Width][Rows]) {
    if constexpr (Width > 1 && Rows % Width == 0) {
        using Type = typename Pack<Scalar, Width>::Vector;
        for (int tile = 0; tile < Rows; tile += Width) {
            Type rows[Width];
            for (int i = 0; i < Width; ++i) {
                __builtin_memcpy(&rows[i], from[tile + i], sizeof(Type));
            }
            transpose(rows);
            for (int i = 0; i < Width; ++i) {
                __builtin_memcpy(&to[i][tile], &rows[i], sizeof(Type));
            }
        }
    } else {
        for (int row = 0; row < Rows; ++row) {
            for (int lane = 0; lane < Width; ++lane) {
                to[lane][row] = from[row][lane];
            }
        }
    }
}

/// The other way: to[row][lane] = from[lane][row].
template <int Rows, int Width, typename Scalar>
void transpose_back(const Scalar (&from)[Width][Rows], Scalar (&to)[Rows][Width]) {
    if constexpr (Width > 1 && Rows % Width == 0) {
        using Type = typename Pack<Scalar, Width>::Vector;
        for (int tile = 0; tile < Rows; tile += Width) {
            Type rows[Width];
            for (int i = 0; i < Width; ++i) {
                __builtin_memcpy(&rows[i], &from[i][tile], sizeof(Type));
            }
            transpose(rows);
            for (int i = 0; i < Width; ++i) {
                __builtin_memcpy(to[tile + i], &rows[i], sizeof(Type));
            }
        }
    } else {
        for (int row = 0; row < Rows; ++row) {
            for (int lane = 0; lane < Width; ++lane) {
                to[row][lane] = from[lane][row];
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
