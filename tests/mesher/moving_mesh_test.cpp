#include "moving_shapes.h"
#include "shapes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/mesher/moving_mesh.h>
#include <pent/mesher/read_tetrahedra.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/space_time.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
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

TEST(ReadMovingMesh, CarriesTheNumbersOfAMeshThatRan) {
    const test::TempFolder folder;
    fs::create_directories(folder / "meshes");
    fs::create_directories(folder / "frames");
    const SimplexMesh<3> mesh = ball(1);
    MeshExtras<3> extras;
    extras.vertex_fields = {{"age", Eigen::RowVectorXd::LinSpaced(mesh.vertex_count(), 0, 1)},
                            {"heat", Eigen::MatrixXd::Zero(1, mesh.vertex_count())},
                            {"flow", mesh.positions}};
    extras.cell_fields = {{"stiffness", Eigen::RowVectorXd::LinSpaced(mesh.cell_count(), 1, 2)},
                          {"lean", Eigen::MatrixXd::Zero(3, mesh.cell_count())},
                          {"heat", Eigen::MatrixXd::Constant(1, mesh.cell_count(), -4)}};
    const std::uint32_t crc = write_mesh<3>(folder / "meshes" / "a.pent", mesh, {}, extras);
    for (int i = 0; i < 2; ++i) {
        Frame<3> frame;
        frame.positions = mesh.positions * (1 + i);
        frame.mesh_name = "a.pent";
        frame.mesh_crc = crc;
        frame.time = i;
        frame.fields.push_back({"heat", Eigen::MatrixXd::Constant(1, mesh.vertex_count(), 5 + i)});
        write_frame(folder / "frames" / frame_file_name("a", i), frame);
    }
    const MovingMesh moving = read_moving_mesh(folder.path());
    EXPECT_EQ(moving.left_out, "vector flow of the mesh, vector lean of the mesh");
    ASSERT_EQ(moving.vertex_fields.size(), 2U);
    EXPECT_EQ(moving.vertex_fields[0].name, "heat");
    EXPECT_EQ(moving.vertex_fields[0].values[1](0, 3), 6);  // of the frame, not of the mesh
    EXPECT_EQ(moving.vertex_fields[1].name, "age");
    ASSERT_EQ(moving.cell_fields.size(), 2U);
    EXPECT_EQ(moving.cell_fields[0].name, "stiffness");
    EXPECT_EQ(moving.cell_fields[1].name, "heat_");  // beside that of the vertices
    EXPECT_EQ(moving.cell_fields[1].values[1], extras.cell_fields[2].values);
    for (int frame = 0; frame < 2; ++frame) {
        EXPECT_EQ(moving.vertex_fields[1].values[frame], extras.vertex_fields[0].values);
        EXPECT_EQ(moving.cell_fields[0].values[frame], extras.cell_fields[0].values);
    }
}

// A run of a body with fibers along x, which turns around z, by the angle of the triangle of sides
// 3, 4 and 5, as it grows to twice its size; its first frame alone has a density of energy.
void write_turning_run(const test::TempFolder& folder) {
    fs::create_directories(folder / "meshes");
    fs::create_directories(folder / "frames");
    SimplexMesh<3> mesh = ball(1);
    mesh.fibers = Eigen::Vector3d::UnitX().replicate(1, mesh.cell_count());
    mesh.fibers.col(4).setZero();
    const std::uint32_t crc = write_mesh(folder / "meshes" / "a.pent", mesh);
    Eigen::Matrix3d turn;
    turn << 1.6, -1.2, 0, 1.2, 1.6, 0, 0, 0, 2;
    for (int i = 0; i < 2; ++i) {
        Frame<3> frame;
        frame.positions = i == 0 ? mesh.positions : Positions<3>(turn * mesh.positions);
        frame.mesh_name = "a.pent";
        frame.mesh_crc = crc;
        frame.time = i;
        frame.fields.push_back({"w", Eigen::MatrixXd::Constant(1, mesh.vertex_count(), i)});
        if (i == 0) {
            frame.fields.push_back({"energy_density", frame.fields[0].values});
        }
        write_frame(folder / "frames" / frame_file_name("a", i), frame);
    }
}

