#include <pent/mesher/cut_simplex.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace pent::mesher {
namespace {

constexpr Side kIn = Side::Inside;
constexpr Side kOn = Side::On;
constexpr Side kOut = Side::Outside;

TEST(CutSimplex, LeavesASimplexInsideAsItIs) {
    const std::vector<CutPiece> pieces = cut_simplex({kIn, kIn, kOn});
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_EQ(pieces[0], (CutPiece{{0, 0}, {1, 1}, {2, 2}}));
}

TEST(CutSimplex, HasNoPiecesWithoutACornerInside) {
    EXPECT_TRUE(cut_simplex({kOn, kOut, kOn}).empty());
    EXPECT_TRUE(cut_simplex({kOn, kOn, kOn}).empty());
}

TEST(CutSimplex, CutsOffACorner) {
    const std::vector<CutPiece> pieces = cut_simplex({kOut, kIn, kOut});
    ASSERT_EQ(pieces.size(), 1U);
    // Corner 1 and the cuts of its edges, turned like (0, 1, 2): the corner of a triangle.
    EXPECT_EQ(pieces[0], (CutPiece{{1, 0}, {1, 1}, {1, 2}}));
}

TEST(CutSimplex, CutsAQuadrilateralByTheDiagonalFromItsFirstCorner) {
    const std::vector<CutPiece> pieces = cut_simplex({kIn, kIn, kOut});
    ASSERT_EQ(pieces.size(), 2U);
    for (const CutPiece& piece : pieces) {
        EXPECT_NE(std::find(piece.begin(), piece.end(), CutCorner{0, 0}), piece.end());
        EXPECT_NE(std::find(piece.begin(), piece.end(), CutCorner{1, 2}), piece.end());
    }
}

TEST(ProveStuffing, HoldsInEveryDimension) {
    std::int64_t power = 3;
    for (int dim = 1; dim <= 5; ++dim) {
        power *= 3;
        const StuffingProof proof = prove_stuffing(dim);
        EXPECT_TRUE(proof.holds()) << dim;
        // All patterns of three sides but those of two without one inside.
        EXPECT_EQ(proof.patterns, power - (std::int64_t{1} << (dim + 1))) << dim;
    }
}

}  // namespace
}  // namespace pent::mesher
