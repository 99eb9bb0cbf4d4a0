#pragma once

#include <cstdint>
#include <vector>

namespace pent::mesher {

/// On which side of a surface a corner of a simplex lies.
enum class Side : std::int8_t { Inside = -1, On = 0, Outside = 1 };

/// A corner of a piece of a simplex: its corner `inside` if both are the same, else the cut of its
/// edge from `inside` to `outside`.
struct CutCorner {
    std::uint8_t inside = 0;
    std::uint8_t outside = 0;

    friend bool operator==(const CutCorner&, const CutCorner&) = default;
};

/// Corners of one simplex, as many as the simplex has that was cut.
using CutPiece = std::vector<CutCorner>;

/// The part of a simplex inside a surface, as simplices.
///
/// With k corners inside, m outside and z on the surface, it is combinatorially the product of
/// simplices of dimensions k - 1 and m, joined with one of dimension z - 1: inside corner n stands
/// for (n, n), the cut of the edge from n to p for (n, p). The product gets its staircase
/// triangulation, one simplex for each monotone path: C(k - 1 + m, m) pieces. What a face of the
/// simplex sees depends on its own corners and their order alone, so neighbors that order their
/// corners alike agree.
///
/// @param sides  One a corner. Without one inside there are no pieces.
/// @return       Pieces with the orientation of the simplex, wherever the cuts are on their edges.
[[nodiscard]] std::vector<CutPiece> cut_simplex(const std::vector<Side>& sides);

/// What enumeration proves about cut_simplex() in one dimension, in exact integer arithmetic.
struct StuffingProof {
    int dim = 0;

    std::int64_t patterns = 0;  ///< Assignments of sides to the corners, one inside or more.
    std::int64_t pieces = 0;    ///< Of all patterns.
    std::int64_t positive = 0;  ///< Pieces whose volume is a positive product of the parts into
                                ///< which edges are cut: positive wherever the cuts are.
    std::int64_t filled = 0;    ///< Patterns whose pieces fill the part inside: facets between them
        ///< are shared by two from opposite sides, all others lie once on the
        ///< surface or on a side of the simplex, and volumes add up.
    std::int64_t sides = 0;     ///< Sides of the simplex with a corner inside, in all patterns.
    std::int64_t agreeing = 0;  ///< Those that are cut just as simplices of their own would be, so
                                ///< that neighbors agree.

    [[nodiscard]] bool holds() const;
};

/// Proves it for every pattern.
///
/// @param dim  1 to 5.
[[nodiscard]] StuffingProof prove_stuffing(int dim);

}  // namespace pent::mesher
