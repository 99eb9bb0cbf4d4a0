#pragma once

namespace pent::simulator {

/// Place of an entry among the Dim^2 numbers of a stored block: column by column, but 4 x 4 blocks
/// by their diagonals, number j of diagonal k being that in row j ^ k of column j.
///
/// So a product with a block takes what it is multiplied by as it lies in memory, one with its
/// transpose the same numbers in an order that all blocks of a row share, and neither needs a sum
/// across a vector.
template <int Dim>
[[gnu::always_inline]] constexpr int block_entry(int row, int column) {
    return Dim == 4 ? 4 * (row ^ column) + column : Dim * column + row;
}

/// The same for blocks of Size modes, by their diagonals, too: number j of diagonal d is that in
/// row j - d (mod Size) of column j. All columns but the last two come first, which are a vector,
/// then those two: of two diagonals at a time they are one of four.
template <int Size>
[[gnu::always_inline]] constexpr int mode_entry(int row, int column) {
    constexpr int kHead = Size - 2;
    const int diagonal = (column - row + Size) % Size;
    return column < kHead ? kHead * diagonal + column
                          : kHead * Size + 2 * diagonal + column - kHead;
}

}  // namespace pent::simulator
