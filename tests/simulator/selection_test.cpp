#include "model/rotation.h"
#include "model/selection_marks.h"
#include "support/kuhn_box.h"
#include "support/messages.h"

#include <pent/error.h>
#include <pent/simulator/placed_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace pent::simulator {
namespace {

SimplexMesh<4> unit_box() {
    return pent::test::kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1});  // 81 vertices at 0, 0.5, 1
}

Constraint select(std::vector<Selection> selections) {
    return {.body = "box", .select = std::move(selections), .motion = {}};
}

TEST(SelectVertices, TakesTheBallWithItsBorder) {
    const BallSelection ball{.center = Vector<4>::Constant(0.5), .radius = 0.5};
    EXPECT_EQ(select_vertices(unit_box(), select({ball})).size(), 9U);  // center and 8 at 0.5
}

TEST(SelectVertices, TakesTheBoxWithItsBorder) {
    const BoxSelection box{.low = Vector<4>::Zero(), .high = Vector<4>(1, 1, 1, 0)};
    EXPECT_EQ(select_vertices(unit_box(), select({box})).size(), 27U);
}

TEST(SelectVertices, TakesTheHalfSpaceBelowTheOffset) {
    const HalfSpaceSelection half_space{.normal = Vector<4>(0, 0, 0, -1), .offset = -1};
    EXPECT_EQ(select_vertices(unit_box(), select({half_space})).size(), 27U);  // w >= 1
}

TEST(SelectVertices, TakesTheUnionOfAListWithoutDoubles) {
    const HalfSpaceSelection x{.normal = Vector<4>(1, 0, 0, 0), .offset = 0};
    const HalfSpaceSelection y{.normal = Vector<4>(0, 1, 0, 0), .offset = 0};
    EXPECT_EQ(select_vertices(unit_box(), select({x, y})).size(), 27U + 27U - 9U);
}

TEST(SelectVertices, TakesLayersAndRegions) {
    SimplexMesh<4> mesh = unit_box();
    for (std::uint32_t v = 0; v < 81; ++v) {
        mesh.layers.push_back(v / 27);
    }
    mesh.regions.assign(static_cast<std::size_t>(mesh.cell_count()), 0);
    mesh.regions[0] = 7;
    EXPECT_EQ(select_vertices(mesh, select({LayerSelection{.first = 1, .last = 2}})).size(), 54U);
    EXPECT_EQ(select_vertices(mesh, select({RegionSelection{.region = 7}})).size(), 5U);
    EXPECT_EQ(select_vertices(mesh, select({EverythingSelection{}})).size(), 81U);
}

TEST(SelectVertices, RefusesToSelectNothingAndSaysWhereTheBodyIs) {
    const BallSelection ball{.center = Vector<4>::Constant(9), .radius = 0.5};
    try {
        static_cast<void>(select_vertices(unit_box(), select({ball})));
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("[0, 0, 0, 0] to [1, 1, 1, 1]"), std::string::npos)
            << error.what();
    }
}

TEST(SelectVertices, SaysWhichConstraintSelectsNothingAndWhatThereIs) {
    SimplexMesh<4> mesh = unit_box();
    for (std::uint32_t v = 0; v < 81; ++v) {
        mesh.layers.push_back(v / 27);
    }
    mesh.regions.assign(static_cast<std::size_t>(mesh.cell_count()), 4);
    const auto message = [&](const Selection& selection) {
        Constraint constraint = select({selection});
        constraint.source = "scene.toml:7:10";
        const std::string text =
            pent::test::error_of([&] { static_cast<void>(select_vertices(mesh, constraint)); });
        EXPECT_EQ(text.rfind("scene.toml:7:10: constraint on \"box\" selects no vertex: ", 0), 0U)
            << text;
        return text;
    };
    const Vector<4> corner(1, 1, 1, 4);  // 3 m from the vertex 80, the last
    pent::test::expect_contains(message(BallSelection{.center = corner, .radius = 0.5}),
                                {"the nearest vertex is 80 at [1, 1, 1, 1], 2.5 m away"});
    pent::test::expect_contains(
        message(BoxSelection{.low = corner, .high = corner + Vector<4>::Ones()}),
        {"the nearest vertex is 80 at", ", 3 m away"});
    pent::test::expect_contains(
        message(HalfSpaceSelection{.normal = Vector<4>(0, 0, 0, 1), .offset = -2}),
        {"the nearest vertex is 0 at [0, 0, 0, 0], 2 m away"});
    pent::test::expect_contains(message(LayerSelection{.first = 5, .last = 9}),
                                {"the mesh has the layers 0 to 2"});
    pent::test::expect_contains(message(RegionSelection{.region = 3}),
                                {"the mesh has the regions 4 to 4"});
    mesh.regions.clear();
    pent::test::expect_contains(message(RegionSelection{.region = 3}), {"the mesh has no regions"});
}

