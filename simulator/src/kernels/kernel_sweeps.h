#pragma once

#include "kernels/kernel_vertices.h"
#include "linear/block_kernels.h"

#include <cstddef>
#include <utility>

// Sweeps and products with symmetric matrices over modes, see ModeRows.
//
// Blocks are stored by their diagonals: what x of a column is multiplied by lies as x does, what x
// of the row is multiplied by as that does turned, once for all blocks of the row.

// Where registers have a head, what is done to one stays in them. Where none has, code that goes
// through memory is not made longer.
#if defined(__AVX__)
#define PENT_SWEEP_INLINE [[gnu::always_inline]]
#else
#define PENT_SWEEP_INLINE [[gnu::noinline]]
#endif

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

// Numbers in as many registers as they take.
template <int Count, int Width, typename Scalar>
struct InPieces {
    using Piece = typename Pack<Scalar, Width>::Vector;

    Piece at[Count / Width];

    [[gnu::always_inline]] InPieces& operator+=(const InPieces& other) {
#pragma GCC unroll 8
        for (int i = 0; i < Count / Width; ++i) {
            at[i] += other.at[i];
        }
        return *this;
    }
    [[gnu::always_inline]] InPieces& operator-=(const InPieces& other) {
#pragma GCC unroll 8
        for (int i = 0; i < Count / Width; ++i) {
            at[i] -= other.at[i];
        }
        return *this;
    }
    [[gnu::always_inline]] friend InPieces operator+(InPieces a, const InPieces& b) {
        return a += b;
    }
    [[gnu::always_inline]] friend InPieces operator*(InPieces a, const InPieces& b) {
#pragma GCC unroll 8
        for (int i = 0; i < Count / Width; ++i) {
            a.at[i] *= b.at[i];
        }
        return a;
    }
    [[gnu::always_inline]] friend InPieces operator*(InPieces a, Scalar factor) {
#pragma GCC unroll 8
        for (int i = 0; i < Count / Width; ++i) {
            a.at[i] *= factor;
        }
        return a;
    }
};

// Count numbers, in registers of at most Width.
template <int Count, int Width, typename Scalar>
struct NumbersOf {
    using Type = InPieces<Count, Width, Scalar>;
};
template <int Count, typename Scalar>
struct NumbersOf<Count, 1, Scalar> {
    using Type = OneByOne<Count, Scalar>;
};
template <int Count, typename Scalar>
struct NumbersOf<Count, Count, Scalar> {
    using Type = typename Pack<Scalar, Count>::Vector;
};

// Size numbers: a head, all but the last two, and these as often as a tail has them, for the tails
// of two diagonals lie together.
template <int Size, int Width, typename Scalar>
struct ModeParts {
    static constexpr int kHead = Size - 2;
    using Head = typename NumbersOf<kHead, Width, Scalar>::Type;
    using Tail = typename NumbersOf<4, (Width < 4 ? Width : 4), Scalar>::Type;

    static Tail tail_at(const Scalar* two) { return tail_of(two[0], two[1], two[0], two[1]); }
    static void store_two(const Tail& tail, Scalar* to) {
        __builtin_memcpy(to, &tail, 2 * sizeof(Scalar));
    }
    // Numbers First, First + 1 and so on (mod Size); the last two are numbers At and At + 1 of the
    // tail.
    template <int First, int At>
    static Head turned(const Head& head, const Tail& tail) {
        const Numbers<kHead> of_head(head);
        const Numbers<4> of_tail(tail);
        Scalar numbers[kHead];
        for (int i = 0; i < kHead; ++i) {
            const int k = (First + i) % Size;
            numbers[i] = k < kHead ? of_head.at[k] : of_tail.at[At + k - kHead];
        }
        Head result;
        __builtin_memcpy(&result, numbers, sizeof result);
        return result;
    }
    // Four numbers of a head.
    template <int... Number>
    static Tail picked(const Head& head) {
        const Numbers<kHead> of(head);
        return tail_of(of.at[Number]...);
    }
    static Tail summed(const Tail& tail) {
        const Numbers<4> of(tail);
        const Scalar sums[2] = {of.at[0] + of.at[2], of.at[1] + of.at[3]};
        return tail_at(sums);
    }

private:
    template <int Count>
    struct Numbers {
        Scalar at[Count];

