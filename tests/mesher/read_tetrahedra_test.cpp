#include "tet_files.h"

#include <pent/mesher/tetgen_files.h>

#include <gtest/gtest.h>

namespace pent::mesher {
namespace {

using test::message_for;
using test::read_text;
using test::write_file;

// Every sample below is the corner of the unit cube and its mirror image behind x = 0.
void expect_two_corners(const TetrahedraFile& file) {
    ASSERT_EQ(file.mesh.cell_count(), 2);
    EXPECT_EQ(file.mesh.vertex_count(), 5);
    EXPECT_EQ(file.turned_cells, 1);
    EXPECT_DOUBLE_EQ(total_volume(file.mesh), 1.0 / 3);
    EXPECT_EQ(file.mesh.positions.col(1), Eigen::Vector3d(1, 0, 0));
}

const char* const kTobj =
    "# made by hand\nv\t0 0 0\nv\t1 0 0\nv\t0 1 0\nv\t0 0 1\nv\t-1 0 0\nt\t0 1 2 3\nt\t0 4 2 3\n";

const char* const kMedit =
    "MeshVersionFormatted 2\nDimension\n3\n\nVertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n"
    "-1 0 0 1\nTriangles\n1\n1 2 3 7\nTetrahedra 2\n1 2 3 4 5\n1 5 3 4 6\nEnd\n";

const char* const kGmsh2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 5 \"body\"\n$EndPhysicalNames\n"
    "$Nodes\n5\n10 0 0 0\n20 1 0 0\n30 0 1 0\n40 0 0 1\n50 -1 0 0\n$EndNodes\n"
    "$Elements\n3\n1 2 2 1 1 10 20 30\n2 4 2 5 1 10 20 30 40\n3 4 2 6 1 10 50 30 40\n"
    "$EndElements\n";

const char* const kGmsh4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 0\n$EndEntities\n"
    "$Nodes\n2 5 10 50\n2 1 0 2\n10\n20\n0 0 0\n1 0 0\n3 1 1 3\n30\n40\n50\n"
    "0 1 0 0 0 0\n0 0 1 0 0 0\n-1 0 0 0 0 0\n$EndNodes\n"
    "$Elements\n3 3 1 3\n2 1 2 1\n1 10 20 30\n3 5 4 1\n2 10 20 30 40\n3 6 4 1\n3 10 50 30 40\n"
    "$EndElements\n";

const char* const kVtk =
    "# vtk DataFile Version 3.0\nDATASET of two corners\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    "POINTS 5 double\n0 0 0 1 0 0 0 1 0\n0 0 1 -1 0 0\n\nCELLS 3 14\n3 0 1 2\n4 0 1 2 3\n"
    "4 0 4 2 3\n\nCELL_TYPES 3\n5\n10\n10\nCELL_DATA 3\n";

const char* const kVtk5 =
    "# vtk DataFile Version 5.1\nvtk output\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n"
    "0 0 0 1 0 0 0 1 0 0 0 1 -1 0 0\nCELLS 3 8\nOFFSETS vtktypeint64\n0 4 8\n"
    "CONNECTIVITY vtktypeint64\n0 1 2 3 0 4 2 3\nCELL_TYPES 2\n10\n10\n";

const char* const kNode =
    "# points\n5 3 1 1\n1 0 0 0 0.5 1\n2 1 0 0 0.5 1\n3 0 1 0 0.5 1\n4 0 0 1 0.5 1\n"
    "5 -1 0 0 0.5 1\n";
const char* const kEle = "2 4 1\n1 1 2 3 4 5\n2 1 5 3 4 6\n";

TEST(ReadTetrahedra, ReadsEveryFormat) {
    expect_two_corners(read_text("a.tobj", kTobj));
    expect_two_corners(read_text("a.mesh", kMedit));
    expect_two_corners(read_text("a.msh", kGmsh2));
    expect_two_corners(read_text("a.msh", kGmsh4));
    expect_two_corners(read_text("a.vtk", kVtk));
    expect_two_corners(read_text("a.vtk", kVtk5));
}

TEST(ReadTetrahedra, ReadsNodeAndEleByEitherName) {
    const test::TempFolder folder;
    write_file(folder / "a.node", kNode);
    write_file(folder / "a.ele", kEle);
    expect_two_corners(read_tetrahedra(folder / "a.node"));
    expect_two_corners(read_tetrahedra(folder / "a.ele"));
    EXPECT_EQ(read_tetrahedra(folder / "a.ele").mesh.regions, (std::vector<std::uint16_t>{5, 6}));
}

// As programs write them whose names are in capitals throughout.
TEST(ReadTetrahedra, ReadsNodeAndEleInCapitals) {
    const test::TempFolder folder;
    write_file(folder / "A.NODE", kNode);
    write_file(folder / "A.ELE", kEle);
    expect_two_corners(read_tetrahedra(folder / "A.NODE"));
    expect_two_corners(read_tetrahedra(folder / "A.ELE"));
    EXPECT_EQ(other_tetgen_file("b/A.NODE"), "b/A.ELE");
    EXPECT_EQ(other_tetgen_file("b/A.ELE"), "b/A.NODE");
    EXPECT_EQ(other_tetgen_file("b/A.ele"), "b/A.node");
    EXPECT_EQ(other_tetgen_file("b/A.MESH"), "");
}

// Regions are whole numbers; others would become those of their neighbors.
TEST(ReadTetrahedra, RefusesAttributesThatAreNotWhole) {
    const test::TempFolder folder;
    write_file(folder / "a.node", kNode);
    const auto read = [&](const std::string& attribute) {
        write_file(folder / "a.ele", "2 4 1\n1 1 2 3 4 5\n2 1 5 3 4 " + attribute + "\n");
        return read_tetrahedra(folder / "a.node");
    };
    EXPECT_EQ(read("6.0").mesh.regions, (std::vector<std::uint16_t>{5, 6}));
    const auto message = [&](const std::string& attribute) {
        return test::error_of([&] { static_cast<void>(read(attribute)); });
    };
    for (const std::string attribute : {"1.5", "2.4", "-0.4", "1e-9"}) {
        test::expect_contains(message(attribute), {"a.ele: line 3: the attribute " + attribute,
                                                   "expected a whole number", "0 attributes"});
    }
    test::expect_contains(message("-1"), {"label -1", "0 to 65535"});
    test::expect_contains(message("1e300"), {"expected 0 to 65535"});
}

TEST(ReadTetrahedra, ReadsCarriageReturnsAndCountsFromZero) {
    const test::TempFolder folder;
    write_file(folder / "a.node",
               "5 3 0 0\r\n0 0 0 0\r\n1 1 0 0\r\n2 0 1 0\r\n3 0 0 1\r\n4 -1 0 0\r\n");
    write_file(folder / "a.ele", "2 4 0\r\n0 0 1 2 3\r\n1 0 4 2 3\r\n");
    expect_two_corners(read_tetrahedra(folder / "a.node"));
}

TEST(ReadTetrahedra, LeavesOutMiddlesOfEdges) {
    const test::TempFolder folder;
    write_file(folder / "a.node", kNode);
    write_file(folder / "a.ele", "2 10 1\n1 1 2 3 4 1 1 1 1 1 1 5\n2 1 5 3 4 1 1 1 1 1 1 6\n");
    expect_two_corners(read_tetrahedra(folder / "a.ele"));
    EXPECT_EQ(read_tetrahedra(folder / "a.ele").mesh.regions, (std::vector<std::uint16_t>{5, 6}));
}

TEST(ReadTetrahedra, RefusesDamageInEitherOfNodeAndEle) {
    const test::TempFolder folder;
    const auto message = [&](const std::string& node, const std::string& ele) {
        write_file(folder / "a.node", node);
        write_file(folder / "a.ele", ele);
        return test::error_of([&] { static_cast<void>(read_tetrahedra(folder / "a.node")); });
    };
    test::expect_contains(message("", kEle), {"a.node", "the file ends here", "number of points"});
    test::expect_contains(message("5 2 0 0\n", kEle), {"a.node: line 1", "dimension 2"});
    test::expect_contains(message("2 3 0 0\n2 0 0 0\n", kEle),
                          {"a.node: line 2", "point number 2", "expected 0 or 1"});
    test::expect_contains(message("2 3 0 0\n1 0 0 0\n3 1 0 0\n", kEle),
                          {"a.node: line 3", "point number 3", "expected 2"});
    test::expect_contains(message(kNode, "2 5 0\n"), {"a.ele: line 1", "5 corners", "4 or 10"});
    test::expect_contains(message(kNode, "2 4 0\n1 1 2 3 4\n"), {"a.ele", "the file ends here"});
    std::filesystem::remove(folder / "a.ele");
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read_tetrahedra(folder / "a.node")); }),
        {"a.ele: cannot be opened: No such file"});
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read_tetrahedra(folder / "b.mesh")); }),
        {"b.mesh: no such file"});
}

