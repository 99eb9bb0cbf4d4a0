#include "shapes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/error.h>
#include <pent/mesher/links.h>
#include <pent/mesher/make_body.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace pent::mesher {
namespace {

BodyRequest request_for(const std::string& model) {
    BodyRequest request;
    request.input = std::string(PENT_MODELS) + "/" + model;
    request.tetrahedra.worker = PENT_TETGEN_WORKER;
    return request;
}

std::string message_for(const BodyRequest& request) {
    return test::error_of([&] { static_cast<void>(make_body(request)); });
}

TEST(MakeBody, MakesAProvenBodyOfAModel) {
    const Body<4> body = make_body(request_for("octopus_5246f.obj"));
    EXPECT_NO_THROW(validate(body.mesh, "octopus"));
    EXPECT_TRUE(body.report.proof.holds());
    // 0.2 of the largest side, in layers 0.7 edges high.
    EXPECT_NEAR(body.report.layers, body.report.direction[3] / (0.7 * body.report.base_edge), 0.5);
    EXPECT_EQ(body.mesh.cell_count(), 4 * body.report.layers * body.report.base_cells);
    EXPECT_EQ(body.report.proof.boundary_facets,
              2 * body.report.base_cells + 3 * body.report.layers * body.report.surface.triangles);
    EXPECT_EQ(body.mesh.positions.row(3).minCoeff(), -body.report.direction[3] / 2);
    EXPECT_EQ(body.mesh.positions.row(3).maxCoeff(), body.report.direction[3] / 2);
    EXPECT_FALSE(body.report.stages.empty());
}

TEST(MakeBody, TakesThicknessDirectionAndLayersAsAsked) {
    BodyRequest request = request_for("dirty/d_cube.off");
    request.extrusion.thickness = -2;
    request.extrusion.layers = 3;
    request.extrusion.anchor = Anchor::Start;
    const Body<4> back = make_body(request);
    EXPECT_NEAR(back.report.proof.volume, 2, 1e-14);
    EXPECT_EQ(back.mesh.positions.row(3).minCoeff(), -2);
    EXPECT_EQ(back.mesh.positions.row(3).maxCoeff(), 0);

    request.extrusion.thickness.reset();
    request.extrusion.direction = Eigen::Vector4d(1, 2, 3, 0.5);
    const Body<4> leaning = make_body(request);
    EXPECT_NEAR(leaning.report.proof.volume, 0.5, 1e-14);
    EXPECT_EQ(leaning.mesh.positions.row(2).maxCoeff(), 4);
}

TEST(MakeBody, ResamplesTheSurfaceFirst) {
    BodyRequest request = request_for("dirty/d_cube.off");
    request.surface_triangles = 100;
    const Body<4> body = make_body(request);
    EXPECT_EQ(body.report.surface.triangles, 100);
    EXPECT_EQ(body.report.proof.boundary_facets,
              2 * body.report.base_cells + 300 * body.report.layers);
}

TEST(MakeBody, TurnsFacesOutwardAndKeepsCavitiesEmpty) {
    EXPECT_NEAR(make_body(request_for("dirty/d_flipped.off")).report.base_volume, 1, 1e-14);
    EXPECT_EQ(make_body(request_for("dirty/d_flipped.off")).report.flipped_triangles, 1);
    EXPECT_NEAR(make_body(request_for("dirty/d_nested.off")).report.base_volume, 26, 1e-12);
    EXPECT_EQ(make_body(request_for("dirty/d_nested.off")).report.cavities, 1);
    EXPECT_NEAR(make_body(request_for("dirty/d_bigsmall.off")).report.base_volume, 1.000125,
                1e-6);  // the file is read in float
}

TEST(MakeBody, RefusesWhatCannotBeExtruded) {
    BodyRequest request = request_for("dirty/d_cube.off");
    request.extrusion.thickness = 0;
    test::expect_contains(message_for(request), {"along w", "other than 0"});
    request.extrusion.thickness = std::nan("");
    test::expect_contains(message_for(request), {"along w"});
    request.extrusion.thickness.reset();
    request.extrusion.direction = Eigen::Vector3d(0, 0, 1);
    test::expect_contains(message_for(request), {"3 components", "expected 4"});
    request.extrusion.direction = Eigen::Vector4d(0, 0, 1, 0);
    test::expect_contains(message_for(request), {"along w"});
    request.extrusion = ExtrusionRequest();
    request.extrusion.thickness = 0;
    request.extrusion.round = true;
    test::expect_contains(message_for(request), {"round body of height 0", "other than 0"});
    request.input = SphereShape{4, 1e-300};
    test::expect_contains(message_for(request), {"the shape: ", "m across"});
}

TEST(MakeBody, OrdersVerticesForItsWorstCell) {
    BodyRequest request = request_for("dirty/d_cube.off");
    request.surface_triangles = 200;
    request.extrusion.layers = 1;
    request.extrusion.direction = Eigen::Vector4d(0.3, 0.2, -0.1, 0.2);
    const Body<4> by_index = make_body(request);
    request.extrusion.order = VertexOrder::Quality;
    const Body<4> body = make_body(request);
    EXPECT_NEAR(body.report.proof.volume, 0.2, 1e-14);
    EXPECT_GE(body.report.quality.mean_ratio.min, by_index.report.quality.mean_ratio.min);
    EXPECT_TRUE(body.mesh.cells != by_index.mesh.cells);
}

TEST(MakeBody, FollowsAProfile) {
    const test::TempFolder folder;
    test::write_file(folder / "cone.txt", "0 1\n3 0\n");
    BodyRequest request = request_for("dirty/d_cube.off");
    request.extrusion.profile = folder / "cone.txt";
    const Body<4> cone = make_body(request);
    EXPECT_NEAR(total_volume(cone.mesh), 3.0 / 4, 1e-14);  // base 1, height 3, over the dimension
}

TEST(MakeBody, MeetsATargetWithinTwoPercent) {
    for (const std::int64_t target : {20000, 150000}) {
        BodyRequest request = request_for("octopus_5246f.obj");
        request.target_cells = target;
        const Body<4> body = make_body(request);
        EXPECT_NEAR(static_cast<double>(body.mesh.cell_count()), static_cast<double>(target),
                    0.02 * static_cast<double>(target));
        EXPECT_GE(body.report.fillings, 1);
    }
}

TEST(MakeBody, MeetsATargetWhateverTheLayersAre) {
    const test::TempFolder folder;
    test::write_file(folder / "cone.txt", "0 1\n1 0.8\n2 0.5\n3 0\n");
    BodyRequest request = request_for("octopus_5246f.obj");
    request.target_cells = 200000;
    const auto expect_met = [&] {
        EXPECT_NEAR(static_cast<double>(make_body(request).mesh.cell_count()), 200000, 4000);
    };
    request.extrusion.round = true;
    expect_met();
    request.extrusion.round = false;
    request.extrusion.profile = folder / "cone.txt";
    expect_met();
    request.extrusion = ExtrusionRequest();
    request.extrusion.layers = 1;
    request.subdivide = 2;
    expect_met();
}

TEST(MakeBody, AimsAtAnEdgeLength) {
    BodyRequest request = request_for("octopus_5246f.obj");
    request.edge_length = 0.2;
    // Constrained by the shape, TetGen's edges come out up to a third longer or shorter.
    EXPECT_NEAR(make_body(request).report.base_edge, 0.2, 0.07);
}

TEST(MakeBody, ExtrudesTetrahedraAsTheyAre) {
    const test::TempFolder folder;
    test::write_file(folder / "a.tobj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nt 1 0 2 3\n");
    BodyRequest request;
    request.input = folder / "a.tobj";
    request.extrusion.thickness = 6;
    request.extrusion.layers = 2;
    const Body<4> body = make_body(request);
    EXPECT_EQ(body.mesh.cell_count(), 8);
    EXPECT_NEAR(body.report.proof.volume, 1, 1e-15);
    // Two that overlap do not fit together.
    test::write_file(folder / "a.tobj",
                     "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 2\nt 0 1 2 3\nt 0 1 2 4\n");
    test::expect_contains(message_for(request), {"a.tobj", "do not fit together"});
}

TEST(MakeBody, FollowsEdgeDirectionsFromAFile) {
    const test::TempFolder folder;
    test::write_file(folder / "a.tobj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nt 0 1 2 3\n");
    test::write_file(folder / "down.txt", "3 2\n3 1\n3 0\n2 1\n2 0\n1 0\n");
    test::write_file(folder / "around.txt", "0 1\n1 2\n2 0\n0 3\n1 3\n2 3\n");
    BodyRequest request;
    request.input = folder / "a.tobj";
    request.extrusion.layers = 1;
    request.extrusion.edge_directions = folder / "down.txt";
    const Body<4> body = make_body(request);
    // The first simplex has the bottom of vertex 3 alone, and all tops.
    EXPECT_EQ(body.mesh.columns[body.mesh.cells(0, 0)], 3U);
    EXPECT_EQ(body.mesh.layers[body.mesh.cells(0, 0)], 0U);
    request.extrusion.edge_directions = folder / "around.txt";
    test::expect_contains(message_for(request), {"around.txt: edge directions: 1 triangle is a"
                                                 " directed cycle: 0 -> 1 -> 2"});
}

// Steps that know only a mesh cannot say which file it is of.
TEST(MakeBody, NamesTheInputWhereAStepOnItsMeshFails) {
    for (const Repair level : {Repair::Light, Repair::Auto}) {  // Auto: its wrap fails, too
        BodyRequest request = request_for("dirty/d_cube.off");
        request.repair.repair = level;
        request.tetrahedra.generator = Generator::TetGen;
        request.tetrahedra.worker = "no_such_worker";
        test::expect_contains(message_for(request), {"dirty/d_cube.off: ", "no_such_worker"});
    }
    BodyRequest request;
    request.input = BallShape{2, 1};
    request.extrusion.layers = 1;
    request.translation = Eigen::Vector4d(1e20, 0, 0, 0);
    test::expect_contains(message_for(request), {"the shape: the mesh that was made: "});
}

TEST(MakeBody, MakesShapesWithoutAFile) {
    BodyRequest request;
    request.tetrahedra.worker = PENT_TETGEN_WORKER;
    request.input = BallShape{4, 1};
    request.extrusion.thickness = 20;
    request.extrusion.layers = 40;
    const Body<4> noodle = make_body(request);
    EXPECT_EQ(noodle.mesh.vertex_count(), 6683);
    EXPECT_EQ(noodle.mesh.cell_count(), 51200);

    request.input = SphereShape{4, 2};
    request.extrusion = ExtrusionRequest();
    request.extrusion.round = true;
    const Body<4> hyperball = make_body(request);
    EXPECT_TRUE(hyperball.report.proof.holds());
    EXPECT_EQ(hyperball.mesh.positions.row(3).maxCoeff(), 2);

    request.extrusion = ExtrusionRequest();
    request.input = BoxShape{{4, 1, 1, 1}, {4, 1, 1, 1}, CubeCut::Corners};
    request.subdivide = 2;
    const Body<4> box = make_body(request);
    EXPECT_EQ(box.mesh.cell_count(), 4 * 16 * 16);
    EXPECT_EQ(box.mesh.positions.row(0).minCoeff(), -2);
    EXPECT_NEAR(box.report.proof.volume, 4, 1e-12);  // a sum of 1024 terms
}

TEST(MakeBody, MendsOrRefusesEveryDirtyModel) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(PENT_MODELS) + "/dirty")) {
        BodyRequest request = request_for("dirty/" + entry.path().filename().string());
        request.extrusion.layers = 1;
        request.repair.wrap_distance = 0.04;  // a coarse wrap is a quick one
        if (entry.path().filename() == "d_coplanar.off") {
            test::expect_contains(message_for(request), {"d_coplanar.off", "in a plane"});
        } else {
            EXPECT_TRUE(make_body(request).report.proof.holds()) << entry.path();
        }
    }
}

