#include "layer_places.h"
#include "requested_layers.h"
#include "shapes.h"
#include "support/kuhn_box.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/formatted.h>
#include <pent/mesher/edge_order.h>
#include <pent/mesher/profile.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/shapes.h>

#include <gtest/gtest.h>

#include <numbers>

namespace pent::mesher {
namespace {

std::vector<Layer<4>> read_text(const std::string& text) {
    const test::TempFolder folder;
    test::write_file(folder / "profile.txt", text);
    return read_profile(folder / "profile.txt");
}

SimplexMesh<4> extruded(const SimplexMesh<3>& base, const std::vector<Layer<4>>& layers) {
    const auto ranks = rank_vertices(base, VertexOrder::Index);
    const SimplexMesh<4> mesh =
        extrude<4>(base, order_cells<3>(base, direct_edges<3>(base, ranks)), layers);
    validate(mesh, "profile");
    return mesh;
}

TEST(ReadProfile, ScalesTurnsAndMoves) {
    const auto layers = read_text("# two layers\n0 1\n2 3 4 5 6  90 0 0 0 0 0\n");
    ASSERT_EQ(layers.size(), 2U);
    const Eigen::Vector3d x(1, 0.5, 0.25);
    EXPECT_EQ(layers[0].linear * x + layers[0].offset, Eigen::Vector4d(1, 0.5, 0.25, 0));
    // xy turns x towards y: (1, 0.5) goes to (-0.5, 1); then times 3 and moved.
    const Eigen::Vector4d moved = layers[1].linear * x + layers[1].offset;
    EXPECT_LT((moved - Eigen::Vector4d(4 - 1.5, 5 + 3, 6 + 0.75, 2)).norm(), 1e-14);
}

TEST(ReadProfile, TurnsXTowardsWInThePlaneXw) {
    const auto layers = read_text("0 1\n1 1 0 0 0 0 0 90 0 0 0\n");
    const Eigen::Vector4d moved = layers[1].linear * Eigen::Vector3d(2, 0, 0) + layers[1].offset;
    EXPECT_LT((moved - Eigen::Vector4d(0, 0, 0, 3)).norm(), 1e-15);
}

TEST(ReadProfile, NamesTheLineOfWhatIsWrong) {
    const auto message = [](const std::string& text) {
        return test::error_of([&] { static_cast<void>(read_text(text)); });
    };
    test::expect_contains(message(""), {"profile.txt", "0 layers"});
    test::expect_contains(message("0 1\n"), {"1 layer;"});
    test::expect_contains(message("0 1\n1\n"), {"line 2", "1 number; expected"});
    test::expect_contains(message("0 1\n1 1 2\n"), {"3 numbers"});
    test::expect_contains(message("0 1\n1 -1\n"), {"scale -1"});
    test::expect_contains(message("0 1\n1 x\n"), {"\"x\""});
    test::expect_contains(message("0 1\n1 0\n2 1\n"), {"line 3", "behind a point"});
    test::expect_contains(message("0 0\n1 0\n"), {"two points"});
    test::expect_contains(message("0 1 2 3 4 5 6 7 8 9 10 11\n"), {"more than 11"});
}

TEST(ReadProfile, MakesTaperedBentAndClosedBodies) {
    SimplexMesh<3> base = test::kuhn_box<3>({2, 2, 2}, {1, 1, 1});
    base.positions.array() -= 0.5;
    // A frustum over a unit cube: the integral of (1 - t/2)^3 over t from 0 to 1 is 15/32, met from
    // above at second order by straight pieces between layers.
    std::string frustum;
    for (int l = 0; l <= 32; ++l) {
        frustum += std::to_string(l / 32.0) + " " + std::to_string(1 - l / 64.0) + "\n";
    }
    const SimplexMesh<4> tapered = extruded(base, read_text(frustum));
    EXPECT_TRUE(prove(tapered).holds());
    EXPECT_NEAR(total_volume(tapered), 15.0 / 32, 1e-3);
    // Turned by a quarter around the plane x = -2, w = 0: a ring by Pappus.
    std::string bent;
    for (int l = 0; l <= 48; ++l) {
        const double angle = std::numbers::pi / 2 * l / 48;
        bent += formatted("%.17g 1 %.17g 0 0 0 0 %.17g 0 0 0\n", 2 * std::sin(angle),
                          2 * std::cos(angle), angle * 180 / std::numbers::pi);
    }
    const SimplexMesh<4> ring = extruded(base, read_text(bent));
    EXPECT_TRUE(prove(ring).holds());
    EXPECT_NEAR(total_volume(ring), std::numbers::pi / 2 * 2, 2e-3);
    // A pyramid has a quarter of its prism.
    const SimplexMesh<4> pyramid = extruded(base, read_text("0 1\n2 0\n"));
    EXPECT_TRUE(prove(pyramid).holds());
    EXPECT_NEAR(total_volume(pyramid), 0.5, 1e-15);
}

TEST(RoundLayers, MakeAHyperballOfABall) {
    // Volume pi^2 / 2, from within at second order in both resolutions at once.
    const double whole = std::numbers::pi * std::numbers::pi / 2;
    const double coarse =
        whole - total_volume(extruded(ball(4), round_layers(1, even_places(10, 0.5))));
    const double fine =
        whole - total_volume(extruded(ball(8), round_layers(1, even_places(20, 0.5))));
    EXPECT_GT(fine, 0);
    EXPECT_NEAR(coarse / fine, 4, 0.3);
    EXPECT_TRUE(prove(extruded(ball(4), round_layers(-1, even_places(10, 0.5)))).holds());
}

TEST(Relayer, KeepsTheBodyWhereEveryBendHasALayer) {
    // A body that swells, leans and ends in a point, cut anew with layers at its bends and between.
    const auto layers = read_text("-1 0.5\n0 1 0.3 0 0\n1 0\n");
    const double length = path_length(layers);
    const double bend = (layers[1].offset - layers[0].offset).norm() / length;
    EXPECT_EQ(slice_on_path(layers), bend);
    const auto finer = relayer(layers, {0, bend / 3, bend, bend + (1 - bend) / 4, 1});
    ASSERT_EQ(finer.size(), 5U);
    EXPECT_TRUE(finer.back().is_point());
    EXPECT_LT((finer[2].linear - layers[1].linear).norm(), 1e-15);
    // In each slab columns are straight, as they were: the same body, by another cut. Prisms that
    // scale and move have flat sides, so that the cut of the sides makes no difference either.
    SimplexMesh<3> base = test::kuhn_box<3>({2, 2, 2}, {1, 1, 1});
    base.positions.array() -= 0.5;
    const SimplexMesh<4> body = extruded(base, finer);
    EXPECT_TRUE(prove(body).holds());
    EXPECT_NEAR(total_volume(body), total_volume(extruded(base, layers)), 1e-14);
}

TEST(Relayer, RefusesWhatHasNoWayOrNothingBetweenItsEnds) {
    const auto turned = read_text("0 1\n0 1 0 0 0 0 0 20 0 0 0\n");
    test::expect_contains(test::error_of([&] {
                              static_cast<void>(relayer(turned, {0, 0.5, 1}));
                          }),
                          {"layers 1 and 2 have one middle"});
    const auto closed = read_text("0 0\n1 1\n2 0\n");
    test::expect_contains(test::error_of([&] {
                              static_cast<void>(relayer(closed, {0, 1}));
                          }),
                          {"one layer between two points"});
}

TEST(RequestedLayers, HasNoNumberOfThemOnAPathOfNoLength) {
    const test::TempFolder folder;
    test::write_file(folder / "turn.txt", "0 1\n0 1 0 0 0 0 0 20 0 0 0\n");
    ExtrusionRequest request;
    request.profile = folder / "turn.txt";
    request.grade = 2;
    test::expect_contains(test::error_of([&] {
                              static_cast<void>(requested_layers<4>(request, {1, 1, 0.1}));
                          }),
                          {"turn.txt: its layers have one middle", "list all of them"});
    EXPECT_THROW(static_cast<void>(suitable_slabs(request, 1, 0)), Error);
}

TEST(SliceOnPath, IsWhereTheWayCrossesZeroOrTheNearerEnd) {
    EXPECT_EQ(slice_on_path(read_text("-1 1\n3 1\n")), 0.25);
    EXPECT_EQ(slice_on_path(read_text("1 1\n3 1\n")), 0);
    EXPECT_EQ(slice_on_path(read_text("-3 1\n-1 1\n")), 1);
    EXPECT_EQ(slice_on_path(read_text("-2 1\n0 1\n2 1\n")), 0.5);
    EXPECT_EQ(slice_on_path(read_text("0 1\n0 1 0 0 0 0 0 20 0 0 0\n")), 0);  // it only turns
}

}  // namespace
}  // namespace pent::mesher
