#include "shapes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/error.h>
#include <pent/mesher/read_surface.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

namespace pent::mesher {
namespace {

using test::write_file;

// What read_surface says about a file with this text.
std::string message_for(const std::string& name, const std::string& text) {
    const test::TempFolder folder;
    write_file(folder / name, text);
    return test::error_of([&] { static_cast<void>(read_surface(folder / name)); });
}

SurfaceFile read_text(const std::string& name, const std::string& text) {
    const test::TempFolder folder;
    write_file(folder / name, text);
    return read_surface(folder / name);
}

TEST(ReadObj, KeepsEveryBitOfADouble) {
    const SurfaceFile file =
        read_text("a.obj", "v 0.1 1e-300 -1.7976931348623157e308\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(file.surface.points(0, 0), 0.1);
    EXPECT_EQ(file.surface.points(1, 0), 1e-300);
    EXPECT_EQ(file.surface.points(2, 0), -1.7976931348623157e308);
}

TEST(ReadObj, TakesEveryFormOfACorner) {
    const char* points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (const char* face : {"f 1 2 3", "f 1/7 2/8 3/9", "f 1//7 2//8 3//9", "f 1/1/1 2/2/2 3/3/3",
                             "f -3 -2 -1", "f -3/-1 -2/-1 -1/-1", "f 1 2 \\\n 3"}) {
        const SurfaceFile file = read_text("a.obj", std::string(points) + face + "\n");
        EXPECT_EQ(file.surface.triangles, (Simplices<3>(3, 1) << 0, 1, 2).finished()) << face;
    }
}

TEST(ReadObj, SkipsCommentsOtherLinesAndCarriageReturns) {
    const SurfaceFile file = read_text(
        "a.obj",
        "# made by hand\r\nmtllib x.mtl\r\no thing\r\n\r\n  v 0 0 0 # origin\r\nv\t1 0 0\r\n"
        "v 0 +1 0 0.5 0.5 0.5\r\nvn 0 0 1\r\nvt 0 0\r\ns off\r\nusemtl m\r\nl 1 2\r\nf 1 2 3");
    EXPECT_EQ(file.surface.triangle_count(), 1);
    EXPECT_EQ(file.surface.points(1, 2), 1.0);
}

// As some editors put it in front of a text.
TEST(ReadSurface, PassesOverAByteOrderMark) {
    const std::string mark = "\xEF\xBB\xBF";
    const Simplices<3> triangle = (Simplices<3>(3, 1) << 0, 1, 2).finished();
    for (const auto& [name, text] :
         {std::pair("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
          {"a.obj", "# made by hand\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
          {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}}) {
        EXPECT_EQ(read_text(name, mark + text).surface.triangles, triangle) << text;
    }
    test::expect_contains(message_for("a.obj", mark + "v 0 0 x\n"), {"a.obj: line 1", "\"x\""});
}

// What a surface has no use for is counted, whatever the format.
TEST(ReadSurface, CountsTheLinesAndPointsThatItLeavesOut) {
    const SurfaceFile obj =
        read_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\nl 1 2 3\np 1\n");
    EXPECT_EQ(obj.left_out, "2 lines, 1 point");
    EXPECT_EQ(obj.surface.triangle_count(), 1);
    const SurfaceFile ply = read_text(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float"
        " z\nelement face 1\nproperty list uchar int vertex_indices\nelement edge 1\nproperty int"
        " vertex1\nproperty int vertex2\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n0 1\n");
    EXPECT_EQ(ply.left_out, "1 line");
    EXPECT_EQ(read_text("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").left_out, "");
}

TEST(ReadObj, CutsAConcavePolygonWithoutTurningTrianglesOver) {
    // A dart: the fan from its first corner would reach over the notch. Its area is 1.
    const SurfaceFile file =
        read_text("a.obj", "v -1 -1 0\nv 1 0 0\nv -1 1 0\nv 0 0 0\nf 1 2 3 4\n");
    ASSERT_EQ(file.surface.triangle_count(), 2);
    EXPECT_DOUBLE_EQ(area(file.surface), 1.0);
}

TEST(ReadObj, NamesFileAndLineOfWhatIsWrong) {
    test::expect_contains(message_for("a.obj", "v 0 0 0\nv 1 0\n"), {"a.obj: line 2"});
    test::expect_contains(message_for("a.obj", "v 0 0 nan\n"), {"\"nan\""});
    test::expect_contains(message_for("a.obj", "v 0 0 1e999\n"), {"finite"});
    test::expect_contains(message_for("a.obj", "v 0 0 1x\n"), {"\"1x\""});
    test::expect_contains(message_for("a.obj", "v 0 0 0\n\nf 1 1 2\n"), {"line 3: corner 2"});
    test::expect_contains(message_for("a.obj", "v 0 0 0\nf 1 1 0\n"), {"corner 0"});
    test::expect_contains(message_for("a.obj", "v 0 0 0\nf 1 1 -2\n"), {"corner -2"});
    test::expect_contains(message_for("a.obj", "v 0 0 0\nf 1 1\n"), {"2 corners"});
    test::expect_contains(message_for("a.obj", "v 0 0 0\nf a b c\n"), {"\"a\""});
    test::expect_contains(message_for("a.obj", "v 0 0 0\n"), {"no triangle"});
    test::expect_contains(message_for("a.obj", ""), {"no triangle"});
    test::expect_contains(message_for("a.xyz", ""), {".obj, .off"});
    EXPECT_THROW(static_cast<void>(read_surface("/no/such.obj")), Error);
    EXPECT_THROW(static_cast<void>(read_surface("/")), Error);
}

TEST(ReadSurface, ReadsOffPlyAndStl) {
    const SurfaceFile off = read_surface(std::string(PENT_MODELS) + "/dirty/d_cube.off");
    EXPECT_EQ(off.surface.points, test::box_surface({0, 0, 0}, {1, 1, 1}).points);
    EXPECT_DOUBLE_EQ(enclosed_volume(off.surface), 1.0);

    const SurfaceFile ply = read_text("a.ply",
                                      "ply\nformat ascii 1.0\nelement vertex 4\n"
                                      "property float x\nproperty float y\nproperty float z\n"
                                      "element face 2\nproperty list uchar int vertex_indices\n"
                                      "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                                      "3 0 1 2\n3 0 2 3\n");
    EXPECT_EQ(ply.surface.point_count(), 4);
    EXPECT_DOUBLE_EQ(area(ply.surface), 1.0);

    const SurfaceFile stl = read_text(
        "a.stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n"
        "endloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\n"
        "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n");
    EXPECT_EQ(stl.surface.point_count(), 4);
    EXPECT_EQ(stl.surface.triangle_count(), 2);
    EXPECT_DOUBLE_EQ(area(stl.surface), 1.0);
}

// The corner of the unit cube, as binary STL: normals are not read, so there are none.
std::string binary_stl(float height) {
    const std::array<std::array<float, 3>, 4> points = {
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, height}}};
    std::string bytes = "solid, as some programs begin binary files too";
    bytes.resize(80, ' ');
    bytes.append("\4\0\0\0", 4);
    for (const auto& triangle : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) {
        bytes.append(12, '\0');
        for (const int corner : triangle) {
            bytes.append(reinterpret_cast<const char*>(points[corner].data()), 12);
        }
        bytes.append(2, '\0');
    }
    return bytes;
}

TEST(ReadStl, ReadsBinaryFiles) {
    const SurfaceFile file = read_text("a.stl", binary_stl(1));
    EXPECT_EQ(file.surface.point_count(), 4);
    EXPECT_EQ(file.surface.triangle_count(), 4);
    EXPECT_DOUBLE_EQ(enclosed_volume(file.surface), 1.0 / 6);
    test::expect_contains(message_for("a.stl", binary_stl(std::numeric_limits<float>::infinity())),
                          {"a.stl: triangle 1", "not finite"});
}

TEST(ReadStl, TakesKeywordsInAnyLettersBehindBlankLines) {
    const std::string text =
        "\nsolid a part of a machine with a name that is longer than the header of a binary file\n"
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
        "endfacet\nendsolid a\n";
    std::string capitals = text;
    std::transform(text.begin(), text.end(), capitals.begin(), ::toupper);
    for (const std::string& one : {text, capitals}) {
        const SurfaceFile file = read_text("a.stl", one);
        EXPECT_EQ(file.surface.triangle_count(), 1);
        EXPECT_DOUBLE_EQ(area(file.surface), 0.5);
    }
    test::expect_contains(message_for("a.stl", "SOLID a\nOUTER LOOP\nVERTEX 0 0 0\nENDLOOP\n"),
                          {"a.stl: line 4: a loop of 1 vertex;"});
}

TEST(ReadStl, NamesLoopsThatAreNoTriangles) {
    const std::string loop = "solid a\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
    test::expect_contains(message_for("a.stl", loop + "endloop\n"),
                          {"a.stl: line 5", "a loop of 2 vertices", "expected 3"});
    test::expect_contains(message_for("a.stl", loop),
                          {"a.stl", "the file ends before \"endsolid\"", "cut off"});
}

TEST(ReadStl, SaysWhatATruncatedFileShouldHaveBeen) {
    const std::string whole = binary_stl(1);
    test::expect_contains(message_for("a.stl", whole.substr(0, whole.size() - 50)),
                          {"a.stl: " + std::to_string(whole.size() - 50) + " bytes; expected "
                               + std::to_string(whole.size()) + " for the 4 triangles",
                           "cut off"});
    std::string longer = whole + "more";
    longer[10] = '\0';
    test::expect_contains(message_for("a.stl", longer), {"bytes; expected", "goes on behind them"});
    for (std::size_t length = 0; length < whole.size(); ++length) {
        EXPECT_NE(message_for("a.stl", whole.substr(0, length)), "") << length;
    }
    // A text that ends between two triangles is no smaller body.
    const std::string facet =
        "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
        "0\nendloop\nendfacet\n";
    test::expect_contains(message_for("a.stl", "solid a\n" + facet), {"endsolid"});
    EXPECT_EQ(
        read_text("a.stl", "solid a\n" + facet + "endsolid a\nsolid b\n" + facet + "endsolid b\n")
            .surface.triangle_count(),
        2);
}

TEST(ReadObj, RefusesFreeFormSurfaces) {
    test::expect_contains(
        message_for("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nsurf 0 1 0 1 1 2\n"),
        {"a.obj: line 5", "a free-form surface (surf)", "expected polygons"});
    for (const std::string keyword : {"surf", "bsp", "bzp", "cdp", "con"}) {
        test::expect_contains(message_for("a.obj", "v 0 0 0\n" + keyword + " 0 1\n"),
                              {"a.obj: line 2", "a free-form surface (" + keyword + ")"});
    }
}

TEST(ReadOff, RefusesPointsThatAreNotInSpace) {
    const std::string points = " 3 1 0\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n";
    for (const char* keyword : {"4OFF", "nOFF", "4nOFF", "STCN4OFF"}) {
        test::expect_contains(
            message_for("a.off", keyword + points),
            {"a.off: line 1", std::string(keyword) + ": points that have not three"});
    }
    for (const char* keyword : {"xOFF", "NCOFF", "OFFS", "CCOFF"}) {
        test::expect_contains(message_for("a.off", keyword + points), {"a.off: line 1", "no OFF"});
    }
    for (const char* keyword : {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCNOFF"}) {
        EXPECT_EQ(read_text("a.off", keyword + points).surface.triangle_count(), 1) << keyword;
    }
}

TEST(ReadOff, TakesCountsOnTheFirstLineAndNamesWhatIsWrong) {
    const SurfaceFile file =
        read_text("a.off", "COFF 3 1 0 # colors follow\n0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 2 9\n");
    EXPECT_DOUBLE_EQ(area(file.surface), 0.5);
    test::expect_contains(message_for("a.off", "OFF BINARY\n"), {"a.off: line 1", "binary OFF"});
    test::expect_contains(message_for("a.off", "OFF\n1 1 0\n0 0 0\n0\n"),
                          {"a.off: line 4", "a face with 0 corners", "expected 1 or more"});
    EXPECT_EQ(read_text("a.off", "OFF\n3 4 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n1 2\n3 0 1 2\n2 1 2\n")
                  .left_out,
              "2 lines, 1 point");
    test::expect_contains(message_for("a.off", "OFF\n2 1 0\n0 0 0\n"),
                          {"a.off", "the file ends here; expected a point"});
}

TEST(ReadSurface, NamesWhatCannotBeRead) {
    const test::TempFolder folder;
    std::filesystem::create_directory(folder / "a.off");
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read_surface(folder / "a.off")); }),
        {"a.off: is a folder", "give a file"});
    // The memory of a process is a file that opens, and cannot be read at its beginning.
    std::filesystem::create_symlink("/proc/self/mem", folder / "b.off");
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read_surface(folder / "b.off")); }),
        {"b.off: cannot be read: Input/output error"});
}