TEST(MakeSolid, ExtrudesAFlatMeshAlongZ) {
    const test::TempFolder folder;
    test::write_file(folder / "flat.obj", "v 0 0 5\nv 1 0 5\nv 1 1 5\nv 0 1 5\nf 1 2 3\nf 1 4 3\n");
    BodyRequest request;
    request.input = folder / "flat.obj";
    request.extrusion.thickness = 2;
    request.extrusion.layers = 4;
    const Body<3> body = make_solid(request);
    EXPECT_EQ(body.mesh.cell_count(), 2 * 3 * 4);
    EXPECT_NEAR(body.report.proof.volume, 2, 1e-13);
    EXPECT_DOUBLE_EQ(body.mesh.positions.row(2).minCoeff(), 4);
    EXPECT_DOUBLE_EQ(body.mesh.positions.row(2).maxCoeff(), 6);
    request.translation = Eigen::Vector3d(0, 0, -5);
    EXPECT_NEAR(make_solid(request).mesh.positions.row(2).sum(), 0, 1e-13);
    request.extrusion = ExtrusionRequest();
    test::write_file(folder / "flat.obj",
                     "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 1 0\nv 2 2 0\nf 1 2 3\nf 3 4 5\n");
    test::expect_contains(test::error_of([&] { static_cast<void>(make_solid(request)); }),
                          {"flat.obj", "the triangles do not fit together"});
    test::write_file(folder / "flat.obj", "v 0 0 5\nv 1 0 5\nv 1 1 6\nf 1 2 3\n");
    test::expect_contains(test::error_of([&] { static_cast<void>(make_solid(request)); }),
                          {"flat.obj", "lie in a plane", "one z"});
}