        template <typename Of>
        explicit Numbers(const Of& of) {
            __builtin_memcpy(at, &of, sizeof at);
        }
    };
    static Tail tail_of(Scalar first, Scalar second, Scalar third, Scalar fourth) {
        const Scalar numbers[4] = {first, second, third, fourth};
        Tail tail;
        __builtin_memcpy(&tail, numbers, sizeof tail);
        return tail;
    }
};

// Those whose heads are in one register each.
template <int Size, typename Scalar>
struct WholeModeParts {
    static constexpr int kHead = Size - 2;
    using Head = typename Pack<Scalar, kHead>::Vector;
    using Tail = typename Pack<Scalar, 4>::Vector;
    using Two = typename Pack<Scalar, 2>::Vector;

    [[gnu::always_inline]] static Tail tail_at(const Scalar* from) {
        Two two;
        __builtin_memcpy(&two, from, sizeof two);
        return __builtin_shufflevector(two, two, 0, 1, 0, 1);
    }
    [[gnu::always_inline]] static void store_two(const Tail& tail, Scalar* to) {
        const Two two = __builtin_shufflevector(tail, tail, 0, 1);
        __builtin_memcpy(to, &two, sizeof two);
    }
    template <int First, int At>
    [[gnu::always_inline]] static Head turned(const Head& head, const Tail& tail) {
        return turned<First, At>(head, widened(tail), std::make_index_sequence<kHead>());
    }
    template <int... Number>
    [[gnu::always_inline]] static Tail picked(const Head& head) {
        return __builtin_shufflevector(head, head, Number...);
    }
    [[gnu::always_inline]] static Tail joined(const Head& first, const Head& second) {
        return __builtin_shufflevector(first, second, 0, 1, kHead, kHead + 1);
    }
    [[gnu::always_inline]] static Tail summed(const Tail& tail) {
        return tail + __builtin_shufflevector(tail, tail, 2, 3, 0, 1);
    }

private:
    [[gnu::always_inline]] static Head widened(const Tail& tail) {
        if constexpr (kHead == 4) {
            return tail;
        } else {
            return __builtin_shufflevector(tail, tail, 0, 1, 2, 3, 0, 1, 2, 3);
        }
    }
    static constexpr int place(int number, int at) {
        return number % Size < kHead ? number % Size : number % Size + at;
    }
    template <int First, int At, std::size_t... Lane>
    [[gnu::always_inline]] static Head turned(const Head& head,
                                              const Head& tail,
                                              std::index_sequence<Lane...> /*lanes*/) {
        return __builtin_shufflevector(head, tail, place(First + static_cast<int>(Lane), At)...);
    }
};
template <int Size, typename Scalar>
struct ModeParts<Size, Size - 2, Scalar> : WholeModeParts<Size, Scalar> {};

// One number a mode.
template <typename Parts, typename Scalar>
struct ModeVector {
    typename Parts::Head head;
    typename Parts::Tail tail;  // the last two, twice

    [[gnu::always_inline]] static ModeVector load(const Scalar* from) {
        ModeVector modes;
        __builtin_memcpy(&modes.head, from, sizeof modes.head);
        modes.tail = Parts::tail_at(from + Parts::kHead);
        return modes;
    }
    [[gnu::always_inline]] void store(Scalar* to) const {
        __builtin_memcpy(to, &head, sizeof head);
        Parts::store_two(tail, to + Parts::kHead);
    }
    [[gnu::always_inline]] ModeVector& operator+=(const ModeVector& other) {
        head += other.head;
        tail += other.tail;
        return *this;
    }
    [[gnu::always_inline]] ModeVector& operator-=(const ModeVector& other) {
        head -= other.head;
        tail -= other.tail;
        return *this;
    }
    [[gnu::always_inline]] friend ModeVector operator*(const ModeVector& modes, Scalar factor) {
        return {modes.head * factor, modes.tail * factor};
    }
};

