#include "shapes/lattice_tree.h"

#include <pent/mesher/primitives.h>
#include <pent/mesher/stuff.h>

#include <gtest/gtest.h>

#include <cmath>

namespace pent::mesher {
namespace {

using Eigen::Vector4d;

constexpr double kEdge = 0.2;
const Eigen::Matrix4d kUnturned = Eigen::Matrix4d::Identity();

Eigen::Matrix4d turn(int from, int to, double angle) {
    Eigen::Matrix4d rotation = kUnturned;
    rotation(from, from) = rotation(to, to) = std::cos(angle);
    rotation(to, from) = std::sin(angle);
    rotation(from, to) = -rotation(to, from);
    return rotation;
}

ThinParts thin_parts(const Solid& solid, double edge_length) {
    return LatticeTree(solid, Lattice::with_mean_edge(edge_length), {}).thin_parts();
}

// A wall between two hollows of a beam, or a gap between two beams: as thick in x, around 0.1.
Solid slab(double width, bool is_gap) {
    const Solid beam = box_solid({2, 0.8, 0.8, 0.8});
    const double side = is_gap ? 1 : 0.35;
    const Solid part = is_gap ? beam : box_solid({2 * side, 0.4, 0.4, 0.4});
    const Solid high = place(part, 1, kUnturned, {0.1 + side + width / 2, 0, 0, 0});
    const Solid low = place(part, 1, kUnturned, {0.1 - side - width / 2, 0, 0, 0});
    return is_gap ? unite(low, high) : subtract(subtract(beam, high), low);
}

TEST(ThinParts, WallsAndGapsThinnerThanEdgesAreFoundWithWidthAndPlace) {
    const Eigen::Matrix4d rotation = turn(0, 3, 0.5) * turn(1, 2, 0.3) * turn(0, 1, 0.2);
    for (const bool is_gap : {false, true}) {
        for (const double width : {0.01, 0.05, 0.1}) {
            const Solid solid = place(slab(width, is_gap), 1, rotation, {0.3, 0, -0.2, 0});
            const ThinParts thin = thin_parts(solid, kEdge);
            ASSERT_GT(thin.edges, 0) << is_gap << " " << width;
            // Both sides are flat: what the ends of an edge see of them is exact.
            EXPECT_NEAR(thin.width, width, 1e-9) << is_gap;
            const Vector4d there = rotation.transpose() * (thin.place - Vector4d(0.3, 0, -0.2, 0));
            EXPECT_NEAR(there[0], 0.1, kEdge) << is_gap;
            EXPECT_LT(there.tail<3>().cwiseAbs().maxCoeff(), 0.6) << is_gap;
        }
    }
}

TEST(ThinParts, WithTheEdgesThatAreAdvisedNothingIsThin) {
    const Solid solid = slab(0.12, true);
    const ThinParts thin = stuff(solid, 0.3).thin_parts;
    ASSERT_GT(thin.edges, 0);
    // The longest edges are a tenth longer than their mean.
    EXPECT_EQ(thin_parts(solid, thin.width / 1.1).edges, 0);
}

TEST(ThinParts, AreFoundWhereEdgesGrow) {
    const Solid solid = slab(0.05, true);
    SizeField sizes;
    sizes.point = Vector4d(-1.5, 0, 0, 0);  // the gap is where edges are longer
    sizes.growth = 0.5;
    const LatticeTree tree(solid, Lattice::with_mean_edge(0.06), sizes);
    EXPECT_GT(tree.thin_parts().edges, 0);
    EXPECT_NEAR(tree.thin_parts().width, 0.05, 1e-9);
}

TEST(ThinParts, OfAShellBetweenSpheresTheWidthIsThatToSecondOrder) {
    const ThinParts thin = thin_parts(subtract(ball_solid(1), ball_solid(0.9)), kEdge);
    ASSERT_GT(thin.edges, 100);
    // An edge off the radius sees feet up to its length apart: the sagitta between.
    EXPECT_NEAR(thin.width, 0.1, kEdge * kEdge / 2);
    EXPECT_NEAR(thin.place.norm(), 0.95, kEdge);
}

TEST(ThinParts, PrimitivesOfAFewEdgesHaveNone) {
    const Box4 box{Vector4d::Constant(-1.2), Vector4d::Constant(1.2)};
    for (const Solid& solid :
         {ball_solid(0.8), tiger_solid({0.8, 0.7}, 0.35), box_solid({1.2, 1, 0.8, 1.1}),
          polytope_solid(5, 1.3), polytope_solid(24, 0.9), duocylinder_solid({0.7, 0.7}),
          expression_solid("100 * (x^2 + y^2 + z^2 + 2 * w^2 - 1)", box)}) {
        EXPECT_EQ(thin_parts(solid, kEdge).edges, 0);
    }
}

TEST(ThinParts, AFunctionThatIsNoDistanceIsMeasuredByItsSlope) {
    const Box4 box{Vector4d::Constant(-0.6), Vector4d::Constant(0.6)};
    const Solid wall =
        expression_solid("100 * max(abs(x) - 0.04, max(max(abs(y), abs(z)), abs(w)) - 0.5)", box);
    const ThinParts thin = thin_parts(wall, kEdge);
    ASSERT_GT(thin.edges, 20);
    EXPECT_NEAR(thin.width, 0.08, 1e-9);
}

}  // namespace
}  // namespace pent::mesher