TEST(MakeSolid, FillsAClosedSurface) {
    BodyRequest request = request_for("dirty/d_cube.off");
    const Body<3> cube = make_solid(request);
    EXPECT_NEAR(cube.report.proof.volume, 1, 1e-14);
    EXPECT_EQ(cube.report.proof.boundary_facets, 12);
    EXPECT_EQ(cube.report.layers, 0);
    request.edge_length = 0.2;
    EXPECT_NEAR(make_solid(request).report.base_edge, 0.2, 0.07);
}

TEST(MakeSolid, TakesTetrahedraBallsAndBoxesAsTheyAre) {
    const test::TempFolder folder;
    test::write_file(folder / "a.tobj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nt 1 0 2 3\n");
    BodyRequest request;
    request.input = folder / "a.tobj";
    EXPECT_EQ(make_solid(request).mesh.cell_count(), 1);
    request.input = BallShape{3, 2};
    EXPECT_EQ(make_solid(request).mesh.cell_count(), 180);
    request.input = BoxShape{{2, 1, 1}, {4, 2, 2}, CubeCut::Paths};
    const Body<3> box = make_solid(request);
    EXPECT_EQ(box.mesh.cell_count(), 12);
    EXPECT_NEAR(box.report.proof.volume, 16, 1e-13);
    EXPECT_EQ(box.mesh.positions.row(0).minCoeff(), -2);
    request.input = BoxShape();  // of four axes
    test::expect_contains(test::error_of([&] { static_cast<void>(make_solid(request)); }),
                          {"a box of 4 axes; expected 3"});
}

