#include "moving_shapes.h"
#include "spacetime/time_layers.h"
#include "support/messages.h"

#include <pent/error.h>
#include <pent/facets.h>
#include <pent/mesher/links.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/space_time.h>
#include <pent/mesher/straight_layers.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

namespace pent::mesher {
namespace {

using test::moving;

std::vector<double> steps(int count, double end) {
    std::vector<double> times;
    for (int i = 0; i <= count; ++i) {
        times.push_back(end * i / count);
    }
    return times;
}

// Swells, and moves along a curve.
Eigen::Vector3d breathe(const Eigen::Vector3d& x, double t) {
    return (1 + 0.3 * std::sin(2 * t)) * x + Eigen::Vector3d(t, t * t, std::sin(t));
}

// Turns and twists as it swells.
Eigen::Vector3d twist(const Eigen::Vector3d& x, double t) {
    const Eigen::AngleAxisd turn(t * (0.5 + 0.4 * x.z()), Eigen::Vector3d::UnitZ());
    return (1 + 0.2 * std::sin(3 * t)) * (turn * x) + Eigen::Vector3d(0, 0, 0.1 * t * x.x());
}

TEST(SpaceTime, HasTheIntegralOfTheVolumeAsHypervolumeWhereTheSidesAreFlat) {
    // Scaled and moved, sides sweep flat facets: r is linear between frames, so that r^3 has an
    // exact integral by Simpson's rule.
    const SimplexMesh<3> base = ball(3);
    const MovingMesh mesh = moving(base, {0, 0.3, 0.7, 1.5}, breathe);
    const SpaceTimeBody body = make_space_time(mesh, {.time_scale = 2});
    double expected = 0;
    for (std::size_t i = 0; i + 1 < mesh.times.size(); ++i) {
        const double r0 = 1 + 0.3 * std::sin(2 * mesh.times[i]);
        const double r1 = 1 + 0.3 * std::sin(2 * mesh.times[i + 1]);
        const double middle = (r0 + r1) / 2;
        expected += 2 * (mesh.times[i + 1] - mesh.times[i]) * total_volume(base)
                    * (r0 * r0 * r0 + 4 * middle * middle * middle + r1 * r1 * r1) / 6;
    }
    EXPECT_TRUE(body.proof.holds());
    // Sums of 2160 pentachora, each to some 10 eps of the whole at worst.
    EXPECT_NEAR(body.proof.volume, expected, 1e-13 * expected);
    EXPECT_NEAR(body.integral, expected, 1e-13 * expected);
    EXPECT_EQ(body.mesh.cell_count(), base.cell_count() * 4 * 3);
}

TEST(SpaceTime, HasAConstantSectionForWhatOnlyMovesHoweverFarAndFast) {
    const SimplexMesh<3> base = test::centered_box(2, 2);
    const auto fly = [](const Eigen::Vector3d& x, double t) -> Eigen::Vector3d {
        return x + Eigen::Vector3d(1e3 * t, -50 * t * t, 0);
    };
    const SpaceTimeBody body = make_space_time(moving(base, steps(3, 1), fly));
    EXPECT_TRUE(body.proof.holds());
    EXPECT_NEAR(body.proof.volume, 8, 1e-10);  // coordinates to 1e3, rounded to 1e-13
}

TEST(SpaceTime, HasTheIntegralAsTheMeanOverAllOrdersOfTheVertices) {
    // Where triangles of the surface turn, the cut of the sides decides: of each triangle all six
    // orders come up equally often among those of all vertices.
    SimplexMesh<3> base;
    base.positions.resize(3, 5);
    base.positions << 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 1, 1;
    base.cells.resize(4, 2);
    base.cells << 0, 1, 1, 2, 2, 3, 3, 4;
    if (cell_volume<3>(base.positions, base.cells, 1) < 0) {
        std::swap(base.cells(2, 1), base.cells(3, 1));
    }
    std::mt19937 random(11);
    std::uniform_real_distribution<double> shift(-0.2, 0.2);
    const Positions<3> moved =
        base.positions + Positions<3>::NullaryExpr(3, 5, [&] { return shift(random); });
    std::array<std::uint32_t, 5> names{};
    std::iota(names.begin(), names.end(), 0U);
    double sum = 0;
    double integral = 0;
    double lowest = 1e300;
    double highest = 0;
    do {
        SimplexMesh<3> renamed = base;
        Positions<3> target = moved;
        for (std::uint32_t v = 0; v < 5; ++v) {
            renamed.positions.col(names[v]) = base.positions.col(v);
            target.col(names[v]) = moved.col(v);
        }
        for (std::uint32_t& corner : renamed.cells.reshaped()) {
            corner = names[corner];
        }
        MovingMesh mesh = moving(renamed, {0, 1}, [](const auto& x, double) { return x; });
        mesh.positions[1] = target;
        const SpaceTimeBody body = make_space_time(mesh, {.alternate = false});
        sum += body.proof.volume;
        integral = body.integral;
        lowest = std::min(lowest, body.proof.volume);
        highest = std::max(highest, body.proof.volume);
    } while (std::next_permutation(names.begin(), names.end()));
    EXPECT_NEAR(sum / 120, integral, 1e-15);
    EXPECT_GT(highest - lowest, 1e-3) << "the orders do differ";
}

TEST(SpaceTime, MeetsTheIntegralAtSecondOrderInTheSteps) {
    const auto difference = [](int count) {
        const SpaceTimeBody body =
            make_space_time(moving(test::centered_box(3, 1), steps(count, 0.8), twist));
        EXPECT_TRUE(body.proof.holds());
        return std::abs(body.proof.volume - body.integral);
    };
    // With alternating orders the first order cancels from layer to layer.
    EXPECT_GT(difference(8) / difference(16), 3.0);
    EXPECT_GT(difference(16) / difference(32), 3.0);
}

// The tetrahedra in which a body is cut at the w of one of its layers are those of the frame.
TEST(SpaceTime, IsTheMeshOfEachFrameInTheSliceAtItsTime) {
    const MovingMesh mesh = moving(ball(2), steps(4, 1), twist);
    const SpaceTimeBody body = make_space_time(mesh, {.time_scale = 3, .refine_time = 2});
    ASSERT_EQ(body.frame_layers, (std::vector<std::uint32_t>{0, 2, 4, 6, 8}));
    for (std::size_t frame = 0; frame < 5; ++frame) {
        const std::uint32_t layer = body.frame_layers[frame];
        // Facets with all vertices in the layer, by their columns.
        std::set<std::array<std::uint32_t, 4>> found;
        for (const auto& cell : body.mesh.cells.colwise()) {
            std::vector<std::uint32_t> in_layer;
            for (const std::uint32_t v : cell) {
                if (body.mesh.layers[v] == layer) {
                    EXPECT_EQ(body.mesh.positions(3, v), 3 * mesh.times[frame]);
                    EXPECT_EQ(body.mesh.positions.col(v).head<3>(),
                              mesh.positions[frame].col(body.mesh.columns[v]));
                    in_layer.push_back(body.mesh.columns[v]);
                }
            }
            if (in_layer.size() == 4) {
                std::sort(in_layer.begin(), in_layer.end());
                found.insert({in_layer[0], in_layer[1], in_layer[2], in_layer[3]});
            }
        }
        std::set<std::array<std::uint32_t, 4>> expected;
        for (const auto& tet : mesh.base.cells.colwise()) {
            std::array<std::uint32_t, 4> corners{tet[0], tet[1], tet[2], tet[3]};
            std::sort(corners.begin(), corners.end());
            expected.insert(corners);
        }
        EXPECT_EQ(found, expected) << frame;
    }
}

TEST(SpaceTime, IsAProvedBodyWithAManifoldBoundary) {
    const SpaceTimeBody body = make_space_time(moving(ball(2), steps(5, 1), twist));
    EXPECT_TRUE(body.proof.holds());
    EXPECT_EQ(check_links<4>(body.mesh).faulty, 0);
}

TEST(SpaceTime, KnowsHowHighItsLayersAre) {
    const auto still = [](const Eigen::Vector3d& x, double) { return x; };
    const MovingMesh mesh = moving(ball(1), {0, 1, 1.25, 4}, still);
    for (const int parts : {1, 2}) {
        const SpaceTimeBody body = make_space_time(mesh, {.time_scale = 2, .refine_time = parts});
        EXPECT_EQ(body.lowest_layer, 0.5 / parts);
        EXPECT_EQ(body.highest_layer, 5.5 / parts);
        for (std::uint32_t frame = 0; frame < 4; ++frame) {
            EXPECT_EQ(body.frame_layers[frame], frame * static_cast<std::uint32_t>(parts));
        }
    }
}

// The order is chosen for a body at rest with layers of 0.7 edges, cut alike.
TEST(SpaceTime, HasBetterCellsInAnOrderForQuality) {
    const auto still = [](const Eigen::Vector3d& x, double) { return x; };
    SimplexMesh<3> base = test::centered_box(2, 2);
    std::mt19937 random(8);
    std::vector<std::uint32_t> names(static_cast<std::size_t>(base.vertex_count()));
    std::iota(names.begin(), names.end(), 0U);
    std::shuffle(names.begin(), names.end(), random);
    std::uniform_real_distribution<double> shift(-0.1, 0.1);
    for (Eigen::Index v = 0; v < base.vertex_count(); ++v) {
        base.positions.col(names[static_cast<std::size_t>(v)]) =
            test::centered_box(2, 2).positions.col(v)
            + Eigen::Vector3d(shift(random), shift(random), shift(random));
    }
    base.cells = base.cells.unaryExpr([&](std::uint32_t v) { return names[v]; }).eval();
    const MovingMesh mesh = moving(base, {0, 0.7 * mean_edge<3>(base)}, still);
    const auto worst = [&](VertexOrder order) {
        return make_space_time(mesh, {.order = order}).quality.mean_ratio.min;
    };
    EXPECT_GT(worst(VertexOrder::Quality), worst(VertexOrder::Index));
}

TEST(SpaceTime, RefusesScalesAndStepsOutOfRange) {
    const MovingMesh mesh =
        moving(test::centered_box(1, 1), {0, 1}, [](const auto& x, double) { return x; });
    for (const double scale : {0.0, -1.0, std::nan("")}) {
        test::expect_contains(test::error_of([&] {
                                  static_cast<void>(make_space_time(mesh, {.time_scale = scale}));
                              }),
                              {"a time scale of"});
    }
    test::expect_contains(
        test::error_of([&] { static_cast<void>(make_space_time(mesh, {.refine_time = -1})); }),
        {"-1 layers"});
}

}  // namespace
}  // namespace pent::mesher
