#include "polytopes.h"

#include <pent/error.h>
#include <pent/facets.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>

namespace pent::exchange {
namespace {

using test::five_cell;
using test::sixteen_cell;
using test::taken_apart;
using test::with_unused_points;

TEST(TetSurface, OfAPolytopeIsClosedAndEnclosesItsHypervolume) {
    EXPECT_TRUE(check(five_cell()).is_oriented());
    EXPECT_NEAR(enclosed_hypervolume(five_cell()), 1.0 / 24, 1e-15);
    EXPECT_TRUE(check(sixteen_cell()).is_oriented());
    EXPECT_NEAR(enclosed_hypervolume(sixteen_cell()), 2.0 / 3, 1e-14);
}

TEST(TetSurface, KnowsWhereItIsOpenOrHasTooMuch) {
    TetSurface open = sixteen_cell();
    open.tetrahedra.conservativeResize(4, 15);
    EXPECT_EQ(check(open).open, 4);
    EXPECT_FALSE(check(open).is_closed());
    TetSurface twice = sixteen_cell();
    twice.tetrahedra.conservativeResize(4, 17);
    twice.tetrahedra.col(16) = twice.tetrahedra.col(0);
    EXPECT_EQ(check(twice).overfull, 4);
    TetSurface turned = sixteen_cell();
    std::swap(turned.tetrahedra(0, 3), turned.tetrahedra(1, 3));
    EXPECT_EQ(check(turned).one_sided, 4);
    EXPECT_TRUE(check(turned).is_closed());
    EXPECT_FALSE(check(turned).is_oriented());
}

TEST(Weld, GivesTetrahedraAtTheSamePlacesTheSamePoints) {
    const TetSurface apart = taken_apart(sixteen_cell());
    EXPECT_EQ(check(apart).open, 16 * 4);
    const WeldedSurface welded = weld(apart);
    EXPECT_EQ(welded.merged_points, 16 * 4 - 8);
    EXPECT_EQ(welded.degenerate, 0);
    ASSERT_EQ(welded.surface.points.cols(), 8);
    Eigen::Index next = 0;  // the first point at each place stays, in the order that they have
    for (Eigen::Index p = 0; p < apart.points.cols(); ++p) {
        bool is_first = true;
        for (Eigen::Index before = 0; before < p; ++before) {
            is_first = is_first && apart.points.col(before) != apart.points.col(p);
        }
        if (is_first) {
            EXPECT_EQ(welded.surface.points.col(next++), apart.points.col(p));
        }
    }
    EXPECT_TRUE(check(welded.surface).is_oriented());
    EXPECT_NEAR(enclosed_hypervolume(welded.surface), 2.0 / 3, 1e-14);
}

TEST(Weld, LeavesOutTetrahedraWithACornerTwiceAndTheirPoints) {
    TetSurface surface = with_unused_points(sixteen_cell());
    surface.tetrahedra.conservativeResize(4, 17);
    surface.tetrahedra.col(16) << 0, 9, 1, 2;  // two points at one place, which no other one has
    const WeldedSurface welded = weld(surface);
    EXPECT_EQ(welded.merged_points, 1);
    EXPECT_EQ(welded.degenerate, 1);
    EXPECT_EQ(welded.surface.points, sixteen_cell().points);
    EXPECT_EQ(welded.surface.tetrahedra, sixteen_cell().tetrahedra);
}

TEST(Weld, LeavesWhatIsWeldedAsItIs) {
    const WeldedSurface welded = weld(sixteen_cell());
    EXPECT_EQ(welded.merged_points, 0);
    EXPECT_EQ(welded.surface.points, sixteen_cell().points);
    EXPECT_EQ(welded.surface.tetrahedra, sixteen_cell().tetrahedra);
}

// Whichever of its tetrahedra are turned over, whether all of it is inside out, and wherever it is:
// far away each tetrahedron spans so much more with the origin that nothing of the body is left.
TEST(Orient, MakesTheSameOutsideOfAnyMix) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 20; ++trial) {
        TetSurface mixed = sixteen_cell();
        mixed.points.colwise() += trial % 3 * Eigen::Vector4d(1e9, -3e9, 2e9, 5e8);
        for (Eigen::Index t = 0; t < 16; ++t) {
            if (trial == 0 || random() % 2 == 0) {
                std::swap(mixed.tetrahedra(0, t), mixed.tetrahedra(1, t));
            }
        }
        orient(mixed, "mixed");
        EXPECT_TRUE(check(mixed).is_oriented());
        EXPECT_NEAR(enclosed_hypervolume(mixed), 2.0 / 3, 1e-14);
    }
}