TEST(MakeBody, RefusesWhatItWouldLeaveUnheeded) {
    const auto messages = [](const BodyRequest& request) {
        return test::error_of([&] { static_cast<void>(make_solid(request)); });
    };
    BodyRequest request = request_for("dirty/d_cube.off");
    request.extrusion.layers = 2;
    test::expect_contains(messages(request), {"d_cube.off: it is the body already", "leave out"});
    request.extrusion = ExtrusionRequest();
    request.target_cells = 1000;
    test::expect_contains(messages(request), {"a number of pentachora is for bodies of four"});
    request = BodyRequest();
    request.input = BallShape{2, 1};
    request.edge_length = 0.1;
    test::expect_contains(messages(request), {"the shape: it is cells already", "leave out"});
    test::expect_contains(message_for(request), {"the shape: it is cells already"});
    request = BodyRequest();
    request.input = BoxShape();
    request.extrusion.thickness = 1;
    test::expect_contains(message_for(request), {"the shape: it is the body already"});
}

TEST(MakeBody, RefusesToMendOrFillWhatIsCellsAlready) {
    const std::vector<std::pair<std::function<void(BodyRequest&)>, const char*>> unheeded = {
        {[](BodyRequest& r) { r.repair.repair = Repair::None; }, "nothing of it is mended"},
        {[](BodyRequest& r) { r.repair.wrap_distance = 0.1; }, "nothing of it is mended"},
        {[](BodyRequest& r) { r.tetrahedra.generator = Generator::Mesh3; }, "is filled"},
        {[](BodyRequest& r) { r.tetrahedra.radius_edge_ratio = 1.2; }, "is filled"},
        {[](BodyRequest& r) { r.tetrahedra.keep_surface = false; }, "is filled"}};
    const test::TempFolder folder;
    test::write_file(folder / "ball.toml", "[[shape]]\nball = { radius = 1 }\n");
    for (const auto& [ask, message] : unheeded) {
        for (const auto& input : std::vector<decltype(BodyRequest::input)>{
                 BallShape{2, 1}, BoxShape{}, folder / "ball.toml"}) {
            BodyRequest request;
            request.input = input;
            request.edge_length = input.index() == 0 ? 0.5 : 0;
            ask(request);
            test::expect_contains(message_for(request), {message, "leave out"});
        }
    }
}