TEST(ReadMovingMesh, TurnsTheFibersOfARunWithItsBody) {
    const test::TempFolder folder;
    write_turning_run(folder);
    const MovingMesh mesh = read_moving_mesh(folder.path());
    ASSERT_EQ(mesh.cell_fields.size(), 1U);
    EXPECT_EQ(mesh.cell_fields[0].name, "fiber");
    for (Eigen::Index cell = 0; cell < mesh.base.cell_count(); ++cell) {
        const double length = cell == 4 ? 0 : 1;
        const Eigen::Vector3d before = mesh.cell_fields[0].values[0].col(cell);
        const Eigen::Vector3d after = mesh.cell_fields[0].values[1].col(cell);
        // Rounding of the inverse of a matrix of order 1 and of condition below 10.
        EXPECT_LT((before - length * Eigen::Vector3d::UnitX()).norm(), 1e-14);
        EXPECT_LT((after - length * Eigen::Vector3d(1.6, 1.2, 0)).norm(), 1e-14);
    }
    EXPECT_EQ(make_space_time(mesh).mesh.fibers.cols(), 4 * mesh.base.cell_count());
}

TEST(ReadMovingMesh, SaysWhatItLeavesOutOfARunAndRenamesWhatWouldBeAnAxis) {
    const test::TempFolder folder;
    write_turning_run(folder);
    const MovingMesh mesh = read_moving_mesh(folder.path());
    EXPECT_EQ(mesh.left_out,
              "quantity energy_density, which some frames do not have in finite numbers");
    ASSERT_EQ(mesh.vertex_fields.size(), 1U);
    EXPECT_EQ(mesh.vertex_fields[0].name, "w_");
}

// Legacy text of arrays: "u" as vectors, "u:1" as numbers, all different.
std::string arrays_text(const std::vector<std::string>& names, int rows) {
    std::string text;
    int number = 0;
    for (const std::string& name : names) {
        const bool is_scalar = name.ends_with(":1");
        const std::string plain = is_scalar ? name.substr(0, name.size() - 2) : name;
        text += is_scalar ? "SCALARS " + plain + " double\nLOOKUP_TABLE default\n"
                          : "VECTORS " + plain + " double\n";
        for (int i = 0; i < rows * (is_scalar ? 1 : 3); ++i) {
            text += std::to_string(++number) + "\n";
        }
    }
    return text;
}

// Reads two frames with these arrays of cells and points, and writes what they sweep.
MeshFile<4> written_with(const test::TempFolder& folder,
                         const std::vector<std::string>& of_cells,
                         const std::vector<std::string>& of_points) {
    const test::VtuParts parts = parts_of(test::kuhn_box<3>({1, 1, 1}, {1, 1, 1}));
    for (const char* name : {"f0.vtk", "f1.vtk"}) {
        test::write_file(folder / name, test::to_legacy_vtk(parts) + "CELL_DATA 6\n"
                                            + arrays_text(of_cells, 6) + "POINT_DATA 8\n"
                                            + arrays_text(of_points, 8));
    }
    const MovingMesh mesh = read_moving_mesh(folder / "f0.vtk", {.time_step = 1});
    EXPECT_EQ(mesh.left_out, "");
    SpaceTimeBody body = make_space_time(mesh);
    write_mesh(folder / "a.pent", body.mesh, {}, body.extras);
    MeshFile<4> file = read_mesh<4>(folder / "a.pent");
    EXPECT_EQ(file.extras.vertex_fields, body.extras.vertex_fields);
    EXPECT_EQ(file.extras.cell_fields, body.extras.cell_fields);
    EXPECT_EQ(file.mesh.fibers, body.mesh.fibers);
    return file;
}

TEST(ReadMovingMesh, GivesQuantitiesNamesByWhichAFileTellsThemApart) {
    const test::TempFolder folder;
    const std::vector<std::string> names = {
        "u",   "u:1",  "u_x:1", "fiber",  "fiber:1",  "fibers",  "fibers:1", "fiber_x:1",
        "x:1", "vx:1", "v0:1",  "region", "parent:1", "layer:1", "a.b:1",    "a_b:1"};
    for (const std::string& first : names) {
        for (const std::string& second : names) {
            if (first.substr(0, first.find(':')) == second.substr(0, second.find(':'))) {
                continue;  // of two with one name the first is carried
            }
            SCOPED_TRACE(first + " " + second);
            const MeshFile<4> file = written_with(folder, {first, second}, {first, second});
            const bool has_fibers = first.starts_with("fiber") || second.starts_with("fiber");
            EXPECT_EQ(file.extras.vertex_fields.size(), 2U);
            EXPECT_EQ(file.extras.cell_fields.size() + (file.mesh.fibers.cols() > 0 ? 1 : 0), 2U);
            EXPECT_TRUE(has_fibers || file.mesh.fibers.cols() == 0);
            for (const VertexField& of_cells : file.extras.cell_fields) {
                for (const VertexField& of_vertices : file.extras.vertex_fields) {
                    EXPECT_NE(of_cells.name, of_vertices.name);
                }
            }
        }
    }
}

