#include "shapes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/mesher/make_body.h>

#include <gtest/gtest.h>

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
}

TEST(MakeBodyFromPlane, ExtrudesAFlatMeshAlongZ) {
    const test::TempFolder folder;
    test::write_file(folder / "flat.obj", "v 0 0 5\nv 1 0 5\nv 1 1 5\nv 0 1 5\nf 1 2 3\nf 1 4 3\n");
    BodyRequest request;
    request.input = folder / "flat.obj";
    request.extrusion.thickness = 2;
    request.extrusion.layers = 4;
    const Body<3> body = make_body_from_plane(request);
    EXPECT_EQ(body.mesh.cell_count(), 2 * 3 * 4);
    EXPECT_NEAR(body.report.proof.volume, 2, 1e-14);
    test::write_file(folder / "flat.obj", "v 0 0 5\nv 1 0 5\nv 1 1 6\nf 1 2 3\n");
    test::expect_contains(test::error_of([&] { static_cast<void>(make_body_from_plane(request)); }),
                          {"flat.obj", "one z"});
}

}  // namespace
}  // namespace pent::mesher