// Netgen and FreeFem write 2, Gmsh may begin with comments.
TEST(ReadTetrahedra, ReadsGmshOfAnyVersionFromTwoOn) {
    for (const std::string version : {"2", "2.0", "2.1", "2.2"}) {
        const TetrahedraFile file =
            read_text("a.msh", "$Comments\n$MeshFormat\n$EndComments\n$MeshFormat\n" + version
                                   + " 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"
                                     "4 0 0 1\n$EndNodes\n$Elements\n1\n1 4 2 7 1 1 2 3 4\n"
                                     "$EndElements\n");
        EXPECT_EQ(file.mesh.cell_count(), 1) << version;
        EXPECT_EQ(file.mesh.regions, std::vector<std::uint16_t>{7}) << version;
    }
}

// Mmg writes which cells it must keep.
TEST(ReadTetrahedra, PassesOverWhatMmgMustKeep) {
    const TetrahedraFile file =
        read_text("a.mesh",
                  "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 1\n1 0 0 1\n"
                  "0 1 0 1\n0 0 1 1\nRequiredTetrahedra 1\n1\nRequiredQuadrilaterals 0\n"
                  "Tetrahedra 1\n1 2 3 4 6\nEnd\n");
    EXPECT_EQ(file.mesh.regions, std::vector<std::uint16_t>{6});
}

