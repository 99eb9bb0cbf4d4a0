#include "shapes.h"

#include <pent/error.h>
#include <pent/mesher/orient.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace pent::mesher {
namespace {

void turn_over(Surface& surface, Eigen::Index triangle) {
    std::swap(surface.triangles(1, triangle), surface.triangles(2, triangle));
}

TEST(Orient, TurnsAnySelectionOfTrianglesOutward) {
    const Surface box = test::box_surface({0, 0, 0}, {1, 1, 1});
    std::mt19937 random(1);
    for (int round = 0; round < 50; ++round) {
        Surface mixed = box;
        std::int64_t turned = 0;
        for (Eigen::Index t = 0; t < mixed.triangle_count(); ++t) {
            if (random() % 2 == 0) {
                turn_over(mixed, t);
                ++turned;
            }
        }
        const Oriented oriented = orient(mixed);
        EXPECT_EQ(oriented.flipped_triangles, turned);
        EXPECT_EQ(enclosed_volume(oriented.surface), 1.0);
    }
}

TEST(Orient, MakesNestedComponentsCavitiesAndBodiesInTurn) {
    const Surface outer = test::box_surface({0, 0, 0}, {10, 10, 10});
    const Surface middle = test::box_surface({1, 1, 1}, {9, 9, 9});
    const Surface inner = test::box_surface({2, 2, 2}, {3, 3, 3});
    for (const Surface& all : {test::join(test::join(outer, middle), inner),
                               test::join(test::join(inner, middle), outer)}) {
        const Oriented oriented = orient(all);
        EXPECT_EQ(oriented.components, 3);
        EXPECT_EQ(oriented.cavities, 1);
        EXPECT_EQ(oriented.flipped_triangles, 12);
        EXPECT_NEAR(enclosed_volume(oriented.surface), 1000 - 512 + 1, 1e-10);  // rounding only
    }
}

// A box in the box around an octahedron, but beside it.
TEST(Orient, KnowsBesideFromInside) {
    Surface octahedron;
    octahedron.points.resize(3, 6);
    octahedron.points << Eigen::Matrix3d::Identity(), -Eigen::Matrix3d::Identity();
    octahedron.triangles.resize(3, 8);
    octahedron.triangles << 0, 1, 3, 4, 1, 3, 4, 0,  //
        1, 3, 4, 0, 0, 1, 3, 4,                      //
        2, 2, 2, 2, 5, 5, 5, 5;
    const Surface beside = test::box_surface({0.7, 0.7, 0.7}, {0.8, 0.8, 0.8});
    EXPECT_EQ(orient(test::join(octahedron, beside)).cavities, 0);
    const Surface inside = test::box_surface({0.1, 0.1, 0.1}, {0.2, 0.2, 0.2});
    EXPECT_EQ(orient(test::join(octahedron, inside)).cavities, 1);
}

TEST(Orient, RefusesASurfaceWithOneSide) {
    // The projective plane with six points: an icosahedron with opposite points made one.
    Surface surface;
    surface.points.setRandom(3, 6);
    surface.triangles.resize(3, 10);
    surface.triangles << 0, 0, 0, 0, 0, 1, 2, 3, 4, 5,  //
        1, 2, 3, 4, 5, 2, 3, 4, 5, 1,                   //
        2, 3, 4, 5, 1, 4, 5, 1, 2, 3;
    EXPECT_THROW(static_cast<void>(orient(surface)), Error);
}

TEST(Orient, RefusesOpenAndFlatSurfaces) {
    Surface open = test::box_surface({0, 0, 0}, {1, 1, 1});
    open.triangles = open.triangles.leftCols<11>().eval();
    EXPECT_THROW(static_cast<void>(orient(open)), Error);
    EXPECT_THROW(static_cast<void>(orient(test::box_surface({0, 0, 0}, {1, 1, 0}))), Error);
}

// How often a surface winds around a point, by the solid angle of each triangle [vanoosterom1983].
double winding_number(const Surface& surface, const Eigen::Vector3d& point) {
    double half_angles = 0;
    for (const auto& t : surface.triangles.colwise()) {
        const Eigen::Vector3d a = surface.points.col(t[0]) - point;
        const Eigen::Vector3d b = surface.points.col(t[1]) - point;
        const Eigen::Vector3d c = surface.points.col(t[2]) - point;
        half_angles +=
            std::atan2(a.cross(b).dot(c), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm()
                                              + b.dot(c) * a.norm() + c.dot(a) * b.norm());
    }
    return half_angles / (2 * std::numbers::pi);
}

// Shells in shells, in each place that a random walk of boxes finds, turned at random.
TEST(Orient, WindsOnceAroundTheBodyAndNeverAroundAnythingElse) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int round = 0; round < 20; ++round) {
        std::vector<Eigen::Vector3d> probes;
        Surface all;
        const std::function<void(const Eigen::Vector3d&, double, int)> fill =
            [&](const Eigen::Vector3d& low, double size, int depth) {
                Surface box = test::box_surface(low, low.array() + size);
                if (random() % 2 == 0) {
                    box.triangles.row(1).swap(box.triangles.row(2));
                }
                all = all.triangle_count() == 0 ? box : test::join(all, box);
                probes.push_back(low.array() + 0.02 * size);
                for (int place = 0; place < 8 && depth < 3; ++place) {
                    if (random() % 3 == 0) {
                        const Eigen::Vector3d corner(place & 1, place >> 1 & 1, place >> 2);
                        fill(low + size * (0.05 + 0.5 * corner.array()).matrix(),
                             (0.3 + 0.1 * unit(random)) * size, depth + 1);
                    }
                }
            };
        fill({0, 0, 0}, 1, 0);
        fill({2, 0, 0}, 1, 0);
        const Oriented oriented = orient(all);
        EXPECT_EQ(oriented.components, static_cast<std::int64_t>(probes.size()));
        std::int64_t cavities = 0;
        for (std::size_t i = 0; i < probes.size(); ++i) {
            // Just inside of each shell it is 1 but where the shell bounds a cavity.
            const double winding = winding_number(oriented.surface, probes[i]);
            EXPECT_LT(std::min(std::abs(winding), std::abs(winding - 1)), 1e-9);
            cavities += winding < 0.5 ? 1 : 0;
        }
        EXPECT_EQ(oriented.cavities, cavities);
    }
}

}  // namespace
}  // namespace pent::mesher