// A hollow body whose file is right stays hollow.
TEST(Orient, LeavesACavityWhereNeighborsAgree) {
    TetSurface hollow = sixteen_cell();
    TetSurface hole = sixteen_cell();
    hollow.points.conservativeResize(4, 16);
    hollow.points.rightCols(8) = 0.5 * hole.points;
    hollow.tetrahedra.conservativeResize(4, 32);
    for (Eigen::Index t = 0; t < 16; ++t) {
        std::swap(hole.tetrahedra(0, t), hole.tetrahedra(1, t));
        hollow.tetrahedra.col(16 + t) = hole.tetrahedra.col(t).array() + 8;
    }
    const double expected = 2.0 / 3 * (1 - 1.0 / 16);
    orient(hollow, "hollow");
    EXPECT_NEAR(enclosed_hypervolume(hollow), expected, 1e-14);
    for (Eigen::Index t = 0; t < 32; ++t) {
        std::swap(hollow.tetrahedra(0, t), hollow.tetrahedra(1, t));
    }
    orient(hollow, "hollow");
    EXPECT_NEAR(enclosed_hypervolume(hollow), expected, 1e-14);
}

// Two tetrahedra with the same corners, which enclose nothing: only neighbors can disagree.
TEST(Orient, LeavesWhatEnclosesNothingAsItIs) {
    TetSurface pillow{five_cell().points, Simplices<4>(4, 2)};
    pillow.tetrahedra << 1, 1, 2, 2, 3, 4, 4, 3;
    ASSERT_TRUE(check(pillow).is_oriented());
    for (const bool is_turned : {false, true}) {
        TetSurface after = pillow;
        if (is_turned) {
            std::swap(after.tetrahedra(2, 1), after.tetrahedra(3, 1));
        }
        orient(after, "pillow");
        EXPECT_EQ(after.tetrahedra, pillow.tetrahedra);
    }
}

// It has no inside to turn it by.
TEST(Orient, LeavesWhatIsOpenAsItIs) {
    TetSurface open = sixteen_cell();
    open.tetrahedra.conservativeResize(4, 15);
    open.tetrahedra.row(0).swap(open.tetrahedra.row(1));  // inside out
    TetSurface one_turned = open;
    std::swap(one_turned.tetrahedra(0, 3), one_turned.tetrahedra(1, 3));
    for (const TetSurface& surface : {open, one_turned}) {
        TetSurface after = surface;
        orient(after, "open");
        EXPECT_EQ(after.tetrahedra, surface.tetrahedra);
    }
}

// Two tips over the projective plane of six points: closed, and its two sides are one.
TEST(Orient, RefusesASurfaceWithOneSide) {
    constexpr std::array<std::array<std::uint32_t, 3>, 10> kPlane = {{{0, 1, 2},
                                                                      {0, 2, 3},
                                                                      {0, 3, 4},
                                                                      {0, 4, 5},
                                                                      {0, 1, 5},
                                                                      {1, 2, 4},
                                                                      {2, 3, 5},
                                                                      {1, 3, 4},
                                                                      {2, 4, 5},
                                                                      {1, 3, 5}}};
    TetSurface surface{Positions<4>::Random(4, 8), Simplices<4>(4, 20)};
    for (Eigen::Index t = 0; t < 20; ++t) {
        const auto& [a, b, c] = kPlane[static_cast<std::size_t>(t / 2)];
        surface.tetrahedra.col(t) << a, b, c, static_cast<std::uint32_t>(6 + t % 2);
    }
    ASSERT_TRUE(check(surface).is_closed());
    pent::test::expect_contains(pent::test::error_of([&] { orient(surface, "bottle"); }),
                                {"bottle: ", "one side only"});
}