TEST(ReadTetrahedra, KeepsLabelsAsRegions) {
    for (const auto& [name, text] :
         {std::pair("a.mesh", kMedit), {"a.msh", kGmsh2}, {"a.msh", kGmsh4}}) {
        EXPECT_EQ(read_text(name, text).mesh.regions, (std::vector<std::uint16_t>{5, 6})) << name;
    }
    test::expect_contains(
        message_for("a.mesh",
                    "MeshVersionFormatted 1\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n"
                    "0 1 0 0\n0 0 1 0\nTetrahedra 1\n1 2 3 4 70000\n"),
        {"label 70000", "65535"});
}

TEST(ReadTetrahedra, LeavesOutUnusedPoints) {
    const TetrahedraFile file =
        read_text("a.tobj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nt 1 2 3 4\n");
    EXPECT_EQ(file.unused_points, 1);
    EXPECT_EQ(file.mesh.vertex_count(), 4);
}

TEST(ReadTetrahedra, RefusesDamageWithFileAndLine) {
    test::expect_contains(message_for("a.tobj", "v 0 0\n"), {"a.tobj: line 1"});
    test::expect_contains(message_for("a.tobj", "v 0 0 0\nt 0 0 0 1\n"), {"index 1 of 1"});
    test::expect_contains(message_for("a.tobj", "f 1 2 3\n"), {"\"f\"", "v or t"});
    test::expect_contains(message_for("a.tobj", "v 0 0 0\n"), {"no tetrahedron"});
    test::expect_contains(message_for("a.tobj", ""), {"no tetrahedron"});
    test::expect_contains(message_for("a.mesh",
                                      "MeshVersionFormatted 1\nDimension 3\nVertices 3\n"
                                      "0 0 0 0\n1 0 0 0\n0 1 0 0\nTriangles 1\n1 2 3 0\n"),
                          {"no tetrahedron", "but 1 triangle; write a surface as .ply"});
    test::expect_contains(message_for("a.tobj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nt 0 1 2 3\n"),
                          {"degenerate"});
    test::expect_contains(message_for("a.mesh", "nonsense"), {"Medit"});
    test::expect_contains(message_for("a.mesh", "MeshVersionFormatted 1\nDimension 2\n"),
                          {"expected 3"});
    test::expect_contains(
        message_for("a.mesh", "MeshVersionFormatted 1\nDimension 3\nVertices 999999999\n"),
        {"999999999"});
    test::expect_contains(message_for("a.mesh", "MeshVersionFormatted 1\nDimension 3\nPoodles 1\n"),
                          {"Poodles"});
    test::expect_contains(message_for("a.msh", "$Nodes\n"), {"$MeshFormat"});
    test::expect_contains(message_for("a.msh", "$MeshFormat\n4.1 1 8\n"),
                          {"a.msh: byte 20: the file ends here"});
    test::expect_contains(message_for("a.msh", "$MeshFormat\n3.0 0 8\n"),
                          {"Gmsh version 3", "2.0 to 2.2 or 4.1"});
    test::expect_contains(message_for("a.msh",
                                      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n"
                                      "1 0 0 1\n$EndNodes\n"),
                          {"node 1 is there twice"});
    test::expect_contains(message_for("a.vtk", "nonsense"), {"VTK"});
    test::expect_contains(message_for("a.vtk", "# vtk DataFile Version 3.0\nt\nBINRAY\n"),
                          {"found \"BINRAY\", expected ASCII or BINARY"});
    test::expect_contains(
        message_for("a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n"),
        {"POLYDATA", "expected UNSTRUCTURED_GRID; write a surface as .ply"});
    test::expect_contains(message_for("a.vtk",
                                      "# vtk DataFile Version 3.0\nt\nASCII\nCELLS 1 5\n4 0 1 2 3\n"
                                      "CELL_TYPES 2\n10\n10\n"),
                          {"line 6", "2 types of 1 cell"});
    test::expect_contains(
        message_for("a.vtk",
                    "# vtk DataFile Version 3.0\nt\nASCII\nPOINTS 1 float\n0 0 0\n"
                    "CELLS 1 4\n3 0 0 0\nCELL_TYPES 1\n10\n"),
        {"a.vtk", "1 tetrahedron with 3 corners"});
    test::expect_contains(message_for("a.vtk",
                                      "# vtk DataFile Version 5.1\nt\nASCII\nCELLS 3 8\n"
                                      "OFFSETS vtktypeint64\n0 9 8\n"),
                          {"a.vtk: line 6", "offset 9 of 8"});
    test::expect_contains(message_for("a.msh",
                                      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n"
                                      "$EndNodes\n$Elements\n1\n1 4 2 1 1 1 1 1 7\n$EndElements\n"),
                          {"a.msh: line 10", "node 7", "not in the file"});
    test::expect_contains(message_for("a.xyz", ""), {".tobj"});
}

