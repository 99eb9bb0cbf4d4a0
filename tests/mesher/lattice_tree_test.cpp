#include "shapes/lattice_tree.h"

#include <pent/mesher/primitives.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace pent::mesher {
namespace {

using Eigen::Vector4d;

constexpr double kEdge = 0.25;
const Eigen::Matrix4d kUnturned = Eigen::Matrix4d::Identity();

// Sampled by what is left of the function at other points where that will do, and a formula of
// which nothing is known, and so sampled everywhere.
std::vector<Solid> solids() {
    const Box4 box{Vector4d::Constant(-1.2), Vector4d::Constant(1.2)};
    const Solid far = place(ball_solid(0.4), 1, kUnturned, {2.5, 0, 0, 0});
    return {ball_solid(1), unite(tiger_solid({0.8, 0.7}, 0.35), far, 0.1),
            subtract(duocylinder_solid({0.8, 0.6}), box_solid({0.7, 0.7, 0.7, 0.7})),
            expression_solid("x^2 + y^2 + z^2 + w^2 - 1", box)};
}

TEST(LatticeTree, KnowsTheFunctionWhereTheSurfaceIsNearAndItsSignElsewhere) {
    SizeField sizes;
    sizes.plane = {Vector4d::Unit(3), 0.1};
    sizes.growth = 1;
    sizes.longest = 2 * kEdge;
    for (const SizeField& field : {SizeField(), sizes}) {
        for (const Solid& solid : solids()) {
            const LatticeTree tree(solid, Lattice::with_mean_edge(kEdge), field);
            int near = 0;
            int corners = 0;
            for (std::uint32_t cell = 0; cell < tree.cell_count(); ++cell) {
                tree.visit_simplices(cell, [&](const std::array<std::uint32_t, 5>& simplex, bool) {
                    bool is_cut = false;
                    for (const std::uint32_t point : simplex) {
                        const double value = solid.value(tree.place(point));
                        EXPECT_EQ(tree.value(point) < 0, value < 0);
                        is_cut = is_cut || (value < 0) != (tree.value(simplex[0]) < 0);
                        ++corners;
                    }
                    for (const std::uint32_t point : simplex) {
                        if (is_cut) {
                            EXPECT_EQ(tree.value(point), solid.value(tree.place(point)));
                            ++near;
                        }
                    }
                });
            }
            EXPECT_GT(near, 500);
            EXPECT_GT(corners, near + 500);
        }
    }
}

TEST(LatticeTree, OnlyWhatChangesByNoMoreThanTheDistanceIsLipschitz) {
    for (const Solid& solid : solids()) {
        EXPECT_EQ(solid.is_lipschitz(),
                  std::isfinite(solid.values_within(Vector4d::Zero(), 0.1).high));
    }
}

}  // namespace
}  // namespace pent::mesher