TEST(ReadMovingMesh, TakesTheFirstFibersAndRenamesThoseBehindOthers) {
    const test::TempFolder folder;
    for (const auto& names : {std::vector<std::string>{"fibers", "u", "fiber"},
                              std::vector<std::string>{"fiber", "u:1", "fibers"}}) {
        const MeshFile<4> file = written_with(folder, names, {});
        EXPECT_EQ(file.mesh.fibers(0, 0), 1);  // the first number of all
        EXPECT_EQ(file.extras.cell_fields.size(), 2U);
    }
}

TEST(ReadMovingMesh, KeepsFourNumbersThatAreNamedAsAVector) {
    const test::TempFolder folder;
    const std::vector<std::string> names = {"u_x:1", "u_y:1", "u_z:1", "u_w:1"};
    const MeshFile<4> file = written_with(folder, names, names);
    ASSERT_EQ(file.extras.vertex_fields.size(), 4U);
    EXPECT_EQ(file.extras.vertex_fields[3].name, "u_w_");
    EXPECT_EQ(file.extras.cell_fields.size(), 4U);
}

TEST(ReadMovingMesh, TakesAnArrayForRegionsOnlyIfItHasLabels) {
    const test::TempFolder folder;
    const auto write = [&](const std::string& arrays) {
        for (const char* name : {"f0.vtk", "f1.vtk"}) {
            test::write_file(folder / name,
                             test::to_legacy_vtk(parts_of(test::kuhn_box<3>({1, 1, 1}, {1, 1, 1})))
                                 + "CELL_DATA 6\n" + arrays);
        }
    };
    const auto scalars = [](const std::string& name, const std::string& values) {
        return "SCALARS " + name + " double\nLOOKUP_TABLE default\n" + values + "\n";
    };
    const std::string density = scalars("region", "1.5 2 3 4 5 6");
    write(density + scalars("material", "6 5 4 3 2 1"));
    MovingMesh mesh = read_moving_mesh(folder / "f0.vtk", {.time_step = 1});
    EXPECT_EQ(mesh.base.regions, (std::vector<std::uint16_t>{6, 5, 4, 3, 2, 1}));
    ASSERT_EQ(mesh.cell_fields.size(), 1U);
    EXPECT_EQ(mesh.cell_fields[0].name, "region_");
    EXPECT_EQ(read_tetrahedra(folder / "f0.vtk").mesh.regions, mesh.base.regions);
    for (const char* values : {"1.5 2 3 4 5 6", "-1 2 3 4 5 6", "65536 2 3 4 5 6"}) {
        write(scalars("material", values));
        mesh = read_moving_mesh(folder / "f0.vtk", {.time_step = 1});
        EXPECT_TRUE(mesh.base.regions.empty()) << values;
        ASSERT_EQ(mesh.cell_fields.size(), 1U) << values;
        EXPECT_EQ(mesh.cell_fields[0].name, "material");
        EXPECT_TRUE(read_tetrahedra(folder / "f0.vtk").mesh.regions.empty()) << values;
        test::expect_contains(
            test::error_of([&] {
                static_cast<void>(read_moving_mesh(folder / "f0.vtk",
                                                   {.time_step = 1, .region_array = "material"}));
            }),
            {"f0.vtk: array \"material\": cell 0 has ", "from 0 to 65535"});
    }
}

TEST(ReadMovingMesh, CountsTrianglesWithoutALabelAmongWhatIsLeftOut) {
    const test::TempFolder folder;
    test::VtuParts parts = rich_parts(0);
    parts.regions.back() = -1;
    test::write_file(folder / "0.vtu", test::to_vtu(parts, {}));
    const MovingMesh mesh =
        read_moving_mesh(write_pvd(folder.path(), {{0, "0.vtu"}, {1, "0.vtu"}}));
    EXPECT_EQ(mesh.base.regions, (std::vector<std::uint16_t>{3, 4}));
    EXPECT_EQ(mesh.triangles.cols(), 0);
    EXPECT_EQ(mesh.left_out, "1 triangle");
}

