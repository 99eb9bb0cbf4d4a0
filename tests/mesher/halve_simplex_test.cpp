#include <pent/mesher/halve_simplex.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace pent::mesher {
namespace {

TEST(EdgeNumber, NumbersEveryEdgeOnceFromCornerToCorner) {
    for (int corners = 2; corners <= 5; ++corners) {
        unsigned next = 0;
        for (int from = 0; from < corners; ++from) {
            for (int to = from + 1; to < corners; ++to) {
                EXPECT_EQ(edge_number(corners, from, to), next++);
            }
        }
    }
}

TEST(HalvedSimplices, LeaveASimplexWithoutMiddlesAsItIs) {
    const std::vector<HalvedPiece> pieces = halved_simplices(3)[0];
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_EQ(pieces[0], (HalvedPiece{{0, 0}, {1, 1}, {2, 2}, {3, 3}}));
}

TEST(HalvedSimplices, CutATriangleWithOneMiddleInTwo) {
    const std::vector<HalvedPiece> pieces = halved_simplices(2)[1U << edge_number(3, 0, 2)];
    ASSERT_EQ(pieces.size(), 2U);
    for (const HalvedPiece& piece : pieces) {
        EXPECT_NE(std::find(piece.begin(), piece.end(), HalvedCorner{0, 2}), piece.end());
        EXPECT_NE(std::find(piece.begin(), piece.end(), HalvedCorner{1, 1}), piece.end());
    }
}

// With a middle on every edge the pieces are the simplices of the lattice of half the spacing: the
// corners of each are a path, along which one step in one more axis is taken each time. In steps
// of the simplex's own path, the point (i, j) lies at i + j halves of them.
TEST(HalvedSimplices, GiveTheFinerLatticeWhereAllEdgesAreHalved) {
    for (int dim = 2; dim <= 4; ++dim) {
        const std::vector<HalvedPiece> pieces = halved_simplices(dim).back();
        EXPECT_EQ(pieces.size(), std::size_t{1} << dim);
        for (const HalvedPiece& piece : pieces) {
            std::set<int> steps;
            for (const HalvedCorner& corner : piece) {
                steps.insert(corner.first + corner.second);
            }
            // Consecutive, and each once.
            EXPECT_EQ(static_cast<int>(steps.size()), dim + 1);
            EXPECT_EQ(*steps.rbegin() - *steps.begin(), dim);
        }
    }
}

TEST(ProveHalving, HoldsInEveryDimension) {
    for (int dim = 2; dim <= 4; ++dim) {
        const HalvingProof proof = prove_halving(dim);
        EXPECT_TRUE(proof.holds()) << dim;
        EXPECT_EQ(proof.patterns, std::int64_t{1} << (dim * (dim + 1) / 2)) << dim;
        EXPECT_EQ(proof.sides, (dim + 1) * proof.patterns) << dim;
        // Stuffing and what moves vertices after it work on cells below 0.3.
        EXPECT_GT(proof.least_mean_ratio, 0.38) << dim;
    }
}

}  // namespace
}  // namespace pent::mesher
