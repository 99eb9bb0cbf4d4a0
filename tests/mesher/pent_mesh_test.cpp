#include "apps/run_program.h"
#include "shapes.h"
#include "support/messages.h"

#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace pent {
namespace {

using test::Outcome;
using test::run_program;

const std::string kModels = PENT_MODELS;

TEST(PentMesh, MakesTheSameBytesAtAnyNumberOfThreads) {
    const test::TempFolder folder;
    std::string first;
    for (const char* threads : {"1", "2", "3"}) {
        const std::string out = (folder / threads).string() + ".pent";
        const Outcome outcome = run_program("pent-mesh " + kModels + "/octopus_5246f.obj -o " + out
                                            + " --layers 3 --threads " + threads);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        const std::string bytes = test::text_of(out);
        first = first.empty() ? bytes : first;
        EXPECT_TRUE(bytes == first) << threads << " threads";
    }
}

// Of bodies that are translated, leaning, round, from a file, and of regions.
TEST(PentMesh, WritesBaseAndLayersThatAreReadAsTheMesh) {
    const test::TempFolder folder;
    for (const std::string& options :
         {std::string("--ball 2 --layers 3 --translate 0.1,0.2,0.3,0.7"),
          std::string("--ball 2 --extrude 0.1,0.2,0.3,-0.5 --order quality --lean"),
          std::string("--ball 2 --round --layers 5"),
          kModels + "/octopus_5246f.obj --surface-triangles 600 --layers 2 --one-sided"}) {
        const auto make = [&](const std::string& more, const std::string& name) {
            const Outcome made =
                run_program("pent-mesh " + options + more + " -o " + (folder / name).string());
            ASSERT_EQ(made.exit_code, 0) << made.err;
        };
        make("", "mesh.pent");
        make(" --unextruded", "base.pent");
        EXPECT_LT(std::filesystem::file_size(folder / "base.pent"),
                  std::filesystem::file_size(folder / "mesh.pent") / 2);
        const FileInfo info = read_info(folder / "base.pent");
        EXPECT_TRUE(info.is_extrusion);
        write_mesh(folder / "read.pent", read_mesh<4>(folder / "base.pent").mesh,
                   {.created_by = info.created_by});
        EXPECT_EQ(test::text_of(folder / "read.pent"), test::text_of(folder / "mesh.pent"))
            << options;
        EXPECT_EQ(run_program("pent-check " + (folder / "base.pent").string()).exit_code, 0);
    }
    for (const char* other : {"--box 1,1,1,1", "--ball 1 --subdivide 2", "--ball 1 --quadratic"}) {
        const Outcome refused = run_program(std::string("pent-mesh --unextruded ") + other + " -o "
                                            + (folder / "no.pent").string());
        EXPECT_EQ(refused.exit_code, 1) << other;
        test::expect_contains(refused.err, {"base"});
    }
}

TEST(PentMesh, GradesItsLayers) {
    const test::TempFolder folder;
    const std::string out = " -o " + (folder / "a.pent").string();
    test::expect_contains(
        run_program("pent-mesh --ball 2 --layer-heights 0.1,0.4 --json "
                    + (folder / "r.json").string() + out)
            .out,
        {"extrusion  1 m along w, 4 layers, the thinnest 0.1 m, the thickest 0.4 m",
         "w -0.5 to 0.5 m"});
    test::expect_contains(test::text_of(folder / "r.json"),
                          {"\"thinnest_layer\": 0.1", "\"thickest_layer\": 0.4"});
    test::expect_contains(
        run_program("pent-mesh --ball 2 --thickness 1 --layers 200 --grade 1.5" + out).err,
        {"200 layers", "grade nearer to 1"});
}

TEST(PentMesh, SaysWhatItMadeAndWhere) {
    const test::TempFolder folder;
    const std::string out = (folder / "cube.pent").string();
    const Outcome outcome = run_program("pent-mesh " + kModels + "/dirty/d_cube.off -o " + out
                                        + " --quality --json " + (folder / "report.json").string()
                                        + " --histogram " + (folder / "histogram.svg").string());
    EXPECT_EQ(outcome.exit_code, 0);
    for (const char* part : {"24 pentachora", "0.2 m^4", "worst cells", "finished: "}) {
        EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
    }
    EXPECT_NE(test::text_of(folder / "report.json").find("\"verdict\": \"finished\""),
              std::string::npos);
    EXPECT_EQ(test::text_of(folder / "histogram.svg").rfind("<svg", 0), 0U);
    EXPECT_EQ(run_program("pent-check " + out).exit_code, 0);
}

TEST(PentMesh, SaysWhichCellsItCutAndLeftOut) {
    const test::TempFolder folder;
    // A tetrahedron with middles of its edges, a prism at its side, a triangle.
    test::write_file(folder / "mixed.mesh",
                     "MeshVersionFormatted 2\nDimension 3\nVertices 7\n0 0 0 0\n1 0 0 0\n0 1 0 0\n"
                     "0 0 1 0\n0 0 -1 0\n1 0 -1 0\n0 1 -1 0\nTetrahedraP2 1\n"
                     "1 2 3 4 1 1 1 1 1 1 0\nPrisms 1\n5 6 7 1 2 3 0\nTriangles 1\n5 7 6 0\nEnd\n");
    const Outcome outcome = run_program("pent-mesh " + (folder / "mixed.mesh").string()
                                        + " --thickness 1 -o " + (folder / "mixed.pent").string()
                                        + " --json " + (folder / "report.json").string());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    test::expect_contains(outcome.out,
                          {"cut        1 prism into 3 tetrahedra\n",
                           "straight   1 cell of higher order, by their corners alone\n",
                           "left out   1 triangle: no part of a body\n"});
    test::expect_contains(
        test::text_of(folder / "report.json"),
        {R"("cut": "1 prism into 3 tetrahedra")", R"("left_out": "1 triangle")", R"("curved": 1)"});
}

TEST(PentMesh, ExtrudesAFlatMeshIn3D) {
    const test::TempFolder folder;
    test::write_file(folder / "flat.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    const std::string out = (folder / "flat.pent").string();
    EXPECT_EQ(
        run_program("pent-mesh " + (folder / "flat.obj").string() + " --dim 3 -o " + out).exit_code,
        0);
    EXPECT_NE(run_program("pent-check " + out).out.find("dimension 3"), std::string::npos);
}

TEST(PentMesh, MakesBodiesOfThreeDimensions) {
    const test::TempFolder folder;
    const std::string out = " --dim 3 -o " + (folder / "a.pent").string();
    test::write_file(folder / "corner.msh",
                     "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"
                     "4 0 0 1\n$EndNodes\n$Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n");
    const std::vector<std::pair<std::string, std::string>> wanted = {
        {(folder / "corner.msh").string(), "1 tetrahedron, 0.1666666667 m^3"},
        {kModels + "/dirty/d_cube.off", "6 tetrahedra, 1 m^3"},
        {"--ball 3", "180 tetrahedra"},
        {"--box 2,2,2 --size 1", "48 tetrahedra, 1 m^3"}};
    for (const auto& [input, said] : wanted) {
        const Outcome outcome = run_program("pent-mesh " + input + out);
        EXPECT_EQ(outcome.exit_code, 0) << input << ": " << outcome.err;
        test::expect_contains(outcome.out, {said, "proved "});
        test::expect_contains(run_program("pent-check " + (folder / "a.pent").string()).out,
                              {"dimension 3", said, "is sound"});
    }
}

TEST(PentMesh, TakesUnitsScaleAndPlaceAndSaysTheBoxAround) {
    const test::TempFolder folder;
    const std::string out = (folder / "a.pent").string();
    const std::string cube = "pent-mesh " + kModels + "/dirty/d_cube.off --dim 3 -o " + out;
    const std::string moved = "box        x 10 to 10.5, y 0 to 0.5, z -1 to -0.5 m\n";
    test::expect_contains(run_program(cube + " --unit mm --scale 500 --translate 10,0,-1").out,
                          {moved});
    test::expect_contains(run_program("pent-check " + out).out, {moved});
    test::expect_contains(
        run_program(cube + " --unit cm --json " + (folder / "r.json").string()).out,
        {"x 0 to 0.01, y 0 to 0.01, z 0 to 0.01 m"});
    test::expect_contains(test::text_of(folder / "r.json"), {R"("high": [)", "0.01"});
    EXPECT_EQ(run_program("pent-mesh --ball 2 --unit mm -o " + out).exit_code, 2);
    EXPECT_EQ(run_program(cube + " --scale -1").exit_code, 2);
    EXPECT_EQ(run_program(cube + " --translate 1,2").exit_code, 2);
}

TEST(PentMesh, KnowsEndingsInCapitalsAndArraysOfRegions) {
    const test::TempFolder folder;
    const std::string out = (folder / "A.PENT").string();
    test::write_file(
        folder / "a.vtk",
        "# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\n"
        "POINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\n"
        "CELL_TYPES 1\n10\nCELL_DATA 1\nSCALARS tissue int\nLOOKUP_TABLE default\n9\n");
    const std::string command =
        "pent-mesh " + (folder / "a.vtk").string() + " --dim 3 -o " + out + " --region-array ";
    const Outcome outcome = run_program(command + "tissue");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(read_mesh<3>(out).mesh.regions, std::vector<std::uint16_t>{9});
    test::expect_contains(run_program(command + "bone").err, {"no array \"bone\"", "tissue"});
    test::expect_contains(
        run_program("pent-mesh " + kModels + "/dirty/d_cube.off --region-array a" + " -o " + out)
            .err,
        {"d_cube.off: ", "tet meshes of VTK", "leave it out"});
    EXPECT_EQ(run_program("pent-mesh --ball 2 --region-array a -o " + out).exit_code, 2);
}

TEST(PentMesh, ReadsStandardInput) {
    const test::TempFolder folder;
    const std::string to_a = " -o " + (folder / "a.pent").string();
    const auto piped = [&](const std::string& file, const std::string& options) {
        const std::string line = "cat " + file + " | " PENT_BIN "/pent-mesh - " + options + to_a
                                 + " >" + (folder / "out").string() + " 2>&1";
        static_cast<void>(std::system(line.c_str()));  // NOLINT(cert-env33-c)
        return test::text_of(folder / "out");
    };
    test::expect_contains(piped(kModels + "/dirty/d_cube.off", "--format off"), {"finished: "});
    test::expect_contains(piped(kModels + "/dirty/d_cube.off", ""),
                          {"pent-mesh: standard input: ", "give the format"});
    test::write_file(folder / "a.tobj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nt 0 1 2\n");
    test::expect_contains(piped((folder / "a.tobj").string(), "--format tobj"),
                          {"pent-mesh: standard input: line 5: "});
    test::expect_contains(piped(kModels + "/dirty/d_cube.off", "--format glb"),
                          {"--format", "obj"});
}

TEST(PentMesh, NeverWritesWhereItReads) {
    namespace fs = std::filesystem;
    const test::TempFolder folder;
    const fs::path cube = folder / "cube.off";
    fs::copy_file(kModels + "/dirty/d_cube.off", cube);
    const std::string before = test::text_of(cube);
    fs::create_symlink(cube, folder / "link.pent");
    fs::create_hard_link(cube, folder / "hard.pent");
    test::write_file(folder / "T.NODE", "4 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n");
    test::write_file(folder / "T.ELE", "1 4\n1 1 2 3 4\n");
    const std::string pair =
        "pent-mesh " + (folder / "T.NODE").string() + " -o " + (folder / "a.pent").string();
    test::write_file(folder / "lean.txt", "0 1\n1 1\n");
    const std::string start = "pent-mesh " + cube.string() + " -o ";
    const std::string good = start + (folder / "a.pent").string();
    for (const std::string& command :
         {start + (folder / "link.pent").string(), start + (folder / "hard.pent").string(),
          good + " --json " + cube.string(), good + " --histogram " + cube.string(),
          good + " --json " + (folder / "a.pent").string(),
          pair + " --json " + (folder / "T.ELE").string(),
          good + " --profile " + (folder / "lean.txt").string() + " --json "
              + (folder / "lean.txt").string()}) {
        const Outcome outcome = run_program(command);
        EXPECT_EQ(outcome.exit_code, 1) << command;
        test::expect_one_error_line(outcome, "pent-mesh");
        test::expect_contains(outcome.err, {" is the same file as ", "give it another name"});
        EXPECT_FALSE(fs::exists(folder / "a.pent"));
    }
    EXPECT_EQ(test::text_of(cube), before);
    EXPECT_EQ(test::text_of(folder / "lean.txt"), "0 1\n1 1\n");
}

TEST(PentMesh, WritesPentFilesIntoFoldersThatItMakes) {
    const test::TempFolder folder;
    const Outcome other = run_program("pent-mesh --ball 1 -o " + (folder / "x.obj").string());
    EXPECT_EQ(other.exit_code, 1);
    test::expect_one_error_line(other, "pent-mesh");
    test::expect_contains(other.err, {"x.obj: a mesh is a .pent file", "x.pent"});
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    const std::string out = (folder / "new" / "sub" / "x.pent").string();
    const std::string report = (folder / "reports" / "a.json").string();
    const std::string histogram = (folder / "pictures" / "a.svg").string();
    EXPECT_EQ(run_program("pent-mesh --ball 1 --layers 1 -o " + out + " --json " + report
                          + " --histogram " + histogram)
                  .exit_code,
              0);
    for (const std::string& file : {out, report, histogram}) {
        EXPECT_TRUE(std::filesystem::exists(file)) << file;
    }
    EXPECT_EQ(run_program("pent-mesh --ball 1 --layers 1 -o /dev/null").exit_code, 0);
}

TEST(PentMesh, AsksBeforeItMakesMillionsOfCells) {
    const test::TempFolder folder;
    const std::string out = " -o " + (folder / "a.pent").string();
    const std::string octopus = "pent-mesh " + kModels + "/octopus_5246f.obj";
    for (const std::string& command :
         {octopus + " --edge-length 0.01", octopus + " --layers 100000",
          std::string("pent-mesh --ball 4 --layers 10000"),
          std::string("pent-mesh --box 100,100,10,10"),
          std::string("pent-mesh --ball 1 --layers 1 --subdivide 64")}) {
        const Outcome outcome = run_program(command + out);
        EXPECT_EQ(outcome.exit_code, 1) << command;
        test::expect_one_error_line(outcome, "pent-mesh");
        test::expect_contains(outcome.err,
                              {"this would make about ", "illion pentachora", " of work", "--yes"});
        EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    }
}

TEST(PentMesh, SaysWhatAValueShouldHaveBeen) {
    const auto message = [](const std::string& option) {
        const Outcome outcome = run_program("pent-mesh --ball 1 -o a.pent " + option);
        EXPECT_EQ(outcome.exit_code, 2) << option;
        return outcome.err;
    };
    test::expect_contains(message("--thickness abc"),
                          {R"(--thickness: found "abc"; expected a number)"});
    test::expect_contains(message("--scale twice"), {"--scale", "twice"});
    test::expect_contains(message("--layers many"), {"--layers", "many", "1 to 1000000"});
    test::expect_contains(message("--memory-limit 1e14"), {"--memory-limit", "1000000000"});
    test::expect_contains(message("--cut corners"), {"--cut requires --box"});
    test::expect_contains(message("--repair some"),
                          {R"(--repair: found "some"; expected auto, light, wrap or none)"});
    test::expect_contains(message("--dim 5"), {R"(--dim: found "5"; expected 4 or 3)"});
    test::expect_contains(message("--time-limit nan"),
                          {R"(found "nan"; expected a number above 0)"});
    const Outcome file =
        run_program("pent-mesh " + kModels + "/octopus_5246f.obj -o a.pent --size 2");
    EXPECT_EQ(file.exit_code, 2);
    test::expect_contains(file.err, {"--size excludes input"});
    const Outcome radii = run_program("pent-mesh --ball 1 -o a.pent --size 1,2");
    EXPECT_EQ(radii.exit_code, 1);
    test::expect_contains(radii.err, {"--size: found 2 numbers; expected one, the radius"});
    for (const char* sizes : {"--box 2,2,2 --dim 3 --size 1,1", "--box 2,2,2,2 --size 1,1",
                              "--box 2,2,2,2 --size 1,1,1", "--box 2,2,2 --dim 3 --size 1,1,1,1"}) {
        const Outcome sides = run_program(std::string("pent-mesh -o a.pent ") + sizes);
        EXPECT_EQ(sides.exit_code, 1) << sizes;
        test::expect_contains(sides.err,
                              {"--size: found ", "expected one, or one for each of the "});
    }
}

TEST(PentMesh, SaysWhatToTryWhereLightMendingIsNotEnough) {
    const test::TempFolder folder;
    // Two cubes that share one corner: closed, but no boundary of one body there.
    const Outcome outcome =
        run_program("pent-mesh " + kModels + "/dirty/d_sharevertex.off --repair light -o "
                    + (folder / "a.pent").string());
    EXPECT_EQ(outcome.exit_code, 1);
    test::expect_contains(outcome.err, {"light mending is not enough", "--repair wrap"});
}

TEST(PentMesh, SaysInItsOwnWordsWhyNoFileHasSuchAName) {
    const std::string name(300, 'x');
    for (const std::string& line :
         {"pent-mesh " + name + ".obj -o a.pent", "pent-mesh " + name + ".msh -o a.pent",
          "pent-mesh --ball 1 --profile " + name + " -o a.pent", "pent-check " + name,
          "pent-mesh --ball 1 --layers 1 -o " + name + ".pent",
          "pent-mesh --ball 1 --edge-directions " + name + " -o a.pent"}) {
        const Outcome outcome = run_program(line);
        EXPECT_EQ(outcome.exit_code, 1);
        const std::string program = line.substr(0, line.find(' '));
        test::expect_one_error_line(outcome, program);
        EXPECT_EQ(outcome.err.find("filesystem error"), std::string::npos) << outcome.err;
        test::expect_contains(outcome.err, {"File name too long"});
    }
}

TEST(PentMesh, FindsItsWorkerWhereItIsInstalled) {
    namespace fs = std::filesystem;
    const test::TempFolder folder;
    fs::create_directories(folder / "bin");
    fs::create_directories(folder / "libexec/pent");
    fs::copy_file(PENT_BIN "/pent-mesh", folder / "bin/pent-mesh");
    const auto generator = [&] {
        const std::string line = (folder / "bin/pent-mesh").string() + " " + kModels
                                 + "/dirty/d_cube.off --quiet -o " + (folder / "cube.pent").string()
                                 + " --json " + (folder / "report.json").string();
        EXPECT_EQ(std::system(line.c_str()), 0);  // NOLINT(cert-env33-c)
        return test::text_of(folder / "report.json");
    };
    test::expect_contains(generator(), {R"("generator": "CGAL Mesh_3")", "pent-tetgen: not found"});
    fs::copy_file(PENT_BIN "/pent-tetgen", folder / "libexec/pent/pent-tetgen");
    test::expect_contains(generator(), {R"("generator": "TetGen )"});
}

TEST(PentMesh, LeavesNothingBehindWhenItRefuses) {
    const test::TempFolder folder;
    const std::string out = (folder / "out.pent").string();
    const Outcome outcome =
        run_program("pent-mesh " + kModels + "/dirty/d_open.off --repair none -o " + out);
    EXPECT_EQ(outcome.exit_code, 1);
    test::expect_one_error_line(outcome, "pent-mesh");
    EXPECT_NE(outcome.err.find("3 border edges"), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(PentMesh, GivesUpAfterItsTimeLimit) {
    const test::TempFolder folder;
    // In the foreground: else the signal comes twice, and the second ends the program at once.
    const Outcome outcome = run_program(
        "pent-mesh " + kModels + "/octopus_5246f.obj --yes --edge-length 0.005 --time-limit 1 -o "
        + (folder / "out.pent").string() + " --json " + (folder / "report.json").string());
    EXPECT_EQ(outcome.exit_code, 1);
    test::expect_one_error_line(outcome, "pent-mesh");
    EXPECT_NE(outcome.err.find("--time-limit"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pent"));
    test::expect_contains(test::text_of(folder / "report.json"),
                          {R"("verdict": "refused")", "not done after 1 s", R"("seconds": 1)"});
}

TEST(PentMesh, StopsAtCtrlCWithAVerdictOfItsOwn) {
    const test::TempFolder folder;
    // In the foreground: else the signal comes twice, and the second ends the program at once.
    const Outcome outcome = run_program(
        "pent-mesh " + kModels + "/octopus_5246f.obj --yes --edge-length 0.005 -o "
            + (folder / "out.pent").string() + " --json " + (folder / "report.json").string(),
        "timeout --foreground --preserve-status --signal=INT 0.5");
    EXPECT_EQ(outcome.exit_code, 3);
    test::expect_one_error_line(outcome, "pent-mesh");
    test::expect_contains(outcome.err, {"stopped as asked", "no mesh was written"});
    test::expect_contains(test::text_of(folder / "report.json"), {R"("verdict": "stopped")"});
    EXPECT_FALSE(std::filesystem::exists(folder / "out.pent"));
}

TEST(PentMesh, SaysWhatItMended) {
    const test::TempFolder folder;
    const std::string out = " --layers 1 -o " + (folder / "out.pent").string();
    test::expect_contains(run_program("pent-mesh " + kModels + "/dirty/d_open.off" + out).out,
                          {"found      ", "3 border edges", "mended     lightly"});
    test::expect_contains(run_program("pent-mesh " + kModels + "/dirty/d_flipped.off" + out).out,
                          {"corrected  ", "1 triangle turned over"});
}

TEST(PentMesh, TakesShapesDirectionsAndLimits) {
    const test::TempFolder folder;
    const std::string out = (folder / "out.pent").string();
    // A ball of radius 2 from a surface, of 20 triangles: an icosahedron, leaning over by x.
    const Outcome ball = run_program(
        "pent-mesh --sphere 1 --size 2 --extrude 1,0,0,3 --layers 1"
        " --memory-limit 20000 -o "
        + out);
    ASSERT_EQ(ball.exit_code, 0) << ball.err;
    const SimplexMesh<4> mesh = read_mesh<4>(out).mesh;
    const double edge = 2 / std::sin(2 * std::numbers::pi / 5);  // of the icosahedron
    EXPECT_NEAR(total_volume(mesh), 3 * 5 * (3 + std::sqrt(5.0)) / 12 * std::pow(edge, 3), 1e-9);
}

TEST(PentMesh, SaysWhatToDoWhenMemoryRunsOut) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers reserve terabytes";
#endif
    const test::TempFolder folder;
    const Outcome outcome =
        run_program("pent-mesh --yes --box 200,200,200,20 -o " + (folder / "out.pent").string(),
                    "ulimit -v 1000000;");
    EXPECT_EQ(outcome.exit_code, 1);
    test::expect_one_error_line(outcome, "pent-mesh");
    test::expect_contains(outcome.err, {"out of memory", "ask for fewer cells"});
}

TEST(PentMesh, WantsExactlyOneInput) {
    EXPECT_EQ(run_program("pent-mesh -o out.pent").exit_code, 2);
    EXPECT_EQ(run_program("pent-mesh a.obj --ball 4 -o out.pent").exit_code, 2);
    EXPECT_EQ(run_program("pent-mesh a.obj --thickness 1 --extrude 0,0,0,1 -o o.pent").exit_code,
              2);
}

}  // namespace
}  // namespace pent