TEST(ReadSurface, TakesTheFormatThatIsGivenOverTheName) {
    const test::TempFolder folder;
    test::write_file(folder / "corner.txt", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_EQ(read_surface(folder / "corner.txt", "off").surface.triangle_count(), 1);
    EXPECT_EQ(read_surface(folder / "corner.txt", "OFF").surface.triangle_count(), 1);
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read_surface(folder / "corner.txt")); }),
        {"a name that ends in \".txt\"", ".glb", ".tobj", "give the format"});
}

TEST(ReadSurface, SaysInItsOwnWordsWhyNoFileHasSuchAName) {
    const std::string name = std::string(300, 'x') + ".obj";
    EXPECT_EQ(test::error_of([&] { static_cast<void>(read_surface(name)); }),
              name + ": cannot be opened: File name too long");
}

TEST(ReadSurface, RefusesWhatOnlyLooksLikeAFile) {
    for (const char* name : {"a.ply", "a.stl", "a.off", "a.gltf", "a.glb"}) {
        test::expect_contains(message_for(name, "nonsense\n1 2 3\n"), {name});
        EXPECT_NE(message_for(name, ""), "") << name;
    }
    EXPECT_NE(message_for("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"), "");
    EXPECT_NE(message_for("a.off", "OFF\n99999999 1 0\n0 0 0\n"), "");
}

