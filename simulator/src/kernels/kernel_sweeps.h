#pragma once

#include "kernels/kernel_mode_blocks.h"
#include "linear/block_kernels.h"

// Gauss-Seidel sweeps and products with symmetric matrices over modes, of which the lower triangle
// is stored: see ModeRows for how each block is read only once, and ModeKernels for what is
// computed.

// With AVX a head of floats (see kernel_mode_blocks.h) fits into a register, and inlining keeps all
// in registers. Without, it goes through memory anyway, and inlining only makes the code longer.
#if defined(__AVX__)
#define PENT_SWEEP_INLINE [[gnu::always_inline]]
#else
#define PENT_SWEEP_INLINE [[gnu::noinline]]
#endif

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

template <int Size, bool IsVectorized, typename Scalar>
struct Sweeps {
    using Rows = ModeRows<Scalar>;

    static void sweep_forth(const Rows& rows,
                            const ModeDiagonal<Scalar>& diagonal,
                            const Scalar* r,
                            Scalar* z,
                            Scalar* left) {
        for (std::int64_t row = rows.begin; row < rows.end; ++row) {
            Modes product = {};
            add_blocks(rows, rows.row_start[row], rows.diagonal[row], z, product);
            const Modes rest = less(r + Size * row, product);
            (rest * kept_of(diagonal, row)).store(left + Size * row);
            Scalar* solved = z + Size * row;
            multiply_transposed(diagonal.inverses + kEntries * row, 1, rest, solved);
            share(rows, row, Modes::load(solved));
        }
    }

    static void sweep_back(const Rows& rows,
                           const ModeDiagonal<Scalar>& diagonal,
                           const Scalar* r,
                           Scalar* z) {
        for (std::int64_t row = rows.begin; row < rows.end; ++row) {
            Modes product = {};
            add_shares(rows, row, product);
            add_blocks(rows, rows.row_start[row], rows.row_start[row + 1], z, product);
            Scalar change[Size];
            multiply_transposed(diagonal.inverses + kEntries * row, 1,
                                less(r + Size * row, product), change);
            Modes solved = Modes::load(z + Size * row);
            solved += Modes::load(change);
            solved.store(z + Size * row);
            share(rows, row, solved);
        }
    }

    static void subtract_below(const Rows& rows, const Scalar* r, const Scalar* x, Scalar* left) {
        for (std::int64_t row = rows.begin; row < rows.end; ++row) {
            Modes product = {};
            add_blocks(rows, rows.row_start[row], rows.diagonal[row] + 1, x, product);
            less(r + Size * row, product).store(left + Size * row);
            share(rows, row, Modes::load(x + Size * row));
        }
    }

    static void subtract_above(const Rows& rows, const Scalar* x, Scalar* left) {
        for (std::int64_t row = rows.begin; row < rows.end; ++row) {
            Modes product = {};
            add_shares(rows, row, product);
            add_blocks(rows, rows.diagonal[row] + 1, rows.row_start[row + 1], x, product);
            less(left + Size * row, product).store(left + Size * row);
        }
    }

    static void add_transposed(const Scalar* other, Scalar* block) {
        if constexpr (kWidth == Size - 2) {
            TransposedBlock<Size, Parts, Scalar>::add(other, block);
        } else {  // a plain loop: less code
            for (int j = 0; j < Size; ++j) {
                for (int i = 0; i < Size; ++i) {
                    block[kModePlaces<Size>.at[Size * j + i]] +=
                        other[kModePlaces<Size>.at[Size * i + j]];
                }
            }
        }
    }

private:
    static constexpr int kMost = kRegisterBytes / static_cast<int>(sizeof(Scalar));
    static constexpr int kWidth = !IsVectorized ? 1 : kMost < Size - 2 ? kMost : Size - 2;
    static constexpr int kEntries = Size * Size;
    using Parts = ModeParts<Size, kWidth, Scalar>;
    using Modes = ModeVector<Parts, Scalar>;

    // What damping leaves of the residual of a row: t / (1 + t) of it.
    static Scalar kept_of(const ModeDiagonal<Scalar>& diagonal, std::int64_t row) {
        return diagonal.kept != nullptr ? diagonal.kept[row] : 0;
    }

    [[gnu::always_inline]] static Modes less(const Scalar* from, const Modes& modes) {
        Modes difference = Modes::load(from);
        difference -= modes;
        return difference;
    }

    // product += A x for stored blocks [first, last) of a row.
    PENT_SWEEP_INLINE static void add_blocks(
        const Rows& rows, std::int64_t first, std::int64_t last, const Scalar* x, Modes& product) {
        if (first == last) {
            return;
        }
        RowSum<Size, Parts, Scalar> sum;
        for (std::int64_t k = first; k < last; ++k) {
            sum.add(rows.values + kEntries * k,
                    Modes::load(x + std::int64_t{Size} * rows.columns[k]));
        }
        sum.add_to(product);
    }

    // A^T x for `count` consecutive blocks.
    PENT_SWEEP_INLINE static void multiply_transposed(const Scalar* blocks,
                                                      std::int64_t count,
                                                      const Modes& x,
                                                      Scalar* products) {
        const RowFactor<Size, Parts, Scalar> factor(x);
        for (std::int64_t k = 0; k < count; ++k) {
            factor.transposed_times(blocks + kEntries * k).store(products + Size * k);
        }
    }

    // Stores the shares of a row: products of its transposed blocks with x.
    [[gnu::always_inline]] static void share(const Rows& rows, std::int64_t row, const Modes& x) {
        const std::int64_t first = rows.row_start[row];
        multiply_transposed(rows.values + kEntries * first, rows.diagonal[row] - first, x,
                            rows.shares + Size * first);
    }

    // product += L^T x of a row, from the shares of the rows behind it.
    [[gnu::always_inline]] static void add_shares(const Rows& rows,
                                                  std::int64_t row,
                                                  Modes& product) {
        for (std::int64_t i = rows.above_start[row]; i < rows.above_start[row + 1]; ++i) {
            product += Modes::load(rows.shares + std::int64_t{Size} * rows.above[i]);
        }
    }
};

template <int Size, bool IsVectorized, typename Scalar>
constexpr ModeKernels<Scalar> mode_kernels() {
    using Of = Sweeps<Size, IsVectorized, Scalar>;
    return {.sweep_forth = &Of::sweep_forth,
            .sweep_back = &Of::sweep_back,
            .subtract_below = &Of::subtract_below,
            .subtract_above = &Of::subtract_above,
            .add_transposed = &Of::add_transposed};
}

}  // namespace
}  // namespace pent::simulator

#undef PENT_SWEEP_INLINE
