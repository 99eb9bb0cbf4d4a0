#include "moving_shapes.h"
#include "shapes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/mesher/moving_mesh.h>
#include <pent/mesher/shapes.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

namespace pent::mesher {
namespace {

namespace fs = std::filesystem;
using test::parts_of;
using test::rich_parts;
using test::write_pvd;

TEST(ReadMovingMesh, ReadsSeriesOfLegacyFilesAndNumberedOnes) {
    const test::TempFolder folder;
    const SimplexMesh<3> mesh = ball(1);
    for (int i = 0; i < 4; ++i) {
        test::VtuParts parts = parts_of(mesh);
        parts.points *= i + 1;
        test::write_file(folder / formatted("ball_%03d.vtk", 5 * i), test::to_legacy_vtk(parts));
    }
    test::write_file(folder / "ball.vtk.series",
                     R"({"file-series-version": "1.0", "files": [
                        {"name": "ball_000.vtk", "time": 0.5},
                        {"name": "ball_010.vtk", "time": 2}]})");
    const MovingMesh listed = read_moving_mesh(folder / "ball.vtk.series");
    EXPECT_EQ(listed.times, (std::vector<double>{0.5, 2}));
    EXPECT_EQ(listed.positions[1], 3 * mesh.positions);
    const MovingMesh numbered =
        read_moving_mesh(folder / "ball_000.vtk", {.time_step = 0.25, .scale = 0.5});
    EXPECT_EQ(numbered.times, (std::vector<double>{0, 0.25, 0.5, 0.75}));
    EXPECT_EQ(numbered.positions[3], 2 * mesh.positions);
    EXPECT_EQ(numbered.frames[1], "ball_005.vtk");
    const MovingMesh rest = read_moving_mesh(folder / "ball_005.vtk", {.time_step = 1, .every = 2});
    EXPECT_EQ(rest.times, (std::vector<double>{0, 2}));
    EXPECT_EQ(rest.positions[1], 4 * mesh.positions);
    fs::remove(folder / "ball_010.vtk");
    test::expect_contains(
        test::error_of([&] {
            static_cast<void>(read_moving_mesh(folder / "ball_000.vtk", {.time_step = 1}));
        }),
        {"ball_015.vtk: follows ball_005.vtk", "a frame is missing"});
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read_moving_mesh(folder / "ball_000.vtk")); }),
        {"ball_000.vtk: numbered files do not say when they are", "--time-step"});
}

TEST(ReadMovingMesh, ReadsARunFolderOfThreeDimensions) {
    const test::TempFolder folder;
    fs::create_directories(folder / "meshes");
    fs::create_directories(folder / "frames");
    SimplexMesh<3> mesh = ball(1);
    mesh.regions.assign(static_cast<std::size_t>(mesh.cell_count()), 2);
    const std::uint32_t crc = write_mesh(folder / "meshes" / "a.pent", mesh);
    for (int i = 0; i < 3; ++i) {
        Frame<3> frame;
        frame.positions = mesh.positions * (1 + i);
        frame.velocities = mesh.positions;
        frame.mesh_name = "a.pent";
        frame.mesh_crc = crc;
        frame.time = 0.1 * i;
        write_frame(folder / "frames" / frame_file_name("a", i), frame);
    }
    const MovingMesh moving = read_moving_mesh(folder.path());
    EXPECT_EQ(moving.times, (std::vector<double>{0, 0.1, 0.2}));
    EXPECT_EQ(moving.positions[2], 3 * mesh.positions);
    EXPECT_EQ(moving.base.regions, mesh.regions);
    ASSERT_EQ(moving.vertex_fields.size(), 1U);
    EXPECT_EQ(moving.vertex_fields[0].name, "velocity");
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read_moving_mesh(folder.path(), {.body = "b"})); }),
        {"no body \"b\"", "--body: a"});
    mesh.positions *= 2;
    write_mesh(folder / "meshes" / "a.pent", mesh);
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read_moving_mesh(folder.path())); }),
        {"a_000000.pent: is a frame of another mesh"});
    write_mesh(folder / "meshes" / "a.pent", test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1}));
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read_moving_mesh(folder.path())); }),
        {"a.pent: has dimension 4"});
}

