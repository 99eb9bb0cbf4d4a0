#include "shapes.h"

#include <pent/error.h>
#include <pent/mesher/orient.h>

#include <gtest/gtest.h>

#include <random>

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

TEST(WindingNumber, IsOneInsideAndZeroOutside) {
    const Surface box = test::box_surface({0, 0, 0}, {1, 1, 1});
    // Twelve arcs are added; each is exact to a few units in the last place.
    EXPECT_NEAR(winding_number(box, {0.5, 0.25, 0.125}), 1, 1e-14);
    EXPECT_NEAR(winding_number(box, {0.5, 0.25, 1 + 1e-9}), 0, 1e-6);
    EXPECT_NEAR(winding_number(box, {0.5, 0.25, 1 - 1e-9}), 1, 1e-6);
    EXPECT_NEAR(winding_number(box, {50, -3, 2}), 0, 1e-14);
}

}  // namespace
}  // namespace pent::mesher
