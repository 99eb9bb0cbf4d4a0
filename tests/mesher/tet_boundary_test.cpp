#include "shapes/tet_boundary.h"

#include <pent/exchange/tet_surface.h>
#include <pent/mesher/boundary_solid.h>
#include <pent/mesher/primitives.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/stuff.h>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace pent::mesher {
namespace {

using Eigen::Vector4d;
using exchange::TetSurface;

TetSurface tesseract_at(double place) {
    SimplexMesh<4> mesh = box<4>({1, 1, 1, 1}, {1, 1, 1, 1}, CubeCut::Paths);
    mesh.positions.array() += place;
    return exchange::boundary_of(mesh);
}

// Two tesseracts that cross: parts of their tetrahedra are within the body.
TetSurface crossing() {
    const TetSurface a = tesseract_at(-0.6);
    const TetSurface b = tesseract_at(-0.37);
    TetSurface both{Positions<4>(4, 2 * a.points.cols()), Simplices<4>(4, 2 * a.tetrahedra.cols())};
    both.points << a.points, b.points;
    both.tetrahedra << a.tetrahedra,
        (b.tetrahedra.array() + static_cast<std::uint32_t>(a.points.cols())).matrix();
    return both;
}

std::vector<TetSurface> surfaces() {
    return {tesseract_at(-0.5), crossing(),
            exchange::boundary_of(stuff(tiger_solid({0.8, 0.7}, 0.35), 0.3).mesh)};
}

constexpr double kFar = std::numeric_limits<double>::infinity();

Vector4d random_point(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    return Vector4d(uniform(random), uniform(random), uniform(random), uniform(random));
}

TEST(TetBoundary, IsFirstCrossedWhereWhatIsOutsideEnds) {
    std::mt19937 random(1);
    for (const TetSurface& surface : surfaces()) {
        const TetBoundary boundary(surface);
        int found = 0;
        for (int i = 0; i < 3000; ++i) {
            const Vector4d from = random_point(random, 1.2);
            const Vector4d to = random_point(random, 1);
            if (boundary.winding_number(from) != 0 || boundary.winding_number(to) == 0) {
                continue;
            }
            const auto part = boundary.first_crossing(from, to);
            ASSERT_TRUE(part.has_value());
            ++found;
            EXPECT_LT(boundary.distance(from + *part * (to - from)), 1e-12);
            for (int k = 0; k < 20; ++k) {
                const double before = *part * k / 20;
                EXPECT_EQ(boundary.winding_number(from + before * (to - from)), 0);
            }
            EXPECT_NE(boundary.winding_number(from + (*part + 1e-9) * (to - from)), 0);
        }
        EXPECT_GT(found, 50);
    }
}

// What is known near by says which side a point is on only where it is so.
TEST(TetBoundary, HasTheSameValueWhateverIsKnownNearBy) {
    std::mt19937 random(2);
    for (const TetSurface& surface : surfaces()) {
        const TetBoundary boundary(surface);
        for (int i = 0; i < 500; ++i) {
            const Vector4d p = random_point(random, 1);
            std::vector<Sample> known;
            for (int k = 0; k < 6; ++k) {
                const Vector4d near = p + random_point(random, 0.15);
                known.push_back({near, boundary.value(near)});
            }
            const double value = boundary.value(p);
            EXPECT_EQ(boundary.value_near(p, kFar, known), value);
            // No more than was asked for, and then known as no more than that.
            EXPECT_EQ(boundary.value_near(p, 0.1, known), std::clamp(value, -0.1, 0.1));
            for (Sample& sample : known) {
                sample.value = std::clamp(sample.value, -0.1, 0.1);
            }
            EXPECT_EQ(boundary.value_near(p, kFar, known), value);
        }
    }
}

TEST(TetBoundary, IsAtItsFootAsFarAwayAsItsDistance) {
    std::mt19937 random(3);
    const Eigen::Matrix4d turn = Eigen::HouseholderQR<Eigen::Matrix4d>(
                                     Eigen::Matrix4d::Identity() + 0.3 * Eigen::Matrix4d::Ones())
                                     .householderQ();
    for (const TetSurface& surface : surfaces()) {
        const TetBoundary boundary(surface);
        const Solid solid =
            place(boundary_solid(surface, "surface").solid, 1.7, turn, {0.1, 0.2, -0.1, 0});
        for (int i = 0; i < 200; ++i) {
            const Vector4d p = random_point(random, 1.2);
            EXPECT_EQ(boundary.distance(p), std::abs(boundary.value(p)));
            EXPECT_NEAR((boundary.foot(p) - p).norm(), boundary.distance(p), 1e-14);
            EXPECT_LT(boundary.distance(boundary.foot(p)), 1e-14);
            const double value = solid.value(p);
            EXPECT_EQ(solid.is_inside(p), value < 0);
            EXPECT_TRUE(solid.is_near_surface(p, std::abs(value) + 1e-13));
            EXPECT_FALSE(solid.is_near_surface(p, std::abs(value) - 1e-13));
            const double distance = boundary.distance(p);
            EXPECT_EQ(boundary.distance(p, distance * (1 - 1e-12)), kFar);
            EXPECT_EQ(boundary.distance(p, distance * (1 + 1e-12)), distance);
            const ValueRange range = boundary.range(p, 0.2);
            for (int k = 0; k < 10; ++k) {
                const double near = boundary.value(p + 0.2 * random_point(random, 1).normalized());
                EXPECT_LE(range.low, near);
                EXPECT_GE(range.high, near);
            }
            for (int piece = 0; piece < boundary.patch_count(); ++piece) {
                const Vector4d foot = *solid.piece_foot(piece, p);
                EXPECT_NEAR(solid.piece_value(piece, foot), 0, 1e-13);
                EXPECT_GE((foot - p).norm(), std::abs(value) - 1e-13);
            }
            EXPECT_NEAR((*solid.foot(p) - p).norm(), std::abs(value), 1e-14);
            EXPECT_NEAR(solid.value_near(p, kFar, {}), value, 1e-14);
            const Vector4d slope = solid.value_slope(p, 1e-6).slope;
            EXPECT_LT((solid.slope({p, value}, 1e-6) - slope).norm(), 1e-11);
        }
    }
    const Solid ball = ball_solid(1);
    EXPECT_FALSE(ball.foot(Vector4d::Zero()).has_value());
    EXPECT_FALSE(ball.first_crossing(Vector4d::Unit(0) * 2, Vector4d::Zero()).has_value());
}

}  // namespace
}  // namespace pent::mesher
