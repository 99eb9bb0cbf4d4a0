#include "run_program.h"
#include "support/messages.h"

#include <pent/pent_file.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

// From a surface file to pictures, by the programs alone, on a small ball.

namespace pent {
namespace {

using test::expect_contains;
using test::expect_one_error_line;
using test::Outcome;
using test::run_program;
using test::text_of;

using Triangle = std::array<int, 3>;

// Writes a sphere of 128 triangles, a twice refined octahedron, and returns the volume in it.
double write_ball(const std::filesystem::path& path) {
    std::vector<Eigen::Vector3d> points = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},
                                           {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    std::vector<Triangle> triangles = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2},
                                       {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
    for (int level = 0; level < 2; ++level) {
        std::map<std::pair<int, int>, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [entry, is_new] = middles.insert({std::minmax(a, b), points.size()});
            if (is_new) {
                points.push_back((points[a] + points[b]).normalized());
            }
            return entry->second;
        };
        std::vector<Triangle> finer;
        for (const Triangle& t : triangles) {
            const int ab = middle(t[0], t[1]);
            const int bc = middle(t[1], t[2]);
            const int ca = middle(t[2], t[0]);
            finer.insert(finer.end(),
                         {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
        }
        triangles = finer;
    }
    std::ofstream file(path);
    file.precision(17);
    for (const Eigen::Vector3d& point : points) {
        file << "v " << point.transpose() << '\n';
    }
    double volume = 0;
    for (const Triangle& t : triangles) {
        file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
        volume += points[t[0]].dot(points[t[1]].cross(points[t[2]])) / 6;
    }
    return volume;
}

constexpr const char* kScene = R"([scene]
gravity = [0, -9.8, 0, 0]
frames = 4
frames_per_second = 30

[[body]]
name = "ball"
mesh = "ball.pent"
material = { model = "stable-neo-hookean", young = 1e4, poisson = 0.28, density = 1000 }

[[constraint]]
body = "ball"
select = { ball = { center = [0, 0, 0, 0], radius = 0.5 } }
motion = { rotate = [{ plane = "yz", degrees_per_s = 360 }, { plane = "wx", degrees_per_s = 180 }] }

[[obstacle]]
half_space = { normal = [0, 1, 0, 0], offset = -1.1 }
)";

class WholeWay : public testing::Test {
protected:
    // The mesh, and a scene beside it.
    void make_mesh() {
        volume_ = write_ball(folder_ / "ball.obj");
        std::ofstream(folder_ / "ball.toml") << kScene;
        const Outcome outcome = run_program("pent-mesh " + path("ball.obj") + " -o "
                                            + path("ball.pent") + " --thickness 0.6 --layers 2");
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    }

    void make_run(const std::string& name = "run", const std::string& options = "") {
        const Outcome outcome =
            run_program("pent-sim " + path("ball.toml") + " -o " + path(name) + " " + options);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    }

    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_ / name).string();
    }

    test::TempFolder folder_;
    double volume_ = 0;
};

TEST_F(WholeWay, MeshHasTheHypervolumeOfSurfaceTimesThickness) {
    make_mesh();
    const SimplexMesh<4> mesh = read_mesh<4>(folder_ / "ball.pent").mesh;
    // Sums of some thousand cells, each rounded once.
    EXPECT_NEAR(total_volume(mesh), volume_ * 0.6, 1e-12);
    EXPECT_EQ(mesh.columns.size(), static_cast<std::size_t>(mesh.vertex_count()));
    EXPECT_EQ(run_program("pent-check " + path("ball.pent")).exit_code, 0);
}

