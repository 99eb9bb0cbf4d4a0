#include "apps/run_program.h"
#include "shapes.h"
#include "support/messages.h"

#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

// pent-mesh with shapes, boundaries and images.

namespace pent {
namespace {

using test::Outcome;
using test::run_program;

TEST(PentMesh, MakesShapesWithTheSameBytesAtAnyNumberOfThreads) {
    const test::TempFolder folder;
    const std::string shape = (folder / "shape.toml").string();
    test::write_file(
        shape,
        "[[shape]]\nspherinder = { radius = 0.8, length = 1 }\n[[shape]]\nop = "
        "\"difference\"\nexpression = { formula = \"x^2 + y^2 + z^2 + w^2 - 0.2\", low = "
        "[-1, -1, -1, -1], high = [1, 1, 1, 1] }\n");
    std::string first;
    for (const char* threads : {"1", "2", "3"}) {
        const std::string out = (folder / threads).string() + ".pent";
        const Outcome outcome = run_program("pent-mesh " + shape + " -o " + out
                                            + " --edge-length 0.2 --threads " + threads);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        const std::string bytes = test::text_of(out);
        first = first.empty() ? bytes : first;
        EXPECT_TRUE(bytes == first) << threads << " threads";
    }
    EXPECT_EQ(run_program("pent-check " + (folder / "1.pent").string()).exit_code, 0);
}

// Of the body that comes out, which was scaled and moved: its middle lies at w = 4.
TEST(PentMesh, MakesEdgesLongerAwayFromAPlaceWithTheSameBytesAtAnyNumberOfThreads) {
    const test::TempFolder folder;
    const std::string shape = (folder / "shape.toml").string();
    test::write_file(shape, "[[shape]]\nspherinder = { radius = 0.25, length = 1 }\n");
    const std::string command = "pent-mesh " + shape + " --scale 2 --translate 0,0,0,4 --yes"
                                + " --edge-length 0.2 --size-field ";
    std::string first;
    for (const char* threads : {"1", "2", "3"}) {
        const std::string out = (folder / threads).string() + ".pent";
        const Outcome outcome = run_program(command + "w=3 -o " + out + " --threads " + threads);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        const std::string bytes = test::text_of(out);
        first = first.empty() ? bytes : first;
        EXPECT_TRUE(bytes == first) << threads << " threads";
    }
    const SimplexMesh<4> mesh = read_mesh<4>(folder / "1.pent").mesh;
    const auto below = (mesh.positions.row(3).array() < 3.5).count();
    const auto above = (mesh.positions.row(3).array() > 4.5).count();
    EXPECT_GT(below, 3 * above);
    EXPECT_EQ(run_program("pent-check " + (folder / "1.pent").string()).exit_code, 0);
}

TEST(PentMesh, SaysWhatASizeFieldLacks) {
    const test::TempFolder folder;
    const std::string shape = (folder / "shape.toml").string();
    test::write_file(shape, "[[shape]]\nball = { radius = 1 }\n");
    const std::string command =
        "pent-mesh " + shape + " -o " + (folder / "a.pent").string() + " --edge-length 0.3 ";
    for (const char* place :
         {"v=0", "w=", "0,0,0", "0,0,0,0=1", "1,0,0,0,0", "w=0x", "nan,0,0,0"}) {
        const Outcome outcome = run_program(command + "--size-field " + place);
        EXPECT_EQ(outcome.exit_code, 1) << place;
        test::expect_one_error_line(outcome, "pent-mesh");
        test::expect_contains(outcome.err, {"--size-field: found \"", place, "expected a hyper"});
    }
    const Outcome shorter = run_program(command + "--size-field w=0 --longest-edge 0.1");
    EXPECT_EQ(shorter.exit_code, 1);
    test::expect_contains(shorter.err, {"longest edges of 0.1 m"});
    const Outcome sphere = run_program("pent-mesh --sphere 4 --edge-length 0.3 --size-field w=0 -o "
                                       + (folder / "a.pent").string());
    EXPECT_EQ(sphere.exit_code, 1);
    test::expect_contains(sphere.err, {"a size field is for four-dimensional shapes"});
}

TEST(PentMesh, MakesBodiesOfBoundariesWithTheSameBytesAtAnyNumberOfThreads) {
    const test::TempFolder folder;
    const std::string boundary = (folder / "16-cell.obj").string();
    std::string text;
    for (int i = 0; i < 8; ++i) {
        const char* sign = i < 4 ? "1" : "-1";
        std::string line = "v";
        for (int axis = 0; axis < 4; ++axis) {
            line += std::string(" ") + (i % 4 == axis ? sign : "0");
        }
        text += line + "\n";
    }
    std::string open;
    for (int signs = 0; signs < 16; ++signs) {
        std::string line = "t";
        for (int axis = 0; axis < 4; ++axis) {
            line += " " + std::to_string(axis + 1 + (signs >> axis & 1) * 4);
        }
        open = signs == 5 ? text : open + (open.empty() ? "" : line + "\n");
        text += line + "\n";
    }
    test::write_file(boundary, text);
    std::string first;
    for (const char* threads : {"1", "2", "3"}) {
        const std::string out = (folder / threads).string() + ".pent";
        const Outcome outcome = run_program("pent-mesh " + boundary + " -o " + out
                                            + " --edge-length 0.3 --threads " + threads);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        test::expect_contains(outcome.out, {"boundary   16 tetrahedra, 16 smooth parts"});
        const std::string bytes = test::text_of(out);
        first = first.empty() ? bytes : first;
        EXPECT_TRUE(bytes == first) << threads << " threads";
    }
    EXPECT_EQ(run_program("pent-check " + (folder / "1.pent").string()).exit_code, 0);
    test::write_file(boundary, open);  // without one of its tetrahedra
    const std::string command =
        "pent-mesh " + boundary + " -o " + (folder / "open.pent").string() + " --edge-length 0.3";
    const Outcome refused = run_program(command + " --repair none");
    EXPECT_EQ(refused.exit_code, 1);
    test::expect_contains(refused.err, {"16-cell.obj", "4 open triangles around 1 hole"});
    const Outcome mended = run_program(command);
    EXPECT_EQ(mended.exit_code, 0) << mended.err;
    test::expect_contains(mended.out, {"mended     ", "4 open triangles around 1 hole closed"});
    const Outcome wrapped = run_program(command + " --repair wrap");
    test::expect_contains(wrapped.err, {"--repair light"});
}

TEST(PentMesh, SaysWhereOperationsLeaveLessThanAnEdge) {
    const test::TempFolder folder;
    const std::string shape = (folder / "shell.toml").string();
    const std::string command =
        "pent-mesh " + shape + " -o " + (folder / "a.pent").string() + " --edge-length 0.25 ";
    test::write_file(shape,
                     "[[shape]]\nball = { radius = 1 }\n[[shape]]\nop = \"difference\"\n"
                     "ball = { radius = 0.8 }\n");
    const std::string json = (folder / "a.json").string();
    const Outcome shell = run_program(command + "--json " + json);
    ASSERT_EQ(shell.exit_code, 0) << shell.err;
    test::expect_contains(shell.out, {"\nthin       ", "walls have holes", "m follow it\n"});
    test::expect_contains(test::text_of(json), {"\"thin\": {", "\"width\": 0."});
    // Nothing of it contains a point of the lattice.
    test::write_file(shape,
                     "[[shape]]\nball = { radius = 1 }\n[[shape]]\nop = \"difference\"\n"
                     "ball = { radius = 0.9 }\n");
    const Outcome skin = run_program(command);
    EXPECT_EQ(skin.exit_code, 1);
    test::expect_one_error_line(skin, "pent-mesh");
    test::expect_contains(skin.err, {"thinner than edges of 0.25 m everywhere, as thin as 0.09",
                                     "expected an edge length of at most 0.09"});
}

TEST(PentMesh, SaysWhatIsWrongWithAShape) {
    const test::TempFolder folder;
    const std::string shape = (folder / "shape.toml").string();
    const std::string out = " -o " + (folder / "out.pent").string();
    test::write_file(shape, "[[shape]]\ntigr = { ring_radii = [1, 1], tube_radius = 0.3 }\n");
    const Outcome unknown = run_program("pent-mesh " + shape + " --edge-length 0.2" + out);
    EXPECT_EQ(unknown.exit_code, 1);
    test::expect_one_error_line(unknown, "pent-mesh");
    test::expect_contains(unknown.err, {"shape.toml:2:", "\"tigr\"", "\"tiger\""});
    test::write_file(shape, "[[shape]]\ntiger = { ring_radii = [1, 1], tube_radius = 0.3 }\n");
    const Outcome no_length = run_program("pent-mesh " + shape + out);
    EXPECT_EQ(no_length.exit_code, 1);
    test::expect_contains(no_length.err, {"shape.toml", "--edge-length"});
    const Outcome thin = run_program("pent-mesh " + shape + " --edge-length 0.8" + out);
    EXPECT_EQ(thin.exit_code, 1);
    test::expect_contains(thin.err, {"0.6 m thick", "at most 0.6 m"});
    const std::vector<std::pair<std::string, std::string>> unheeded = {
        {" --edge-length 0.2 --layers 3", "it is the body already"},
        {" --target-pentachora 1000", "leave out triangles and number of pentachora"},
        {" --edge-length 0.2 --dim 3", "a shape of four dimensions"}};
    for (const auto& [options, message] : unheeded) {
        const Outcome outcome = run_program("pent-mesh " + shape + options + out);
        EXPECT_EQ(outcome.exit_code, 1) << options;
        test::expect_contains(outcome.err, {"shape.toml", message.c_str()});
    }
    const Outcome large = run_program("pent-mesh " + shape + " --edge-length 0.05" + out);
    EXPECT_EQ(large.exit_code, 1);
    test::expect_contains(large.err, {"this would make about", "million pentachora", "--yes"});
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pent"));
}

TEST(PentMesh, TakesTheUnitAndThePlaceOfAShape) {
    const test::TempFolder folder;
    const std::string shape = (folder / "shape.toml").string();
    const std::filesystem::path out = folder / "out.pent";
    test::write_file(shape, "[[shape]]\nball = { radius = 50 }\n");
    const Outcome outcome =
        run_program("pent-mesh " + shape + " --unit cm --edge-length 0.25 --translate 1,2,3,4 -o "
                    + out.string());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const Eigen::Matrix4Xd positions = read_mesh<4>(out).mesh.positions;
    const Eigen::Vector4d middle(1, 2, 3, 4);
    const double radius = (positions.colwise() - middle).colwise().norm().maxCoeff();
    EXPECT_NEAR(radius, 0.5, 1e-6 * 0.25);  // the boundary is on the surface to 1e-6 edges
}

// What a file names is read as well.
TEST(PentMesh, NeverWritesWhereAShapeFileReads) {
    const test::TempFolder folder;
    const std::string boundary = (folder / "cube.pent").string();
    ASSERT_EQ(run_program("pent-mesh --box 1,1,1,1 -o " + boundary).exit_code, 0);
    const std::string before = test::text_of(boundary);
    test::write_file(folder / "shape.toml",
                     "[[shape]]\n[[shape.shape]]\nboundary = { file = \"cube.pent\" }\n");
    const std::string start =
        "pent-mesh " + (folder / "shape.toml").string() + " --edge-length 0.3 -o ";
    for (const std::string& command :
         {start + boundary, start + (folder / "a.pent").string() + " --json " + boundary,
          start + (folder / "a.pent").string() + " --histogram " + boundary}) {
        const Outcome outcome = run_program(command);
        EXPECT_EQ(outcome.exit_code, 1) << command;
        test::expect_contains(outcome.err, {"is the same file as a file that the input names"});
        EXPECT_FALSE(std::filesystem::exists(folder / "a.pent"));
    }
    EXPECT_EQ(test::text_of(boundary), before);
    EXPECT_EQ(run_program(start + (folder / "a.pent").string()).exit_code, 0);
}

}  // namespace
}  // namespace pent