// Between two tetrahedra and beside both there is nothing that a label could stand on.
TEST(ReadMovingMesh, CountsTrianglesOffTheBoundaryAmongWhatIsLeftOut) {
    const test::TempFolder folder;
    test::VtuParts parts = rich_parts(0);
    parts.points.conservativeResize(3, 6);
    parts.points.col(5) << 2, 2, 2;
    parts.temperature.push_back(1);
    parts.triangles.resize(3, 4);
    parts.triangles << 0, 1, 3, 1, 1, 2, 2, 4, 2, 3, 1, 5;
    parts.regions = {3, 4, 9, 8, 7, 6};
    parts.cell_vectors.resize(3 * parts.regions.size(), 1);
    test::write_file(folder / "0.vtu", test::to_vtu(parts, {}));
    test::VtuParts later = parts;
    later.points *= 2;
    test::write_file(folder / "1.vtu", test::to_vtu(later, {}));
    const MovingMesh mesh =
        read_moving_mesh(write_pvd(folder.path(), {{0, "0.vtu"}, {1, "1.vtu"}}));
    EXPECT_EQ(mesh.triangle_labels, (std::vector<std::uint16_t>{9}));
    ASSERT_EQ(mesh.triangles.cols(), 1);
    EXPECT_EQ(mesh.triangles.col(0), Eigen::Vector3<std::uint32_t>(0, 1, 2));
    EXPECT_EQ(mesh.left_out, "3 triangles with a label that are not on the boundary");
}

TEST(ReadMovingMesh, CountsCellsOfHigherOrder) {
    const test::TempFolder folder;
    const std::string text =
        "# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 10 double\n"
        "0 0 0 1 0 0 0 1 0 0 0 1 0.5 0 0 0.5 0.5 0 0 0.5 0 0 0 0.5 0.5 0 0.5 0 0.5 0.5\n"
        "CELLS 1 11\n10 0 1 2 3 4 5 6 7 8 9\nCELL_TYPES 1\n24\n";
    test::write_file(folder / "f0.vtk", text);
    test::write_file(folder / "f1.vtk", text);
    const MovingMesh mesh = read_moving_mesh(folder / "f0.vtk", {.time_step = 1});
    EXPECT_EQ(mesh.curved_cells, 1);
    EXPECT_EQ(read_tetrahedra(folder / "f0.vtk").curved_cells, 1);
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
        {"one frame of every 2 leaves one"});
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
    test::VtuParts none = rich_parts(0);
    none.temperature.clear();
    none.cell_vectors.clear();
    test::write_file(folder / "0.vtu", test::to_vtu(none, {"appended"}));
    test::expect_contains(read_moving_mesh(pvd).left_out,
                          {"array temperature, which some", "array flow, which some"});
    test::write_file(folder / "0.vtu", test::to_vtu(first, {"appended"}));
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

// VTK writes a name as one word; what is no byte in two digits is what it is.
TEST(ReadVtk, DecodesTheNamesOfArrays) {
    const test::TempFolder folder;
    const std::string mesh =
        test::to_legacy_vtk({rich_parts(0).points, rich_parts(0).tetrahedra, {}, {}, {}, {}});
    for (const auto& [word, name] : std::vector<std::pair<std::string, std::string>>{
             {"my%20labels", "my labels"}, {"a%25%2f", "a%/"}, {"%4", "%4"}, {"%g1%", "%g1%"}}) {
        const std::vector<std::string> ways = {
            "SCALARS " + word + " int 1\nLOOKUP_TABLE default\n3 4\n",
            "FIELD FieldData 1\n" + word + " 1 2 int\n3 4\n", "GLOBAL_IDS " + word + " int\n3 4\n"};
        for (const std::string& way : ways) {
            test::write_file(folder / "a.vtk", mesh + "CELL_DATA 2\n" + way);
            EXPECT_EQ(read_tetrahedra(folder / "a.vtk", "", name).mesh.regions,
                      (std::vector<std::uint16_t>{3, 4}))
                << way;
        }
    }
}