// All of the boundary of the base meets in the point.
TEST(MakeBody, EndsInAPointWhereTheBaseIsBoundedByASphere) {
    const test::TempFolder folder;
    test::write_file(folder / "point.txt", "0 1\n1 0\n");
    const auto ask = [&](bool is_round) {
        BodyRequest request;
        request.extrusion.round = is_round;
        request.extrusion.profile = is_round ? "" : folder / "point.txt";
        return request;
    };
    for (const bool is_round : {false, true}) {
        BodyRequest request = ask(is_round);
        request.input = BallShape{2, 1};
        EXPECT_EQ(check_links(make_body(request).mesh).faulty, 0);
        test::write_file(folder / "two.tobj",
                         "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 3 0 0\nv 4 0 0\nv 3 1 0\n"
                         "v 3 0 1\nt 0 1 2 3\nt 4 5 6 7\n");
        request.input = folder / "two.tobj";
        test::expect_contains(message_for(request),
                              {"two.tobj: a body that ends in a point", "in one piece"});
    }
}

TEST(MakeBody, HasNoSideForRoundBodiesAndProfiles) {
    BodyRequest request;
    request.input = BallShape{2, 1};
    request.extrusion.round = true;
    request.extrusion.anchor = Anchor::Start;
    test::expect_contains(message_for(request), {"one-sided is for straight extrusions"});
    request.extrusion.anchor = Anchor::Middle;
    request.extrusion.layers = 1;
    test::expect_contains(message_for(request), {"a round body of one layer", "2 or more"});
    request.extrusion.layers = 2;
    EXPECT_EQ(make_body(request).report.layers, 2);
}