TEST(Weld, MergesPointsAtOnePlaceAndKeepsTheOrder) {
    Positions<3> points(3, 6);
    points << 5, 0, 1, 0, 0, 9,  //
        5, 0, 0, 0, 1, 9,        //
        5, 0, 0, -0.0, 0, 9;
    Simplices<3> triangles(3, 2);
    triangles << 1, 3, 2, 4, 4, 2;
    const SurfaceFile file = weld(points, triangles);
    EXPECT_EQ(file.points_in_file, 6);
    EXPECT_EQ(file.merged_points, 1);
    EXPECT_EQ(file.unused_points, 2);
    EXPECT_EQ(file.surface.points, (Positions<3>(3, 3) << 0, 1, 0, 0, 0, 1, 0, 0, 0).finished());
    EXPECT_EQ(file.surface.triangles, (Simplices<3>(3, 2) << 0, 0, 1, 2, 2, 1).finished());
}

TEST(EnclosedVolume, DoesNotDependOnThePlace) {
    const Surface box = test::box_surface({0, 0, 0}, {1, 2, 3});
    EXPECT_DOUBLE_EQ(enclosed_volume(box), 6.0);
    EXPECT_DOUBLE_EQ(area(box), 22.0);
    EXPECT_DOUBLE_EQ(diagonal(box.points), std::sqrt(14.0));
    // Coordinates up to 2^40 with unit steps are exact.
    const double far = 1099511627776.0;
    EXPECT_DOUBLE_EQ(
        enclosed_volume(test::box_surface({far, far, far}, {far + 1, far + 2, far + 3})), 6.0);
}

}  // namespace
}  // namespace pent::mesher
