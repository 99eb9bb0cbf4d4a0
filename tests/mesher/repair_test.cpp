#include "shapes.h"
#include "support/messages.h"

#include <pent/mesher/repair.h>

#include <gtest/gtest.h>

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
    }
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

TEST(Repair, WrapsWhatCannotBeMendedLightly) {
    const Surface cubes = model("dirty/d_twocubes_overlap.off");
    const Repaired repaired = repair(cubes);
    EXPECT_EQ(repaired.used, Repair::Wrap);
    EXPECT_TRUE(repaired.after.is_clean());
    EXPECT_LE(repaired.distance, 0.01 * diagonal(cubes.points));
    // The union of two unit cubes that share an eighth, in a shell that is no thicker than that.
    const double volume = enclosed_volume(repaired.surface);
    EXPECT_GT(volume, 1.875);
    EXPECT_LT(volume, 1.875 + area(repaired.surface) * repaired.distance);
}

TEST(Repair, WrapsWhenAskedTo) {
    const Repaired repaired = repair(model("dirty/d_cube.off"), {.repair = Repair::Wrap});
    EXPECT_EQ(repaired.used, Repair::Wrap);
    EXPECT_TRUE(repaired.after.is_clean());
}

TEST(Repair, RefusesWhatHasNoInside) {
    test::expect_contains(message_for(model("dirty/d_coplanar.off"), Repair::Auto), {"in a plane"});
    Surface tilted = test::box_surface({0, 0, 0}, {1, 1, 0});
    tilted.points.row(2) = 0.3 * tilted.points.row(0) + 0.7 * tilted.points.row(1);
    test::expect_contains(message_for(tilted, Repair::Wrap), {"in a plane"});
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
    const Repaired repaired = repair(soup);
    EXPECT_TRUE(repaired.after.is_clean());
    EXPECT_NE(repaired.used, Repair::None);
}

}  // namespace
}  // namespace pent::mesher