TEST(SelectVertices, RefusesLayersOfAMeshThatHasNone) {
    EXPECT_THROW(static_cast<void>(select_vertices(unit_box(), select({LayerSelection{}}))), Error);
}

TEST(SelectVertices, AddsLayersAndRegionsToWhatOthersSelect) {
    SimplexMesh<4> mesh = unit_box();
    for (std::uint32_t v = 0; v < 81; ++v) {
        mesh.layers.push_back(v / 27);  // along w
    }
    mesh.regions.assign(static_cast<std::size_t>(mesh.cell_count()), 0);
    mesh.regions[0] = 7;
    const HalfSpaceSelection low{.normal = Vector<4>(0, 0, 0, 1), .offset = 0};
    const LayerSelection high{.first = 2, .last = 2};
    EXPECT_EQ(select_vertices(mesh, select({low, high})).size(), 54U);
    EXPECT_EQ(select_vertices(mesh, select({high, low})).size(), 54U);
    EXPECT_EQ(select_vertices(mesh, select({high, EverythingSelection{}})).size(), 81U);
    const auto count = [&](const std::vector<Selection>& selections) {
        const std::vector<bool> marks = select_cells(mesh, selections, "here");
        return std::count(marks.begin(), marks.end(), true);
    };
    const Eigen::Index cells = mesh.cell_count();
    EXPECT_EQ(count({RegionSelection{.region = 7}}), 1);
    EXPECT_EQ(count({RegionSelection{.region = 0}}), cells - 1);
    EXPECT_EQ(count({RegionSelection{.region = 7}, RegionSelection{.region = 0}}), cells);
    EXPECT_EQ(count({RegionSelection{.region = 0}, RegionSelection{.region = 7}}), cells);
    // Cells lie between two layers: none is in one alone, half of them in the first two.
    EXPECT_EQ(count({LayerSelection{.first = 0, .last = 1}}), cells / 2);
    EXPECT_EQ(count({LayerSelection{.first = 0, .last = 1}, LayerSelection{.first = 1, .last = 2}}),
              cells);
}

TEST(PlaceAndName, SaysWhereAPartStandsIfThatIsKnown) {
    EXPECT_EQ(place_and_name(Region{.name = "a", .select = {}, .material = {}}), "region \"a\"");
    EXPECT_EQ(place_and_name(Constraint{.body = "a", .select = {}, .motion = {}}),
              "constraint on \"a\"");
    EXPECT_EQ(place_and_name(Load{.body = "a", .select = {}}), "load on \"a\"");
    EXPECT_EQ(place_and_name(Activation{.body = "a", .select = {}}), "activation of \"a\"");
    EXPECT_EQ(place_and_name(Attachment{.body = "a", .select = {}, .point = {}, .motion = {}}),
              "attachment of \"a\"");
    EXPECT_EQ(place_and_name(Region{.name = "a", .select = {}, .material = {}, .source = "s:1"}),
              "s:1: region \"a\"");
    EXPECT_EQ(place_and_name(Constraint{.body = "a", .select = {}, .motion = {}, .source = "s:1"}),
              "s:1: constraint on \"a\"");
    EXPECT_EQ(place_and_name(Load{.body = "a", .select = {}, .source = "s:1"}),
              "s:1: load on \"a\"");
    EXPECT_EQ(place_and_name(Activation{.body = "a", .select = {}, .source = "s:1"}),
              "s:1: activation of \"a\"");
    EXPECT_EQ(place_and_name(Attachment{
                  .body = "a", .select = {}, .point = {}, .motion = {}, .source = "s:1"}),
              "s:1: attachment of \"a\"");
}

TEST(SelectsByRegion, IsSoIfAnyOfTheListDoes) {
    const RegionSelection region{.region = 1};
    EXPECT_TRUE(selects_by_region({region}));
    EXPECT_TRUE(selects_by_region({EverythingSelection{}, region}));
    EXPECT_FALSE(selects_by_region({EverythingSelection{}, LayerSelection{.first = 0, .last = 1}}));
    EXPECT_FALSE(selects_by_region({}));
}

}  // namespace
}  // namespace pent::simulator