TEST(MakeBody, ReportsThinPartsWhereTheBodyIs) {
    const test::TempFolder folder;
    test::write_file(folder / "shell.toml",
                     "[[shape]]\nball = { radius = 1 }\n[[shape]]\nop = \"difference\"\n"
                     "ball = { radius = 0.8 }\n");
    BodyRequest request;
    request.input = folder / "shell.toml";
    request.edge_length = 0.25;
    const Body<4> body = make_body(request);
    for (const int axes : {3, 4}) {
        request.translation = Eigen::VectorXd::Constant(axes, 10);
        Eigen::Vector4d way = Eigen::Vector4d::Zero();
        way.head(axes).setConstant(10);
        EXPECT_EQ(make_body(request).report.thin_parts.place, body.report.thin_parts.place + way);
    }
}

TEST(MakeBody, ScalesTheFileAndMovesTheBody) {
    const test::TempFolder folder;
    BodyRequest request = request_for("dirty/d_cube.off");
    request.scale = 2;
    request.translation = Eigen::Vector4d(10, 20, 30, 40);
    request.extrusion.thickness = 3;  // m, whatever the scale of the file
    const Body<4> plain = make_body(request_for("dirty/d_cube.off"));
    const Body<4> body = make_body(request);
    EXPECT_NEAR(body.report.proof.volume, 8 * 3, 1e-12);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_DOUBLE_EQ(body.mesh.positions.row(axis).minCoeff(),
                         2 * plain.mesh.positions.row(axis).minCoeff() + 10 * (axis + 1));
    }
    EXPECT_DOUBLE_EQ(body.mesh.positions.row(3).maxCoeff(), 41.5);
    test::write_file(folder / "a.tobj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nt 0 1 2 3\n");
    BodyRequest tiny;
    tiny.input = folder / "a.tobj";
    tiny.scale = 1e-200;
    test::expect_contains(message_for(tiny), {"a.tobj: the mesh is", "m across", "scale it"});
    request.translation = Eigen::Vector2d(1, 1);
    test::expect_contains(message_for(request), {"a translation of 2 components", "3 or 4"});
    request.translation = Eigen::VectorXd();
    request.scale = 0;
    test::expect_contains(message_for(request), {"a scale of 0", "above 0"});
}

TEST(MakeBody, AnnouncesStagesAndHowLargeItWillBe) {
    BodyRequest request = request_for("dirty/d_cube.off");
    std::vector<std::string> stages;
    std::vector<ExpectedSize> sizes;
    request.edge_length = 0.05;
    request.on_stage = [&](const std::string& stage) { stages.push_back(stage); };
    request.on_size = [&](const ExpectedSize& size) { sizes.push_back(size); };
    const Body<4> body = make_body(request);
    EXPECT_EQ(stages, (std::vector<std::string>{"read", "mend", "fill", "order", "extrude", "prove",
                                                "quality"}));
    ASSERT_EQ(sizes.size(), 2U);
    // An estimate before filling, the number behind it.
    EXPECT_NEAR(std::log2(sizes[0].cells / static_cast<double>(body.mesh.cell_count())), 0, 1);
    EXPECT_EQ(sizes[1].cells, static_cast<double>(body.mesh.cell_count()));
    EXPECT_EQ(sizes[1].layers, body.report.layers);
    // Whoever is told may say no, and no wrap is tried instead.
    request.on_size = [&](const ExpectedSize&) { throw Error("too large"); };
    stages.clear();
    EXPECT_EQ(message_for(request), "too large");
    EXPECT_EQ(stages, (std::vector<std::string>{"read", "mend"}));
}

TEST(MakeSolid, RefusesShapesOfDimensionFour) {
    const test::TempFolder folder;
    test::write_file(folder / "flat.obj", "v 0 0 5\nv 1 0 5\nv 1 1 5\nf 1 2 3\n");
    BodyRequest request;
    request.input = folder / "flat.obj";
    request.extrusion.round = true;
    test::expect_contains(test::error_of([&] { static_cast<void>(make_solid(request)); }),
                          {"round bodies are for dimension 4"});
}

}  // namespace
}  // namespace pent::mesher