// A tetrahedron of VTK with something else in its file.
std::string vtk_of(const std::string& cells, const std::string& types, const std::string& behind) {
    return "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n"
           "0 0 0 1 0 0 0 1 0 0 0 1 -1 0 0\nCELLS "
           + cells + "\nCELL_TYPES " + types + "\n" + behind;
}

// Empty cells, of type 0, count among those that arrays have values of.
TEST(ReadTetrahedra, PassesOverEmptyCellsOfVtk) {
    const TetrahedraFile file =
        read_text("a.vtk", vtk_of("3 11\n4 0 1 2 3\n0\n4 0 4 2 3", "3\n10\n0\n10",
                                  "CELL_DATA 3\nSCALARS age int\nLOOKUP_TABLE default\n1 2 3\n"));
    EXPECT_EQ(file.left_out, "");
    ASSERT_EQ(file.extras.cell_fields.size(), 1U);
    EXPECT_EQ(file.extras.cell_fields[0].values, Eigen::RowVector2d(1, 3));
}

// Case and separators do not count; labels are from 0 to 65535, in one number a cell.
TEST(ReadTetrahedra, FindsLabelsOfVtkByNameAndRange) {
    const auto read = [](const std::string& type, const std::string& values,
                         const std::string& asked) {
        const test::TempFolder folder;
        write_file(folder / "a.vtk", vtk_of("2 10\n4 0 1 2 3\n4 0 4 2 3", "2\n10\n10",
                                            "CELL_DATA 2\n" + type + "\n" + values + "\n"));
        return read_tetrahedra(folder / "a.vtk", "", asked);
    };
    for (const char* const name : {"region_id", "Region-ID", "REGION%20ID", "regionid"}) {
        const std::string type = std::string("SCALARS ") + name + " int\nLOOKUP_TABLE default";
        EXPECT_EQ(read(type, "0 65535", "").mesh.regions, (std::vector<std::uint16_t>{0, 65535}));
        EXPECT_TRUE(read(type, "1 65536", "").mesh.regions.empty());
        EXPECT_TRUE(read(type, "-1 1", "").mesh.regions.empty());
    }
    test::expect_contains(
        test::error_of([&] { static_cast<void>(read("VECTORS v int", "1 1 1 2 2 2", "v")); }),
        {"no array \"v\" of one number a cell; its cells have \"v\""});
}