TEST_F(WholeWay, RunHasEveryFrameAndAVerdict) {
    make_mesh();
    const Outcome outcome = run_program("pent-sim " + path("ball.toml") + " -o " + path("run"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_contains(outcome.out, {"finished"});
    const std::uint32_t crc = read_info(folder_ / "run/meshes/ball.pent").crc32c;
    for (int i = 0; i <= 4; ++i) {
        const Frame<4> frame =
            read_frame<4>(folder_ / ("run/frames/ball_00000" + std::to_string(i) + ".pent"));
        EXPECT_EQ(frame.mesh_crc, crc);
        EXPECT_EQ(frame.frame, static_cast<std::uint64_t>(i));
        EXPECT_NEAR(frame.time, i / 30.0, 1e-12);
    }
    EXPECT_TRUE(std::filesystem::exists(folder_ / "run/scene.toml"));
    const auto report = nlohmann::json::parse(text_of(folder_ / "run/report.json"));
    EXPECT_EQ(report.at("verdict"), "finished");
}

TEST_F(WholeWay, FramesAreTheSameForAnyNumberOfThreads) {
    make_mesh();
    make_run("one", "--threads 1");
    make_run("three", "--threads 3");
    for (int i = 0; i <= 4; ++i) {
        const std::string name = "frames/ball_00000" + std::to_string(i) + ".pent";
        EXPECT_EQ(text_of(folder_ / "one" / name), text_of(folder_ / "three" / name)) << i;
    }
}

TEST_F(WholeWay, RunCanBeRepeatedFromItsOwnScene) {
    make_mesh();
    make_run("first");
    // Defaults are filled in; the mesh it names must be found from where the scene is now.
    const Outcome outcome =
        run_program("pent-sim " + path("first/scene.toml") + " -o " + path("second"));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(text_of(folder_ / "first/frames/ball_000004.pent"),
              text_of(folder_ / "second/frames/ball_000004.pent"));
}

TEST_F(WholeWay, UsedRunFolderIsRefusedUnlessForced) {
    make_mesh();
    make_run();
    const std::string before = text_of(folder_ / "run/report.json");
    const Outcome outcome = run_program("pent-sim " + path("ball.toml") + " -o " + path("run"));
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, "pent-sim");
    expect_contains(outcome.err, {path("run"), "--force"});
    EXPECT_EQ(text_of(folder_ / "run/report.json"), before);
    make_run("run", "--force");
}

TEST_F(WholeWay, MistakeInASceneIsNamedWithItsPlaceAndTheNearestName) {
    make_mesh();
    std::string scene = kScene;
    scene.replace(scene.find("gravity"), 7, "gravitiy");
    std::ofstream(folder_ / "ball.toml") << scene;
    const Outcome outcome = run_program("pent-sim " + path("ball.toml") + " -o " + path("run"));
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, "pent-sim");
    expect_contains(outcome.err, {"ball.toml:2:1", "gravitiy", "gravity"});
    EXPECT_FALSE(std::filesystem::exists(folder_ / "run"));
}

TEST_F(WholeWay, SlicesAndPicturesComeOut) {
    make_mesh();
    make_run();
    const Outcome slices =
        run_program("pent-slice " + path("run") + " -o " + path("slices") + " --w -0.1,0,0.1");
    EXPECT_EQ(slices.exit_code, 0) << slices.err;
    int surfaces = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "slices")) {
        surfaces += entry.path().extension() == ".ply" ? 1 : 0;
    }
    EXPECT_EQ(surfaces, 5 * 3);
    const Outcome picture =
        run_program("pent-render " + path("run") + " -o " + path("p.png") + " --size 160x90");
    EXPECT_EQ(picture.exit_code, 0) << picture.err;
    EXPECT_EQ(text_of(folder_ / "p.png").substr(1, 3), "PNG");
    const Outcome sheet =
        run_program("pent-render " + path("run") + " --sheet " + path("s.png") + " --size 160x90");
    EXPECT_EQ(sheet.exit_code, 0) << sheet.err;
    EXPECT_EQ(text_of(folder_ / "s.png").substr(1, 3), "PNG");
}

// A movie is whole or not there; pictures of frames stay.
TEST_F(WholeWay, StoppedPicturesSayWhatIsLeft) {
    const Outcome box = run_program("pent-mesh --box 1,1,1,1 -o " + path("box.pent"));
    ASSERT_EQ(box.exit_code, 0) << box.err;
    const std::string many = path("box.pent") + " --sweep --w -0.4:0.4:5000 --size 64x48 -o ";
    const Outcome pictures = run_program("pent-render " + many + path("pictures/"),
                                         test::interrupt_at(folder_ / "pictures/000000_s00.png"));
    EXPECT_EQ(pictures.exit_code, 3) << pictures.err;
    expect_contains(pictures.out, {"stopped: ", "; frames are in " + path("pictures")});
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) {  // NOLINT(cert-env33-c)
        GTEST_SKIP() << "there is no ffmpeg";
    }
    const Outcome movie = run_program("pent-render " + many + path("movie.mp4"),
                                      test::interrupt_at(folder_ / ".movie.mp4.*"));
    EXPECT_EQ(movie.exit_code, 3) << movie.err;
    expect_contains(movie.out, {"stopped: ", "; " + path("movie.mp4") + " is not written"});
    EXPECT_FALSE(std::filesystem::exists(folder_ / "movie.mp4"));
}