// Every keyword of arrays that VTK has; the regions stand behind all others.
TEST(ReadVtk, ReadsEveryKindOfArrayInFrontOfTheRegions) {
    const test::TempFolder folder;
    const std::string mesh =
        test::to_legacy_vtk({rich_parts(0).points, rich_parts(0).tetrahedra, {}, {}, {}, {}});
    test::write_file(folder / "a.vtk",
                     mesh + "POINT_DATA 5\nSCALARS heat double\nLOOKUP_TABLE hot\n1 nan 3 -inf 5\n"
                         + "LOOKUP_TABLE hot 1\n0 0 0 1\nMETADATA\nCOMPONENT_NAMES\nVECTORS\n"
                         + "INFORMATION 0\n\nGLOBAL_IDS ids vtkIdType\n0 1 2 3 4\n"
                         + "TEXTURE_COORDINATES uv 2 float\n0 0 0 0 0 0 0 0 0 0\n"
                         + "CELL_DATA 2\nTENSORS6 stress float\n0 0 0 0 0 0 0 0 0 0 0 0\n"
                         + "COLOR_SCALARS paint 3\n0 0 0 1 1 1\nPEDIGREE_IDS old int\n7 8\n"
                         + "EDGE_FLAGS edge int\n0 1\nNORMALS n float\n0 0 1 0 0 1\n"
                         + "FIELD FieldData 3\nname 1 2 string\nleft chamber\n\nflag 1 2 bit\n0 1\n"
                         + "region 1 2 int\n3 4\n");
    EXPECT_EQ(read_tetrahedra(folder / "a.vtk").mesh.regions, (std::vector<std::uint16_t>{3, 4}));
}

// As VTK does: FreeFem writes "Scalars".
TEST(ReadVtk, KnowsKeywordsAndTypesInAnyLetters) {
    const test::TempFolder folder;
    const std::string mesh =
        test::to_legacy_vtk({rich_parts(0).points, rich_parts(0).tetrahedra, {}, {}, {}, {}});
    const std::string text = mesh
                             + "CELL_DATA 2\nSCALARS Label int 1\nLOOKUP_TABLE table\n3\n4\n"
                               "LOOKUP_TABLE table 1\n0 0 0 1\n"
                               "POINT_DATA 5\nFIELD f 1\nheat 1 5 double\n1 2 3 4 5\n";
    std::string small = text;
    std::transform(text.begin(), text.end(), small.begin(), ::tolower);
    std::string capitals = text;
    std::transform(text.begin(), text.end(), capitals.begin(), ::toupper);
    for (const std::string& one : {text, small, capitals}) {
        test::write_file(folder / "a.vtk", one);
        const TetrahedraFile file = read_tetrahedra(folder / "a.vtk");
        EXPECT_EQ(file.mesh.regions, (std::vector<std::uint16_t>{3, 4}));
        ASSERT_EQ(file.extras.vertex_fields.size(), 1U);
        EXPECT_EQ(file.extras.vertex_fields[0].values(0, 4), 5);
    }
}

// As a count that is too small leaves.
TEST(ReadVtk, RefusesWhatStandsBetweenItsParts) {
    const test::TempFolder folder;
    std::string text =
        test::to_legacy_vtk({rich_parts(0).points, rich_parts(0).tetrahedra, {}, {}, {}, {}});
    text.insert(text.find("CELLS"), "7 7 7\n");
    test::write_file(folder / "a.vtk", text);
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read_tetrahedra(folder / "a.vtk")); }),
        {"a.vtk: line 11: found \"7\", expected DATASET, FIELD, POINTS, CELLS"});
    text.erase(text.find("7 7 7\n"), 6);
    test::write_file(folder / "a.vtk", text + "CELL_DATA 2\nSCALARS region int\n3\n4\n");
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read_tetrahedra(folder / "a.vtk")); }),
        {"a.vtk: line ", "found \"3\", expected LOOKUP_TABLE"});
}

