#pragma once

#include <compare>
#include <cstdint>
#include <vector>

namespace pent::mesher {

/// A corner of a piece of a simplex: its corner `first` if both are the same, else the middle of
/// its edge from `first` to `second`.
struct HalvedCorner {
    std::uint8_t first = 0;
    std::uint8_t second = 0;

    friend auto operator<=>(const HalvedCorner&, const HalvedCorner&) = default;
};

/// Corners of one simplex, as many as the simplex has that was cut.
using HalvedPiece = std::vector<HalvedCorner>;

/// The number of an edge of a simplex: those from corner 0 come first.
[[nodiscard]] unsigned edge_number(int corners, int from, int to);

/// A simplex of the lattice A_n*, some of whose edges have got a vertex in the middle, as simplices
/// on its corners and these middles: their Delaunay triangulation. All edges cut give the lattice
/// of half the spacing.
///
/// It is the lower hull of the points lifted to the paraboloid (the height of each is its squared
/// distance from the origin); of points on a common sphere the middle of an earlier edge counts as
/// lower, so that the triangulation is unique. What a face of the simplex sees
/// depends on its own corners, their order and middles alone, so neighbors agree. Corners are in
/// the order of the path of the lattice.
///
/// @param dim  n: 1 to 4.
/// @return     For every set of edges with a middle, bit edge_number() for each, the pieces; with
///             the orientation of the simplex.
[[nodiscard]] std::vector<std::vector<HalvedPiece>> halved_simplices(int dim);

/// What enumeration proves about halved_simplices() in one dimension, in exact integer arithmetic.
struct HalvingProof {
    int dim = 0;

    std::int64_t patterns = 0;  ///< Sets of edges with a middle.
    std::int64_t pieces = 0;    ///< Of all patterns.
    std::int64_t positive = 0;  ///< Pieces that are neither flat nor turned over.
    std::int64_t filled = 0;    ///< Patterns whose pieces fill the simplex: facets between them are
        ///< shared by two from opposite sides, all others lie once on a side of
        ///< the simplex, and volumes add up.
    std::int64_t sides = 0;     ///< Sides of the simplex, in all patterns.
    std::int64_t agreeing = 0;  ///< Those that are cut just as simplices of their own would be, so
                                ///< that neighbors agree.
    double least_mean_ratio = 1;  ///< Of all pieces.

    [[nodiscard]] bool holds() const;
};

/// Proves it for every pattern.
///
/// @param dim  2 to 4.
[[nodiscard]] HalvingProof prove_halving(int dim);

}  // namespace pent::mesher
