#include "repair_steps.h"
#include "shapes.h"
#include "support/messages.h"

#include <pent/mesher/orient.h>
#include <pent/mesher/repair.h>
#include <pent/mesher/shapes.h>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace pent::mesher {
namespace {

Surface model(const std::string& name) {
    return read_surface(std::string(PENT_MODELS) + "/" + name).surface;
}

std::string message_for(const Surface& surface, Repair level) {
    return test::error_of(
        [&] { static_cast<void>(repair(surface, RepairOptions{.repair = level})); });
}

TEST(Repair, LeavesACleanSurfaceAsItIs) {
    const Surface octopus = model("octopus_5246f.obj");
    for (const Repair level : {Repair::Auto, Repair::Light, Repair::None}) {
        const Repaired repaired = repair(octopus, {.repair = level});
        EXPECT_EQ(repaired.used, Repair::None);
        EXPECT_EQ(repaired.surface.points, octopus.points);
        EXPECT_EQ(repaired.surface.triangles, octopus.triangles);
        EXPECT_EQ(repaired.distance, 0);
        EXPECT_EQ(repaired.before.triangles, octopus.triangle_count());
        EXPECT_EQ(repaired.after.triangles, octopus.triangle_count());
    }
}

TEST(Repair, LeavesATetrahedronAsItIs) {
    Surface tetrahedron;
    tetrahedron.points = Positions<3>::Identity(3, 4);
    tetrahedron.triangles.resize(3, 4);
    tetrahedron.triangles << 0, 0, 0, 1, 1, 3, 2, 3, 2, 1, 3, 2;
    const Repaired repaired = repair(tetrahedron, {.repair = Repair::None});
    EXPECT_EQ(repaired.surface.triangles, tetrahedron.triangles);
    EXPECT_NEAR(std::abs(enclosed_volume(repaired.surface)), 1.0 / 6, 1e-16);
}

// Lines there and back, between four corners that are not in a plane.
TEST(Repair, RefusesTrianglesWithoutAnArea) {
    Surface lines;
    lines.points = Positions<3>::Identity(3, 4);
    lines.triangles.resize(3, 3);
    lines.triangles << 0, 2, 0, 1, 3, 2, 0, 2, 2;
    for (const Repair level : {Repair::Auto, Repair::Light, Repair::Wrap}) {
        EXPECT_EQ(message_for(lines, level),
                  "no triangle of the surface has an area; it encloses no volume");
    }
    test::expect_contains(message_for(lines, Repair::None), {"3 degenerate triangles"});
}

TEST(Repair, MendsCubesLightlyToTheCubesTheyWere) {
    for (const char* name : {"dirty/d_open.off", "dirty/d_dupface.off", "dirty/d_degenerate.off"}) {
        const Repaired repaired = repair(model(name));
        EXPECT_EQ(repaired.used, Repair::Light) << name;
        EXPECT_TRUE(repaired.after.is_clean()) << name;
        EXPECT_FALSE(repaired.before.is_clean()) << name;
        EXPECT_DOUBLE_EQ(std::abs(enclosed_volume(repaired.surface)), 1) << name;
    }
}

TEST(Repair, TakesTheWallOutBetweenTwoBodies) {
    const Repaired repaired = repair(model("dirty/d_shareface.off"));
    EXPECT_EQ(repaired.used, Repair::Light);
    EXPECT_EQ(repaired.surface.triangle_count(), 20);
    EXPECT_DOUBLE_EQ(std::abs(enclosed_volume(repaired.surface)), 2);
}

// Triangles that hang on a cube by an edge each, outside or inside.
TEST(Repair, TakesFinsOff) {
    const Surface cube = test::box_surface({0, 0, 0}, {1, 1, 1});
    for (const Eigen::Vector3d& tip :
         {Eigen::Vector3d(0.5, -1, -1), Eigen::Vector3d(0.5, 0.3, 0.4)}) {
        for (const int count : {1, 2}) {
            Surface finned = cube;
            finned.points.conservativeResize(3, 10);
            finned.points.col(8) = tip;
            finned.points.col(9) << 2, 2, 0.5;
            finned.triangles.conservativeResize(3, 14);
            finned.triangles.rightCols<2>() << 0, 3, 1, 7, 8, 9;
            finned.triangles.conservativeResize(3, 12 + count);
            const Repaired repaired = repair(finned);
            EXPECT_EQ(repaired.used, Repair::Light);
            EXPECT_TRUE(repaired.after.is_clean());
            EXPECT_EQ(repaired.surface.triangle_count(), 12);
            EXPECT_EQ(repaired.surface.point_count(), 8);
            EXPECT_DOUBLE_EQ(std::abs(enclosed_volume(repaired.surface)), 1);
            EXPECT_EQ(repaired.distance, 0);
        }
    }
}

// Nothing is wrong with it there as long as its own coordinates are whole numbers.
TEST(Repair, SaysThatAWrapNeedsFinerCoordinatesThanThereAreFarFromTheOrigin) {
    const Surface far = test::box_surface({-1e15, 0, 0}, {-1e15 + 1, 1, 1});
    EXPECT_EQ(repair(far).used, Repair::None);
    test::expect_contains(message_for(far, Repair::Wrap),
                          {"cannot be made 1e+15 m from the origin",
                           "coordinates are 0.12 m apart; move the surface nearer"});
}

TEST(Repair, UnitesBodiesThatCross) {
    // Two unit cubes that share an eighth, and one off to the side, turned inside out.
    Surface third = test::box_surface({5, 5, 5}, {6, 6, 6});
    third.triangles.row(0).swap(third.triangles.row(1));
    const Repaired repaired = repair(test::join(model("dirty/d_twocubes_overlap.off"), third));
    EXPECT_EQ(repaired.used, Repair::Light);
    EXPECT_TRUE(repaired.after.is_clean());
    EXPECT_EQ(repaired.after.components, 2);
    EXPECT_NEAR(enclosed_volume(orient(repaired.surface).surface), 2.875, 1e-12);
    EXPECT_LT(repaired.distance, 1e-15);
}

TEST(Repair, UnitesBodiesThatCrossWhicheverWayTheyTurn) {
    // Two unit cubes that share an eighth, one of them inside out.
    Surface turned = test::box_surface({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5});
    turned.triangles.row(0).swap(turned.triangles.row(1));
    const Repaired repaired = repair(test::join(test::box_surface({0, 0, 0}, {1, 1, 1}), turned));
    EXPECT_EQ(repaired.used, Repair::Light);
    EXPECT_NEAR(enclosed_volume(orient(repaired.surface).surface), 1.875, 1e-12);
}

TEST(UniteCrossingComponents, LeavesWhatHasNoUnionAsItIs) {
    Surface crossing_itself = test::box_surface({0, 0, 0}, {1, 1, 1});
    crossing_itself.points.col(7) << 0.5, 0.5, -1;  // pulled through the bottom
    EXPECT_EQ(unite_crossing_components(crossing_itself).triangles, crossing_itself.triangles);
    // Boxes that share half an edge would be a body that touches itself.
    const Surface touching = test::join(test::box_surface({0, 0, 0}, {1, 1, 1}),
                                        test::box_surface({1, 1, 0.5}, {2, 2, 1.5}));
    EXPECT_EQ(unite_crossing_components(touching).triangles, touching.triangles);
}

// A sphere of which one point was pulled through the other side: the spike goes, the sphere stays.
TEST(Repair, CutsSelfIntersectionsOut) {
    const Surface whole = sphere(4);
    Surface pulled = whole;
    Eigen::Index far = 0;
    whole.points.row(0).maxCoeff(&far);
    pulled.points.col(far) << -1.5, 0, 0.1;
    const Repaired repaired = repair(pulled, {.repair = Repair::Light});
    EXPECT_GT(repaired.before.self_intersections.count, 0);
    EXPECT_EQ(repaired.used, Repair::Light);
    EXPECT_TRUE(repaired.after.is_clean());
    EXPECT_EQ(repaired.after.components, 1);
    const double volume = std::abs(enclosed_volume(repaired.surface));
    EXPECT_NEAR(volume, std::abs(enclosed_volume(whole)), 0.1 * volume);
}

TEST(Repair, UnitesBodiesThatTouchInPartsOfTheirSides) {
    const Repaired repaired = repair(test::join(test::box_surface({0, 0, 0}, {2, 2, 2}),
                                                test::box_surface({2, 0.5, 0.5}, {3, 1.5, 1.5})));
    EXPECT_EQ(repaired.used, Repair::Light);
    EXPECT_EQ(repaired.after.components, 1);
    EXPECT_NEAR(std::abs(enclosed_volume(repaired.surface)), 9, 1e-12);
}

TEST(Repair, WrapsWhatCannotBeMendedLightly) {
    // Two cubes that touch in a corner.
    const Surface cubes = model("dirty/d_sharevertex.off");
    const RepairOptions options{.wrap_distance = 0.04};
    const Repaired repaired = repair(cubes, options);
    EXPECT_EQ(repaired.used, Repair::Wrap);
    EXPECT_TRUE(repaired.after.is_clean());
    EXPECT_LE(repaired.distance, options.wrap_distance * diagonal(cubes.points));
    // Both, in a shell that is no thicker than that.
    const double volume = enclosed_volume(repaired.surface);
    EXPECT_GT(volume, 2);
    EXPECT_LT(volume, 2 + area(repaired.surface) * repaired.distance);
}

TEST(Repair, WrapsWhenAskedTo) {
    const Repaired repaired =
        repair(model("dirty/d_cube.off"), {.repair = Repair::Wrap, .wrap_distance = 0.04});
    EXPECT_EQ(repaired.used, Repair::Wrap);
    EXPECT_TRUE(repaired.after.is_clean());
    // All around the cube, of which a corner is 1.7 m from the other.
    EXPECT_GT(repaired.distance, 0);
    EXPECT_LE(repaired.distance, 0.04 * std::sqrt(3));
    EXPECT_GT(std::abs(enclosed_volume(repaired.surface)), 1);
}

// A wrap has its points at a five-hundredth of the diagonal from the surface, then at half of that,
// until it is near enough; CGAL has them there within a hundredth. At any size: powers of two
// change no digit.
TEST(Repair, WrapsNearerUntilItIsNearEnough) {
    const Surface cube = test::box_surface({0, 0, 0}, {1, 1, 1});
    const double diagonal = std::sqrt(3.0);
    for (const auto& [wrap_distance, part] : {std::pair(0.04, 500), std::pair(0.0015, 1000)}) {
        const RepairOptions options{.repair = Repair::Wrap, .wrap_distance = wrap_distance};
        const Repaired repaired = repair(cube, options);
        EXPECT_LE(repaired.distance, wrap_distance * diagonal);
        for (const auto& p : repaired.surface.points.colwise()) {
            const double distance = ((p.array() - 1).max(0) + (-p.array()).max(0)).matrix().norm();
            EXPECT_NEAR(distance, diagonal / part, 0.01 * diagonal / part);
        }
        Surface large = cube;
        large.points *= 0x1p10;
        EXPECT_EQ(repair(large, options).surface.points, 0x1p10 * repaired.surface.points);
    }
}

TEST(Repair, RefusesSizesWhoseVolumesCannotBeNumbers) {
    Surface box = test::box_surface({0, 0, 0}, {1, 1, 1});
    for (const double scale : {1e-300, 1e-40, 1e40, 1e300}) {
        Surface scaled = box;
        scaled.points *= scale;
        test::expect_contains(message_for(scaled, Repair::Auto), {"m across", "scale it"});
    }
    for (const double scale : {1e-20, 1e20}) {
        Surface scaled = box;
        scaled.points *= scale;
        EXPECT_EQ(repair(scaled).used, Repair::None);
    }
}

TEST(Repair, KeepsOneSideOfASurfaceWithTwo) {
    const Surface box = test::box_surface({0, 0, 0}, {1, 1, 1});
    Surface inside_out = box;
    inside_out.triangles.row(0).swap(inside_out.triangles.row(1));
    const Surface both = test::join(box, inside_out);
    const Repaired repaired = repair(weld(both.points, both.triangles).surface);
    EXPECT_EQ(repaired.used, Repair::Light);
    EXPECT_EQ(repaired.surface.triangle_count(), 12);
    EXPECT_DOUBLE_EQ(std::abs(enclosed_volume(repaired.surface)), 1);
}

TEST(Repair, RefusesWhatHasNoInside) {
    test::expect_contains(message_for(model("dirty/d_coplanar.off"), Repair::Auto), {"in a plane"});
    Surface tilted = test::box_surface({0, 0, 0}, {1, 1, 0});
    tilted.points.row(2) = 0.3 * tilted.points.row(0) + 0.7 * tilted.points.row(1);
    test::expect_contains(message_for(tilted, Repair::Wrap), {"in a plane"});
}

TEST(NameOf, TellsWaysOfMendingApart) {
    EXPECT_EQ(name_of(Repair::None), "none");
    EXPECT_EQ(name_of(Repair::Light), "light");
    EXPECT_EQ(name_of(Repair::Wrap), "wrap");
    EXPECT_EQ(name_of(Repair::Auto), "auto");
}

TEST(Repair, DoesNoMoreThanAllowed) {
    test::expect_contains(message_for(model("dirty/d_open.off"), Repair::None),
                          {"3 border edges", "mended"});
    test::expect_contains(message_for(model("dirty/d_sharevertex.off"), Repair::Light),
                          {"light mending is not enough", "1 non-manifold point"});
}

TEST(Repair, MendsATriangleSoupOfMyOwnMaking) {
    // A box with a hole, a fin, a spike without area, a loose triangle within and one side turned.
    Surface box = test::box_surface({0, 0, 0}, {1, 1, 1});
    std::swap(box.triangles(0, 3), box.triangles(1, 3));
    Surface extra;
    extra.points.resize(3, 6);
    extra.points << 0.5, 2, 2, 0.4, 0.6, 0.5,  //
        0.5, 0.5, 0.5, 0.4, 0.4, 0.6,          //
        0.5, 0.5, 0.5, 0.5, 0.5, 0.5;
    extra.triangles.resize(3, 3);
    extra.triangles << 0, 0, 3, 1, 1, 4, 2, 2, 5;
    extra.triangles(2, 1) = 3;
    Surface soup = test::join(box, extra);
    soup.triangles = soup.triangles.rightCols(soup.triangle_count() - 1).eval();
    const Repaired repaired = repair(soup, {.wrap_distance = 0.04});
    EXPECT_TRUE(repaired.after.is_clean());
    EXPECT_NE(repaired.used, Repair::None);
}

}  // namespace
}  // namespace pent::mesher