template <typename Numbers, typename Scalar>
[[gnu::always_inline]] inline Numbers numbers_at(const Scalar* from) {
    Numbers numbers;
    __builtin_memcpy(&numbers, from, sizeof numbers);
    return numbers;
}

// The sum of products of blocks of a row, each with the x of its column.
template <int Size, typename Parts, typename Scalar>
class RowSum {
public:
    using Modes = ModeVector<Parts, Scalar>;

    [[gnu::always_inline]] void add(const Scalar* block, const Modes& x) {
#pragma GCC unroll 16
        for (int d = 0; d < Size; ++d) {
            heads_[d] += numbers_at<Head>(block + kHead * d) * x.head;
        }
        const Scalar* tails = block + kHead * Size;
#pragma GCC unroll 16
        for (int pair = 0; pair < Size / 2; ++pair) {
            tails_[pair] += numbers_at<Tail>(tails + 4 * pair) * x.tail;
        }
    }

    [[gnu::always_inline]] void add_to(Modes& rows) const {
        add_to(rows, std::make_index_sequence<Size / 2>());
    }

private:
    static constexpr int kHead = Parts::kHead;
    using Head = typename Parts::Head;
    using Tail = typename Parts::Tail;

    // Number j of diagonal d belongs to row j - d.
    template <std::size_t... Pair>
    [[gnu::always_inline]] void add_to(Modes& rows, std::index_sequence<Pair...> /*pairs*/) const {
        Head ends = {};
        (add_pair<static_cast<int>(Pair)>(rows, ends), ...);
        rows.tail += Parts::template picked<0, 1, 0, 1>(ends);
    }
    template <int Pair>
    [[gnu::always_inline]] void add_pair(Modes& rows, Head& ends) const {
        constexpr int d = 2 * Pair;
        const Tail tail = tails_[Pair];
        rows.head += Parts::template turned<d, 0>(heads_[d], tail)
                     + Parts::template turned<d + 1, 2>(heads_[d + 1], tail);
        ends += Parts::template turned<d + kHead, 0>(heads_[d], tail)
                + Parts::template turned<d + 1 + kHead, 2>(heads_[d + 1], tail);
    }

    Head heads_[Size] = {};
    Tail tails_[Size / 2] = {};
};

// The x of a row, for products with the transposes of its blocks.
template <int Size, typename Parts, typename Scalar>
class RowFactor {
public:
    using Modes = ModeVector<Parts, Scalar>;

    [[gnu::always_inline]] explicit RowFactor(const Modes& x) {
        turn(x, std::make_index_sequence<Size / 2>());
    }

    [[gnu::always_inline]] Modes transposed_times(const Scalar* block) const {
        Head heads[2] = {};
#pragma GCC unroll 16
        for (int d = 0; d < Size; ++d) {
            heads[d % 2] += numbers_at<Head>(block + kHead * d) * heads_[d];
        }
        const Scalar* tails = block + kHead * Size;
        Tail tail = {};
#pragma GCC unroll 16
        for (int pair = 0; pair < Size / 2; ++pair) {
            tail += numbers_at<Tail>(tails + 4 * pair) * tails_[pair];
        }
        return {heads[0] + heads[1], Parts::summed(tail)};
    }

private:
    static constexpr int kHead = Parts::kHead;
    using Head = typename Parts::Head;
    using Tail = typename Parts::Tail;

    template <std::size_t... Pair>
    [[gnu::always_inline]] void turn(const Modes& x, std::index_sequence<Pair...> /*pairs*/) {
        (turn_pair<static_cast<int>(Pair)>(x), ...);
    }
    // Number j of diagonal d is multiplied by that of row j - d.
    template <int Pair>
    [[gnu::always_inline]] void turn_pair(const Modes& x) {
        constexpr int d = 2 * Pair;
        heads_[d] = Parts::template turned<Size - d, 0>(x.head, x.tail);
        heads_[d + 1] = Parts::template turned<Size - d - 1, 0>(x.head, x.tail);
        tails_[Pair] = Parts::template picked<1, 2, 0, 1>(
            Parts::template turned<Size + kHead - d - 1, 0>(x.head, x.tail));
    }

    Head heads_[Size];
    Tail tails_[Size / 2];
};

