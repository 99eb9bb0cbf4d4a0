#pragma once

namespace pent::simulator {

/// Place of an entry among the Dim^2 numbers of a stored block: column-major, but 4 x 4 blocks by
/// XOR diagonals, number j of diagonal k being entry (j ^ k, j).
///
/// So A x multiplies every diagonal by x as it lies in memory, A^T x by permutations of x that are
/// the same for all blocks of a row, and neither needs a horizontal sum across a vector.
template <int Dim>
[[gnu::always_inline]] constexpr int block_entry(int row, int column) {
    return Dim == 4 ? 4 * (row ^ column) + column : Dim * column + row;
}

/// The same for Size x Size blocks over modes, by cyclic diagonals: number j of diagonal d is entry
/// (j - d mod Size, j). Size, 6 or 10, is two more than a power of two: the heads of all diagonals
/// come first, all columns but the last two, which are a vector of 4 or 8 numbers; then the tails,
/// those two columns, where two diagonals together make a vector of four.
template <int Size>
[[gnu::always_inline]] constexpr int mode_entry(int row, int column) {
    constexpr int kHead = Size - 2;
    const int diagonal = (column - row + Size) % Size;
    return column < kHead ? kHead * diagonal + column
                          : kHead * Size + 2 * diagonal + column - kHead;
}

}  // namespace pent::simulator