TEST(ReadMovingMesh, SaysWhatIsWrongWithASeries) {
    const test::TempFolder folder;
    const SimplexMesh<3> mesh = ball(1);
    const auto write = [&](const std::string& name, const SimplexMesh<3>& what) {
        test::write_file(folder / name, test::to_vtu(parts_of(what), {"binary"}));
    };
    write("0.vtu", mesh);
    SimplexMesh<3> other = mesh;
    std::swap(other.cells(0, 7), other.cells(1, 7));
    write("swapped.vtu", other);
    other = mesh;
    other.cells.conservativeResize(4, mesh.cell_count() - 1);
    write("fewer.vtu", other);
    write("finer.vtu", ball(2));
    const auto message = [&](const std::vector<std::pair<double, std::string>>& frames) {
        const std::string path = write_pvd(folder.path(), frames);
        const std::string error =
            test::error_of([&] { static_cast<void>(read_moving_mesh(path)); });
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
        return error;
    };
    test::expect_contains(
        message({{0, "0.vtu"}, {1, "swapped.vtu"}}),
        {"swapped.vtu: cell 7 has the corners ", "in 0.vtu ", "one connectivity"});
    test::expect_contains(message({{0, "0.vtu"}, {1, "fewer.vtu"}}),
                          {"fewer.vtu: 19 cells", "in 0.vtu 20"});
    test::expect_contains(message({{0, "0.vtu"}, {1, "finer.vtu"}}),
                          {"finer.vtu: ", " points, in"});
    test::expect_contains(message({{0, "0.vtu"}, {1, "gone.vtu"}}), {"gone.vtu: "});
    test::expect_contains(message({{1, "0.vtu"}, {0, "0.vtu"}}),
                          {"a.pvd: line 5: the time 0 behind 1", "times that increase"});
    test::expect_contains(message({{1, "0.vtu"}, {1, "0.vtu"}}),
                          {"a.pvd: line 5: a second file at the time 1"});
    test::expect_contains(message({{1, "0.vtu"}}), {"a.pvd: 1 frame;", "two or more"});
    test::expect_contains(message({}), {"a.pvd: 0 frames;"});
    test::expect_contains(message({{0, "0.vtu"}, {std::nan(""), "0.vtu"}}),
                          {"line 5: timestep \"nan\""});
    test::expect_contains(message({{0, "0.pvtu"}, {1, "0.vtu"}}), {"0.pvtu: "});
    test::expect_contains(
        test::error_of([&] {
            static_cast<void>(read_moving_mesh(
                write_pvd(folder.path(), {{0, "0.vtu"}, {1, "0.vtu"}}), {.every = 2}));
        }),
        {"every 2th frame leaves one"});
    test::expect_contains(test::error_of([&] {
                              static_cast<void>(read_moving_mesh(
                                  write_pvd(folder.path(), {{0, "0.vtu"}, {1, "0.vtu"}}),
                                  {.region_array = "tissue"}));
                          }),
                          {"0.vtu: no array \"tissue\"", "its cells have none"});
}

TEST(ReadMovingMesh, SaysWhichArraysItLeavesOut) {
    const test::TempFolder folder;
    test::VtuParts first = rich_parts(0);
    test::VtuParts second = rich_parts(1);
    second.temperature[2] = std::numeric_limits<double>::quiet_NaN();
    test::write_file(folder / "0.vtu", test::to_vtu(first, {"appended"}));
    test::write_file(folder / "1.vtu", test::to_vtu(second, {"appended"}));
    const std::string pvd = write_pvd(folder.path(), {{0, "0.vtu"}, {1, "1.vtu"}});
    const MovingMesh mesh = read_moving_mesh(pvd);
    EXPECT_TRUE(mesh.vertex_fields.empty());
    test::expect_contains(mesh.left_out, {"array temperature, which some frames"});
    second = rich_parts(1);
    second.regions[1] = 5;
    test::write_file(folder / "1.vtu", test::to_vtu(second, {"appended"}));
    test::expect_contains(test::error_of([&] { static_cast<void>(read_moving_mesh(pvd)); }),
                          {"1.vtu: array \"region\": cell 1 has another label", "--region-array"});
}

TEST(ReadVtk, ReadsArraysOfPointsAndCells) {
    const test::TempFolder folder;
    const std::string text =
        test::to_legacy_vtk({rich_parts(0).points, rich_parts(0).tetrahedra, {}, {}, {}, {}});
    std::string ones;
    for (int i = 0; i < 45; ++i) {
        ones += "1 ";
    }
    const std::string arrays =
        "CELL_DATA 2\nSCALARS material int 1\nLOOKUP_TABLE default\n3\n4\n"
        "POINT_DATA 5\nSCALARS heat double\nLOOKUP_TABLE default\n1 2 3 4 5\n"
        "VECTORS flow float\n1 0 0 2 0 0 3 0 0 4 0 0 5 0 0\n"
        "FIELD FieldData 2\nage 1 5 double\n9 9 9 9 9\nMETADATA\nINFORMATION 0\n\n"
        "stress 9 5 double\n"
        + ones + "\n";
    test::write_file(folder / "f0.vtk", text + arrays);
    test::write_file(folder / "f1.vtk", text + arrays);
    const MovingMesh mesh = read_moving_mesh(folder / "f0.vtk", {.time_step = 1});
    EXPECT_EQ(mesh.base.regions, (std::vector<std::uint16_t>{3, 4}));
    ASSERT_EQ(mesh.vertex_fields.size(), 3U);
    EXPECT_EQ(mesh.vertex_fields[0].values[1](0, 4), 5);
    EXPECT_EQ(mesh.vertex_fields[1].values[0](0, 2), 3);
    EXPECT_EQ(mesh.vertex_fields[2].values[0](0, 0), 9);
    test::expect_contains(mesh.left_out, {"array stress of 9 components"});
    test::write_file(folder / "f1.vtk", text + "POINT_DATA 4\n");
    test::expect_contains(
        test::error_of(
            [&] { static_cast<void>(read_moving_mesh(folder / "f0.vtk", {.time_step = 1})); }),
        {"f1.vtk: line ", "data of 4 points, of 5"});
}

}  // namespace
}  // namespace pent::mesher
