#include "meshes.h"
#include "pictures.h"
#include "runs.h"

#include <pent/viewer/attributes.h>
#include <pent/viewer/coloring.h>
#include <pent/viewer/slice.h>
#include <pent/viewer/slice_run.h>

#include <gtest/gtest.h>

#include <support/messages.h>
#include <support/temp_folder.h>

namespace pent::viewer {
namespace {

using pent::test::error_of;
using pent::test::expect_contains;
using pent::test::TempFolder;
using test::go_on;
using test::text_in;

ColorBy heat() {
    return coloring_of("heat");
}

// A box with a quantity that is linear, one that is a vector, and two of cells.
struct Fields {
    SimplexMesh<4> mesh = test::jittered_box({2, 2, 2, 2}, 5);
    Eigen::RowVector4d slope = Eigen::RowVector4d(1, -2, 0.5, 3);
    MeshExtras<4> extras;

    Fields() {
        extras.vertex_fields = {{"heat", slope * mesh.positions}, {"flow", -mesh.positions}};
        extras.cell_fields = {{"phase", Eigen::MatrixXd::Constant(1, mesh.cell_count(), -7)},
                              {"heat", Eigen::MatrixXd::Zero(1, mesh.cell_count())}};
    }
};

TEST(FieldColors, OfALinearQuantityAreLinearOnASlice) {
    const TempFolder folder;
    const Fields given;
    write_mesh(folder / "a.pent", given.mesh, {}, given.extras);
    const RunFolder run = open_run(folder / "a.pent");
    const std::vector<Body<4>> bodies = load_bodies<4>(run);
    const Frame<4> frame = load_frame<4>(run, bodies[0], 0);
    const Surface surface = slice(bodies[0].boundary, frame.positions, hyperplane_at(0.3));
    const Eigen::VectorXd seen = interpolate(surface, vertex_values<4>(bodies[0], frame, heat()));
    ASSERT_GT(surface.vertex_count(), 8);
    for (Eigen::Index v = 0; v < surface.vertex_count(); ++v) {
        Eigen::Vector4d place;
        place << surface.positions.col(v), 0.3;
        EXPECT_NEAR(seen[v], given.slope * place, 1e-14);
    }
}

TEST(FieldColors, OfVectorsAreLengthsAndOfCellsMeans) {
    const TempFolder folder;
    const Fields given;
    write_mesh(folder / "a.pent", given.mesh, {}, given.extras);
    const RunFolder run = open_run(folder / "a.pent");
    const Body<4> body = load_bodies<4>(run)[0];
    const Frame<4> frame = load_frame<4>(run, body, 0);
    EXPECT_EQ(vertex_values<4>(body, frame, coloring_of("flow")),
              given.mesh.positions.colwise().norm().transpose());
    const Eigen::VectorXd phase = vertex_values<4>(body, frame, coloring_of("phase"));
    ASSERT_EQ(phase.size(), given.mesh.vertex_count());
    EXPECT_LT((phase.array() + 7).abs().maxCoeff(), 1e-14);
    const std::vector<ColorBy> fields = field_colorings<4>(body, frame);
    ASSERT_EQ(fields.size(), 3U);
    EXPECT_EQ(fields[0], heat());
}

// Two tetrahedra, the second twice as large: the mean by volume is a third of the first and two of
// the second.
TEST(VertexMeans, GoByVolume) {
    SimplexMesh<3> mesh;
    mesh.positions.resize(3, 6);
    mesh.positions << 0, 1, 0, 0, 0, 9,  //
        0, 0, 1, 0, 0, 9,                //
        0, 0, 0, 1, -2, 9;
    mesh.cells.resize(4, 2);
    mesh.cells << 0, 0, 1, 2, 2, 1, 3, 4;
    Eigen::MatrixXd values(2, 2);
    values << 3, 6, 0, -3;
    const Eigen::MatrixXd means = vertex_means(mesh, values);
    EXPECT_EQ(means.col(3), Eigen::Vector2d(3, 0));
    EXPECT_EQ(means.col(4), Eigen::Vector2d(6, -3));
    EXPECT_EQ(means.col(5), Eigen::Vector2d(0, 0));  // of no cell
    for (const int v : {0, 1, 2}) {
        EXPECT_LT((means.col(v) - Eigen::Vector2d(5, -2)).norm(), 1e-15);
    }
}

TEST(FieldColors, AreThoseOfTheFrameWhereItHasTheQuantityToo) {
    const Fields given;
    Body<4> body;
    body.fields = given.extras.vertex_fields;
    Frame<4> frame;
    frame.positions = given.mesh.positions;
    EXPECT_EQ(vertex_values<4>(body, frame, heat()),
              given.extras.vertex_fields[0].values.transpose());
    frame.fields = {{"heat", Eigen::MatrixXd::Ones(1, given.mesh.vertex_count())}};
    EXPECT_EQ(vertex_values<4>(body, frame, heat()),
              Eigen::VectorXd::Ones(given.mesh.vertex_count()));
    EXPECT_EQ(field_colorings<4>(body, frame).size(), 2U);
}

// As the bodies have it that pent-mesh makes of a motion: there is no other frame.
TEST(FieldColors, AreThoseOfTheMeshWherePentSimWritesTheQuantityIntoFrames) {
    const Fields given;
    Body<4> body;
    Frame<4> frame;
    frame.positions = given.mesh.positions;
    for (const ColorBy::Kind by : {ColorBy::Reaction, ColorBy::EnergyDensity}) {
        EXPECT_TRUE(lacks(body, frame, by));
        EXPECT_THROW((void)vertex_values<4>(body, frame, by), Error);
        body.fields = {{name_of(by), given.slope * given.mesh.positions}};
        EXPECT_FALSE(lacks(body, frame, by));
        EXPECT_EQ(vertex_values<4>(body, frame, by), body.fields[0].values.transpose());
        EXPECT_TRUE(field_colorings<4>(body, frame).empty());
    }
}

TEST(FieldColors, OfNoQuantityAreRefusedWithThoseThereAre) {
    const Fields given;
    Body<4> body;
    body.name = "box";
    body.fields = given.extras.vertex_fields;
    Frame<4> frame;
    frame.positions = given.mesh.positions;
    frame.frame = 7;
    frame.fields = {{"reaction", given.mesh.positions}};
    expect_contains(
        error_of([&] { (void)vertex_values<4>(body, frame, coloring_of("heta")); }),
        {"frame 7 of \"box\" has nothing called \"heta\"", "did you mean \"heat\"?",
         "There are body, w, speed, strain, force, reaction, energy_density, heat, flow"});
}

// From behind the lowest hundredth to before the highest: quantities may have any zero.
TEST(FieldColors, RangeFromTheLowToTheHigh) {
    Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(1001, 290, 300);
    values[0] = -1e9;
    values[1000] = 1e9;
    const ColorRange range = suitable_range(values, heat());
    EXPECT_NEAR(range.low, 290.1, 1e-9);
    EXPECT_NEAR(range.high, 299.9, 1e-9);
    const ColorRange alone = suitable_range(Eigen::VectorXd::Constant(1, 5), heat());
    EXPECT_EQ(alone.low, 5);
    EXPECT_EQ(alone.high, 5);
}

// Numbers whose squares, or whose distance, are beyond the largest or below the smallest.
TEST(FieldColors, GoFromEndToEndOfAllNumbers) {
    const Fields given;
    Body<4> body;
    for (const double unit : {1e200, 1e-200}) {
        body.fields = {{"flow", unit * given.mesh.positions}};
        Frame<4> frame;
        frame.positions = given.mesh.positions;
        frame.velocities = unit * given.mesh.positions;
        frame.contact_forces = frame.velocities;
        const Eigen::VectorXd expected = given.mesh.positions.colwise().norm().transpose();
        for (const char* name : {"flow", "speed", "force"}) {
            const Eigen::VectorXd found = vertex_values<4>(body, frame, coloring_of(name)) / unit;
            EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-15) << name;
        }
    }
    const ColorRange range = {-1.7e308, 1.7e308};
    for (const double share : {-1.0, -0.5, 0.0, 0.25, 1.0}) {
        EXPECT_NEAR(range.place(share * 1.7e308, heat()), (1 + share) / 2, 1e-15);
    }
    const Eigen::VectorXd ends = Eigen::Vector2d(range.low, range.high);
    const Eigen::Matrix3Xf colors = surface_colors(ends, heat(), range, 0);
    EXPECT_EQ(colors.col(0), map_color(ColorMap::Heat, 0));
    EXPECT_EQ(colors.col(1), map_color(ColorMap::Heat, 1));
}

TEST(FieldColors, AreInTheFilesOfSlicesAndOfBoundaries) {
    const TempFolder folder;
    const Fields given;
    write_mesh(folder / "a.pent", given.mesh, {}, given.extras);
    const RunFolder run = open_run(folder / "a.pent");
    SliceRunOptions options;
    options.frames = run.frames;
    options.format = SurfaceFormat::Vtu;
    options.color = heat();
    options.has_boundary = true;
    (void)slice_run(run, folder / "out", options, go_on);
    EXPECT_NE(text_in(folder / "out/a_000000.vtu").find("Name=\"heat\""), std::string::npos);
    for (const char* name : {"heat", "flow", "phase"}) {
        EXPECT_NE(text_in(folder / "out/a.boundary_000000.vtu")
                      .find(std::string("Name=\"") + name + "\""),
                  std::string::npos);
    }
}

}  // namespace
}  // namespace pent::viewer