TEST(ReadTetrahedra, RefusesDamagedFilesOfVtkWithTheirLine) {
    const std::string types = "1\n10";
    for (const std::string corner : {"5", "-1"}) {
        test::expect_contains(message_for("a.vtk", vtk_of("1 5\n4 0 1 2 " + corner, types, "")),
                              {"a.vtk: line ", "index " + corner + " of 5"});
    }
    test::expect_contains(message_for("a.vtk", "vtk DataFile Version 3.0\n"),
                          {"a.vtk: line 1", "no \"# vtk DataFile\" at the start"});
    test::expect_contains(message_for("a.vtk", ""), {"no \"# vtk DataFile\" at the start"});
    test::expect_contains(message_for("a.vtk", "# vtk DataFile Version 3.0\nt\n"),
                          {"the file ends here; expected ASCII or BINARY"});
    test::expect_contains(
        message_for("a.vtk",
                    "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\n"
                    "POINTS 5 int\n"),
        {"points of type \"int\"; expected float or double"});
    test::expect_contains(message_for("a.vtk",
                                      "# vtk DataFile Version 5.1\nt\nASCII\nCELLS 3 8\n"
                                      "OFFSETS vtktypeint64\n0 4 3\n"),
                          {"a.vtk: line 6", "offset 3 of 8"});
    const std::string cell = "1 5\n4 0 1 2 3";
    test::expect_contains(message_for("a.vtk", vtk_of(cell, types, "POINT_DATA 4\n")),
                          {"data of 4 points, of 5"});
    test::expect_contains(message_for("a.vtk", vtk_of(cell, types, "POINT_DATA 5\nCELL_DATA 2\n")),
                          {"data of 2 cells, of 1"});
}

// A line too long would shift all that follows.
TEST(ReadTetrahedra, RefusesElementsOfGmshWithMoreWordsThanTheirTypeHas) {
    for (const auto& [whole, line] :
         {std::pair<std::string, std::string>(kGmsh2, "2 4 2 5 1 10 20"), {kGmsh4, "2 10 20"}}) {
        std::string text = whole;
        text.insert(text.find(line + " 30 40") + line.size() + 6, " 50");
        test::expect_contains(message_for("a.msh", text), {"a.msh: line ", "more words or fewer"});
    }
}

TEST(ReadTetrahedra, RefusesAFileCutOffAnywhere) {
    for (const auto& [name, whole] : {std::pair<std::string, std::string>("a.mesh", kMedit),
                                      {"a.msh", kGmsh2},
                                      {"a.msh", kGmsh4},
                                      {"a.vtk", kVtk},
                                      {"a.vtk", kVtk5}}) {
        // Behind the last corner only closing words follow.
        const std::size_t last = std::min(
            {whole.rfind("End\n"), whole.find("$EndElements"), whole.rfind("\n10"), whole.size()});
        for (std::size_t length = 0; length + 2 < last; length += 5) {
            EXPECT_NE(message_for(name, whole.substr(0, length)), "") << name << " at " << length;
        }
    }
}

}  // namespace
}  // namespace pent::mesher