// Those of the file itself stand in front of its points, strings among them.
TEST(ReadVtk, PassesOverArraysOfTheFile) {
    const test::TempFolder folder;
    using namespace std::string_literals;
    std::string text =
        test::to_legacy_vtk({rich_parts(0).points, rich_parts(0).tetrahedra, {}, {}, {}, {}});
    text.insert(text.find("POINTS"),
                "FIELD FieldData 3\nTIME 1 1 double\n0.5\nMETADATA\nINFORMATION 0\n\n"
                "name 1 2 string\nPOINTS 3\nright\nbox 3 2 int\n1 2 3 4 5 6\n\n");
    text.insert(text.find("CELLS"), "METADATA\nINFORMATION 1\nNAME L2 LOCATION vtkDataArray\n\n");
    test::write_file(folder / "a.vtk", text);
    EXPECT_EQ(read_tetrahedra(folder / "a.vtk").mesh.cell_count(), 2);
    test::write_file(folder / "a.vtk", text + "METADATA\nINFORMATION 0");  // no line behind it
    EXPECT_EQ(read_tetrahedra(folder / "a.vtk").mesh.cell_count(), 2);
    test::write_file(
        folder / "b.vtk",
        "# vtk DataFile Version 3.0\na\nBINARY\nDATASET UNSTRUCTURED_GRID\n"
        "FIELD FieldData 2\nname 1 1 string\n\xc4left\nCYCLE 1 1 int\n\0\0\0\7\nPOINTS 4 float\n"s
            + "\0\0\0\0\0\0\0\0\0\0\0\0\x3f\x80\0\0\0\0\0\0\0\0\0\0"s
            + "\0\0\0\0\x3f\x80\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x3f\x80\0\0\n"s
            + "CELLS 1 5\n\0\0\0\4\0\0\0\0\0\0\0\1\0\0\0\2\0\0\0\3\n"s
            + "CELL_TYPES 1\n\0\0\0\n\n"s);
    EXPECT_EQ(read_tetrahedra(folder / "b.vtk").mesh.cell_count(), 1);
}

TEST(ReadVtk, ReadsBitsAndStringsAsBytesInFrontOfTheRegions) {
    const test::TempFolder folder;
    using namespace std::string_literals;
    const std::string long_string(70, 's');
    const std::string text =
        "# vtk DataFile Version 3.0\na\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
        + "\0\0\0\0\0\0\0\0\0\0\0\0\x3f\x80\0\0\0\0\0\0\0\0\0\0"s
        + "\0\0\0\0\x3f\x80\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x3f\x80\0\0\n"s
        + "CELLS 1 5\n\0\0\0\4\0\0\0\0\0\0\0\1\0\0\0\2\0\0\0\3\nCELL_TYPES 1\n\0\0\0\n\n"s
        + "POINT_DATA 4\nSCALARS flag bit\nLOOKUP_TABLE default\n\xa0\n"
        + "FIELD f 1\nname 1 4 string\n\xc0\xc2no\x80\x46"s + long_string + "\xc1y\n"
        + "CELL_DATA 1\nFIELD f 2\nflags 9 1 bit\n\xff\x80\nregion 1 1 unsigned_char\n\x07\n";
    std::string in_capitals = text;
    for (const std::string type : {"float", "bit", "string", "unsigned_char"}) {
        std::string capitals = type;
        std::transform(type.begin(), type.end(), capitals.begin(), ::toupper);
        for (std::size_t at = in_capitals.find(" " + type + "\n"); at != std::string::npos;
             at = in_capitals.find(" " + type + "\n")) {
            in_capitals.replace(at + 1, type.size(), capitals);
        }
    }
    for (const std::string& one : {text, in_capitals}) {
        test::write_file(folder / "a.vtk", one);
        EXPECT_EQ(read_tetrahedra(folder / "a.vtk").mesh.regions, (std::vector<std::uint16_t>{7}));
    }
}

TEST(ReadVtk, RefusesArraysCutOffAnywhere) {
    const test::TempFolder folder;
    const std::string mesh =
        test::to_legacy_vtk({rich_parts(0).points, rich_parts(0).tetrahedra, {}, {}, {}, {}});
    const std::string arrays =
        "CELL_DATA 2\nFIELD FieldData 2\nname 1 2 string\nleft\nright\nregion 1 2 int\n3 4";
    for (std::size_t length = 13; length + 2 < arrays.size(); ++length) {
        test::write_file(folder / "a.vtk", mesh + arrays.substr(0, length));
        const std::string error =
            test::error_of([&] { static_cast<void>(read_tetrahedra(folder / "a.vtk")); });
        EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
    test::write_file(folder / "a.vtk",
                     mesh + "CELL_DATA 2\nFIELD FieldData 1\nname 100 2 string\n");
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read_tetrahedra(folder / "a.vtk")); }),
        {"a.vtk: ", "the file ends here; expected a string"});
}

}  // namespace
}  // namespace pent::mesher