// A limit on file size stands for a full disk: the same calls fail, in the same place.
TEST_F(WholeWay, FullDiskIsOneLineAndLeavesNothingHalfWritten) {
    make_mesh();
    const std::string limit = test::full_disk(4096);
    const Outcome mesh = run_program(
        "pent-mesh " + path("ball.obj") + " -o " + path("full.pent") + " --thickness 0.6", limit);
    EXPECT_EQ(mesh.exit_code, 1);
    expect_one_error_line(mesh, "pent-mesh");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "full.pent"));

    const Outcome run = run_program("pent-sim " + path("ball.toml") + " -o " + path("full"), limit);
    EXPECT_EQ(run.exit_code, 1);
    expect_one_error_line(run, "pent-sim");
    expect_contains(run.err, {"full", "cannot be written"});
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
        EXPECT_EQ(entry.path().string().find(".tmp"), std::string::npos) << entry.path();
        if (entry.path().extension() == ".pent") {
            EXPECT_NO_THROW((void)read_info(entry.path())) << entry.path();
        }
    }
}

TEST_F(WholeWay, OpenSurfaceIsRefusedOrMendedButNeverMeshedAsIs) {
    make_mesh();
    std::string surface = text_of(folder_ / "ball.obj");
    surface.resize(surface.rfind("f "));
    std::ofstream(folder_ / "open.obj") << surface;
    const Outcome outcome = run_program("pent-mesh " + path("open.obj") + " -o " + path("open.pent")
                                        + " --thickness 0.6 --repair none");
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, "pent-mesh");
    expect_contains(outcome.err, {"open.obj", "border"});
    EXPECT_FALSE(std::filesystem::exists(folder_ / "open.pent"));
}

// The numbers of an array of a file of VTK that pent-slice has written.
std::vector<double> array_of(const std::string& vtu, const std::string& name) {
    const std::size_t at = vtu.find("Name=\"" + name + "\"");
    const std::size_t offset = vtu.find("offset=\"", at) + 8;
    const char* const block =
        vtu.data() + vtu.find("encoding=\"raw\">\n_") + 17 + std::stoul(vtu.substr(offset, 12));
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, block, sizeof bytes);
    std::vector<double> values(bytes / sizeof(double));
    std::memcpy(values.data(), block + sizeof bytes, bytes);
    return values;
}

// Of two tetrahedra of Gmsh, with a quantity of the nodes that is linear in space.
TEST(Quantities, OfGmshGoThroughTheMeshIntoFilesOfVtk) {
    const test::TempFolder folder;
    std::ofstream(folder / "a.msh") << R"msh($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
10 0 0 0
20 1 0 0
30 0 1 0
40 0 0 1
50 -1 0 0
$EndNodes
$Elements
2
7 4 2 5 1 10 20 30 40
3 4 2 6 1 10 50 30 40
$EndElements
$NodeData
1
"warmth (K)"
1
0
3
0
1
5
50 1
40 3.5
30 2
20 5
10 3
$EndNodeData
)msh";
    const auto warmth = [](double x, double y, double z) { return 3 + 2 * x - y + 0.5 * z; };
    const Outcome made = run_program("pent-mesh " + (folder / "a.msh").string() + " -o "
                                     + (folder / "a.pent").string() + " --layers 2");
    ASSERT_EQ(made.exit_code, 0) << made.err;
    expect_contains(made.out, {"carried    warmth__K_\n"});
    const auto body = read_mesh<4>(folder / "a.pent");
    ASSERT_EQ(body.extras.vertex_fields.size(), 1U);
    for (Eigen::Index v = 0; v < body.mesh.vertex_count(); ++v) {
        const auto x = body.mesh.positions.col(v);
        EXPECT_EQ(body.extras.vertex_fields[0].values(0, v), warmth(x[0], x[1], x[2]));
    }
    const Outcome sliced = run_program("pent-slice " + (folder / "a.pent").string() + " -o "
                                       + (folder / "out").string() + " --boundary");
    ASSERT_EQ(sliced.exit_code, 0) << sliced.err;
    const std::string vtu = text_of(folder / "out" / "a.boundary_000000.vtu");
    const std::vector<double> points = array_of(vtu, "points");
    const std::vector<double> values = array_of(vtu, "warmth__K_");
    ASSERT_EQ(values.size(), 15U);
    ASSERT_EQ(points.size(), 45U);
    for (std::size_t v = 0; v < values.size(); ++v) {
        EXPECT_EQ(values[v], warmth(points[3 * v], points[3 * v + 1], points[3 * v + 2]));
    }
}

}  // namespace
}  // namespace pent