TEST(ConeOf, IsTheBodyWithThatBoundary) {
    for (const TetSurface& surface : {five_cell(), sixteen_cell()}) {
        const SimplexMesh<4> mesh = cone_of(surface, "body");
        EXPECT_NO_THROW(validate<4>(mesh, "body"));
        EXPECT_NEAR(total_volume(mesh), enclosed_hypervolume(surface), 1e-14);
        const TetSurface back = boundary_of(mesh);
        EXPECT_EQ(back.points, surface.points);
        EXPECT_TRUE(check(back).is_oriented());
        EXPECT_NEAR(enclosed_hypervolume(back), enclosed_hypervolume(surface), 1e-14);
    }
}

// The largest ball inside of the 5-cell touches four planes x = 0 and the plane x + y + z + w = 1:
// (1 - 4 r) / 2 = r. Depths are tried that grow by half, so that the middle has two thirds of it.
TEST(ConeOf, HasItsMiddleDeepInside) {
    for (const double shift : {0.0, -0.5, 100.0, 1e9}) {  // -0.5: as far to either side of 0
        TetSurface cell = five_cell();
        cell.points.array() += shift;
        const Eigen::Vector4d middle =
            cone_of(cell, "5-cell").positions.col(5) - Eigen::Vector4d::Constant(shift);
        EXPECT_GT(std::min(middle.minCoeff(), (1 - middle.sum()) / 2), 2.0 / 3 / 6);
    }
}

// A dart: one corner of the 16-cell is pushed in beyond the middle, so that only points behind it
// see everything, and the mean of all corners is not one of them. In any place and at any size:
// powers of two change no digit.
TEST(ConeOf, FindsThePointThatSeesAllOfAStar) {
    TetSurface dart = sixteen_cell();
    dart.points.col(0) *= -0.5;
    SimplexMesh<4> around_mean = cone_of(sixteen_cell(), "16-cell");
    around_mean.positions << dart.points, dart.points.rowwise().mean();
    ASSERT_THROW(validate<4>(around_mean, "mean"), Error);
    const SimplexMesh<4> mesh = cone_of(dart, "dart");
    for (const double scale : {0x1p-20, 0x1p20}) {
        EXPECT_EQ(cone_of({scale * dart.points, dart.tetrahedra}, "dart").positions,
                  scale * mesh.positions);
    }
    dart.points.colwise() += Eigen::Vector4d(100, -3, 2, 50);
    for (const SimplexMesh<4>& one : {mesh, cone_of(dart, "dart")}) {
        EXPECT_NO_THROW(validate<4>(one, "dart"));
        EXPECT_NEAR(total_volume(one), enclosed_hypervolume(dart), 1e-9 * total_volume(one));
    }
}

TEST(ConeOf, RefusesWhatNoPointSeesAllOfOrIsOpen) {
    TetSurface two = sixteen_cell();  // two 16-cells far apart
    const TetSurface other = sixteen_cell();
    two.points.conservativeResize(4, 16);
    two.points.rightCols(8) = other.points.array() + 10;
    two.tetrahedra.conservativeResize(4, 32);
    two.tetrahedra.rightCols(16) = other.tetrahedra.array() + 8;
    pent::test::expect_contains(
        pent::test::error_of([&] { static_cast<void>(cone_of(two, "two")); }),
        {"two: ", "no point was found that sees all"});
    TetSurface open = sixteen_cell();
    open.tetrahedra.conservativeResize(4, 15);
    pent::test::expect_contains(
        pent::test::error_of([&] { static_cast<void>(cone_of(open, "open")); }),
        {"open: is no closed surface: 4 triangles"});
    TetSurface twice = sixteen_cell();
    twice.tetrahedra.conservativeResize(4, 17);
    twice.tetrahedra.col(16) = twice.tetrahedra.col(0);
    TetSurface turned = sixteen_cell();
    std::swap(turned.tetrahedra(0, 3), turned.tetrahedra(1, 3));
    for (const TetSurface& surface : {twice, turned}) {
        pent::test::expect_contains(
            pent::test::error_of([&] { static_cast<void>(cone_of(surface, "it")); }),
            {"it: is no closed surface: 4 triangles"});
    }
}

}  // namespace
}  // namespace pent::exchange
