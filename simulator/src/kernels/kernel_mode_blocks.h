#pragma once

#include "kernels/kernel_vertices.h"
#include "linear/block_order.h"

#include <cstddef>
#include <cstdint>
#include <utility>

// Vectors over the modes of an aggregate, and products of blocks with them.
//
// Blocks are stored by cyclic diagonals, see mode_entry(): a product A x multiplies each diagonal
// by x as it lies in memory, one with the transpose, A^T x, by x rotated by the number of the
// diagonal ("turned" here), which is done once for all blocks of a row. A vector of Size numbers is
// kept as a head, all but the last two, and a tail, the last two twice over, since the tails of two
// diagonals lie side by side.

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

// mode_entry() as a table: places of the entries of a block, column-major.
template <int Size>
struct ModePlaces {
    std::uint8_t at[Size * Size];
};
template <int Size>
constexpr ModePlaces<Size> mode_places() {
    ModePlaces<Size> places = {};
    for (int column = 0; column < Size; ++column) {
        for (int row = 0; row < Size; ++row) {
            places.at[Size * column + row] =
                static_cast<std::uint8_t>(mode_entry<Size>(row, column));
        }
    }
    return places;
}
template <int Size>
constexpr ModePlaces<Size> kModePlaces = mode_places<Size>();

// Count numbers in Count / Width registers.
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

// Count numbers in registers of at most Width.
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

// How heads and tails are kept, and how numbers move between them.
template <int Size, int Width, typename Scalar>
struct ModeParts {
    static constexpr int kHead = Size - 2;
    using Head = typename NumbersOf<kHead, Width, Scalar>::Type;
    using Tail = typename NumbersOf<4, (Width < 4 ? Width : 4), Scalar>::Type;

    static Tail tail_at(const Scalar* two) { return tail_of(two[0], two[1], two[0], two[1]); }
    static void store_two(const Tail& tail, Scalar* to) {
        __builtin_memcpy(to, &tail, 2 * sizeof(Scalar));
    }
    // The head of a rotated vector: its numbers First, First + 1 and so on (mod Size), of which the
    // last two are at At and At + 1 of the tail.
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
    // The sums of the two halves of a tail, twice over.
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

// The same where a head fits into one register: all moves are shuffles.
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

// A vector over the modes of one aggregate.
template <typename Parts, typename Scalar>
struct ModeVector {
    typename Parts::Head head;
    typename Parts::Tail tail;  // the last two numbers, twice over

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

// Sums up A x over the blocks of a row, each with the x of its column. Sums are kept by diagonals,
// and put in the order of rows once at the end, by add_to().
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

// The x of a row, rotated for every diagonal, for products with the transposes of its blocks.
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

// Adds the transpose of a block. Number j of its diagonal d is number j - d of diagonal -d of the
// block (mod Size).
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

    // Numbers First, First + 1 and so on of diagonal -Diagonal.
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

}  // namespace
}  // namespace pent::simulator