// Number j of diagonal d of the transpose is number j - d of diagonal -d.
template <int Size, typename Parts, typename Scalar>
class TransposedBlock {
public:
    static void add(const Scalar* other, Scalar* block) {
        add(other, block, std::make_index_sequence<Size / 2>());
    }

private:
    static constexpr int kHead = Parts::kHead;
    using Head = typename Parts::Head;
    using Tail = typename Parts::Tail;

    // Numbers First and so on of diagonal -Diagonal.
    template <int Diagonal, int First>
    [[gnu::always_inline]] static Head turned(const Scalar* other) {
        constexpr int of = (Size - Diagonal) % Size;
        return Parts::template turned<First, 2 * (of % 2)>(
            numbers_at<Head>(other + kHead * of),
            numbers_at<Tail>(other + kHead * Size + 4 * (of / 2)));
    }
    template <typename Numbers>
    [[gnu::always_inline]] static void add_to(Scalar* place, const Numbers& numbers) {
        const Numbers sum = numbers_at<Numbers>(place) + numbers;
        __builtin_memcpy(place, &sum, sizeof sum);
    }
    template <std::size_t... Pair>
    [[gnu::always_inline]] static void add(const Scalar* other,
                                           Scalar* block,
                                           std::index_sequence<Pair...> /*pairs*/) {
        (add_pair<2 * static_cast<int>(Pair)>(other, block), ...);
    }
    template <int Diagonal>
    [[gnu::always_inline]] static void add_pair(const Scalar* other, Scalar* block) {
        constexpr int next = Diagonal + 1;
        add_to(block + kHead * Diagonal, turned<Diagonal, Size - Diagonal>(other));
        add_to(block + kHead * next, turned<next, Size - next>(other));
        add_to(block + kHead * Size + 2 * Diagonal,
               Parts::joined(turned<Diagonal, Size + kHead - Diagonal>(other),
                             turned<next, Size + kHead - next>(other)));
    }
};

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
        } else {  // one by one, in less code
            for (int entry = 0; entry < kEntries; ++entry) {
                block[entry] += other[kTransposed.at[entry]];
            }
        }
    }

private:
    static constexpr int kMost = kRegisterBytes / static_cast<int>(sizeof(Scalar));
    static constexpr int kWidth = !IsVectorized ? 1 : kMost < Size - 2 ? kMost : Size - 2;
    static constexpr int kEntries = Size * Size;
    // Where the entries of a block are in its transpose.
    struct Places {
        std::uint8_t at[kEntries];
    };
    static constexpr Places transposed() {
        Places places = {};
        for (int j = 0; j < Size; ++j) {
            for (int i = 0; i < Size; ++i) {
                places.at[mode_entry<Size>(i, j)] =
                    static_cast<std::uint8_t>(mode_entry<Size>(j, i));
            }
        }
        return places;
    }
    static constexpr Places kTransposed = transposed();
    using Parts = ModeParts<Size, kWidth, Scalar>;
    using Modes = ModeVector<Parts, Scalar>;

    static Scalar kept_of(const ModeDiagonal<Scalar>& diagonal, std::int64_t row) {
        return diagonal.kept != nullptr ? diagonal.kept[row] : 0;
    }

    [[gnu::always_inline]] static Modes less(const Scalar* from, const Modes& modes) {
        Modes difference = Modes::load(from);
        difference -= modes;
        return difference;
    }

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

    // A^T x of some blocks, one after the other.
    PENT_SWEEP_INLINE static void multiply_transposed(const Scalar* blocks,
                                                      std::int64_t count,
                                                      const Modes& x,
                                                      Scalar* products) {
        const RowFactor<Size, Parts, Scalar> factor(x);
        for (std::int64_t k = 0; k < count; ++k) {
            factor.transposed_times(blocks + kEntries * k).store(products + Size * k);
        }
    }

    [[gnu::always_inline]] static void share(const Rows& rows, std::int64_t row, const Modes& x) {
        const std::int64_t first = rows.row_start[row];
        multiply_transposed(rows.values + kEntries * first, rows.diagonal[row] - first, x,
                            rows.shares + Size * first);
    }

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
