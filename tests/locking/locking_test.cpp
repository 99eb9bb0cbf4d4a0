#include "beams.h"

#include <gtest/gtest.h>

namespace pent::locking {
namespace {

using simulator::ElementKind;

template <typename T>
class QuadraticBeams : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(QuadraticBeams, Dimensions);

TYPED_TEST(QuadraticBeams, BendAsTheyShouldWithOneParentAcrossWhateverThePoissonRatio) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = beam<kDim>(2, Cut::Structured);
    for (const double share : kShares) {
        const double part = give<kDim>(mesh, ElementKind::Quadratic, share, Load::Bending);
        EXPECT_GT(part, 0.97) << share;
        EXPECT_LT(part, 1.05) << share;
    }
}

TYPED_TEST(QuadraticBeams, BendAndTwistAsTheyShouldWithTwoParentsAcrossAlsoWhereCellsAreDistorted) {
    constexpr int kDim = TypeParam::value;
    for (const Cut cut : {Cut::Structured, Cut::Distorted}) {
        const SimplexMesh<kDim> mesh = beam<kDim>(4, cut);
        for (const double share : {kShares[1], kShares[3]}) {
            for (const Load load : {Load::Bending, Load::Diagonal, Load::Twist}) {
                const double part = give<kDim>(mesh, ElementKind::Quadratic, share, load);
                EXPECT_GT(part, load == Load::Twist ? 0.95 : 0.97) << share;
                EXPECT_LT(part, 1.02) << share;
            }
        }
    }
}

// What pent-mesh makes: no two cells alike, and no grid that they would follow. The last is a
// ten-thousandth below the limit.
TYPED_TEST(QuadraticBeams, BendAndTwistAsTheyShouldWithTwoParentsAcrossOfTetGen) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = beam<kDim>(4, Cut::TetGen);
    for (const double share : {kShares[1], kShares[3], kShares[4]}) {
        for (const Load load : {Load::Bending, Load::Diagonal, Load::Twist}) {
            const double part = give<kDim>(mesh, ElementKind::Quadratic, share, load);
            const bool is_next_to_limit = share == kShares[4];
            EXPECT_GT(part, load == Load::Twist || is_next_to_limit ? 0.95 : 0.97) << share;
            EXPECT_LT(part, is_next_to_limit ? 1.05 : 1.02) << share;
        }
    }
}

// What they are for: with the same vertices linear elements bend half as far, or less.
TEST(QuadraticBeam, BendsTwiceAsFarAsALinearOneOfTheSameVertices) {
    const SimplexMesh<4> mesh = beam<4>(2, Cut::Structured);
    EXPECT_GT(give<4>(mesh, ElementKind::Quadratic, kShares[1], Load::Bending),
              2 * give<4>(mesh, ElementKind::Linear, kShares[1], Load::Bending));
}

}  // namespace
}  // namespace pent::locking
