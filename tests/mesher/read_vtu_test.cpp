#include "moving_shapes.h"
#include "shapes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/mesher/moving_mesh.h>
#include <pent/mesher/read_tetrahedra.h>
#include <pent/mesher/shapes.h>

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace pent::mesher {
namespace {

using test::parts_of;
using test::rich_parts;
using test::VtuWay;
using test::write_pvd;

TEST(ReadVtu, ReadsTheSameNumbersInEveryEncoding) {
    const test::TempFolder folder;
    std::vector<VtuWay> ways = {{}};
    for (const bool compressed : {false, true}) {
        for (const bool is_long : {false, true}) {
            for (const bool is_big : {false, true}) {
                ways.push_back({"binary", true, compressed, is_long, is_big});
                ways.push_back({"appended", true, compressed, is_long, is_big});
                ways.push_back({"appended", false, compressed, is_long, is_big, 24});
            }
        }
    }
    for (const VtuWay& way : ways) {
        const std::string name =
            way.format + (way.is_raw ? " raw" : " base64") + (way.is_compressed ? " zlib" : "")
            + (way.has_long_headers ? " UInt64" : " UInt32") + (way.is_big_endian ? " big" : "");
        for (const double t : {0.0, 0.7}) {
            test::write_file(folder / formatted("f%d.vtu", t > 0 ? 1 : 0),
                             test::to_vtu(rich_parts(t), way));
        }
        const MovingMesh mesh =
            read_moving_mesh(write_pvd(folder.path(), {{1.5, "f0.vtu"}, {2.25, "f1.vtu"}}));
        EXPECT_EQ(mesh.times, (std::vector<double>{1.5, 2.25})) << name;
        ASSERT_EQ(mesh.positions.size(), 2U) << name;
        EXPECT_EQ(mesh.positions[0], rich_parts(0).points) << name;
        EXPECT_EQ(mesh.positions[1], rich_parts(0.7).points) << name;
        EXPECT_EQ(mesh.base.regions, (std::vector<std::uint16_t>{3, 4})) << name;
        EXPECT_EQ(mesh.triangle_labels, (std::vector<std::uint16_t>{9})) << name;
        ASSERT_EQ(mesh.vertex_fields.size(), 1U) << name;
        EXPECT_EQ(mesh.vertex_fields[0].name, "temperature");
        const Eigen::MatrixXd temperature = mesh.vertex_fields[0].values[1];
        for (int i = 0; i < 5; ++i) {
            EXPECT_EQ(temperature(0, i), rich_parts(0.7).temperature[i]) << name;
        }
        ASSERT_EQ(mesh.cell_fields.size(), 1U) << name;
        EXPECT_EQ(mesh.cell_fields[0].values[0].col(1), Eigen::Vector3d(4, 5, 6)) << name;
    }
}

TEST(ReadVtu, GivesTheSameTetrahedraAsALegacyFile) {
    const test::TempFolder folder;
    const SimplexMesh<3> mesh = ball(2);
    test::write_file(folder / "a.vtu", test::to_vtu(parts_of(mesh), {"appended"}));
    test::write_file(folder / "a.vtk", test::to_legacy_vtk(parts_of(mesh)));
    const TetrahedraFile a = read_tetrahedra(folder / "a.vtu");
    const TetrahedraFile b = read_tetrahedra(folder / "a.vtk");
    EXPECT_EQ(a.mesh.positions, b.mesh.positions);
    EXPECT_EQ(a.mesh.cells, b.mesh.cells);
    EXPECT_EQ(a.mesh.positions, mesh.positions);
}

TEST(ReadVtu, GivesTheRegionsOfAMovingMeshToTheMeshAlone) {
    const test::TempFolder folder;
    test::write_file(folder / "f0.vtu", test::to_vtu(rich_parts(0), {"appended"}));
    const MovingMesh moving =
        read_moving_mesh(write_pvd(folder.path(), {{0, "f0.vtu"}, {1, "f0.vtu"}}));
    const TetrahedraFile plain = read_tetrahedra(folder / "f0.vtu");
    EXPECT_EQ(plain.mesh.regions, (std::vector<std::uint16_t>{3, 4}));
    EXPECT_EQ(plain.mesh.regions, moving.base.regions);
    EXPECT_EQ(plain.mesh.cells, moving.base.cells);
}

TEST(ReadVtu, TakesTheRegionsFromTheArrayAskedFor) {
    const test::TempFolder folder;
    test::VtuParts parts = parts_of(ball(1));
    const auto cells = static_cast<std::size_t>(parts.tetrahedra.cols());
    parts.regions.resize(cells);
    std::iota(parts.regions.begin(), parts.regions.end(), 1);
    std::string vtu = test::to_vtu(parts, {});
    vtu.replace(vtu.find("\"region\""), 8, "\"tissue\"");
    test::write_file(folder / "a.vtu", vtu);
    std::string text = test::to_legacy_vtk(parts_of(ball(1)));
    text +=
        "CELL_DATA " + std::to_string(cells) + "\nSCALARS tissue double\nLOOKUP_TABLE default\n";
    for (const int label : parts.regions) {
        text += std::to_string(label) + "\n";
    }
    test::write_file(folder / "a.vtk", text);
    const std::vector<std::uint16_t> labels(parts.regions.begin(), parts.regions.end());
    for (const char* name : {"a.vtu", "a.vtk"}) {
        EXPECT_TRUE(read_tetrahedra(folder / name).mesh.regions.empty());
        EXPECT_EQ(read_tetrahedra(folder / name, {}, "tissue").mesh.regions, labels);
        test::expect_contains(
            test::error_of([&] { static_cast<void>(read_tetrahedra(folder / name, {}, "bone")); }),
            {std::string(name) + ": no array \"bone\" of one number a cell", "tissue"});
    }
}

// Two tetrahedra with arrays of cells, "NAME: FIRST SECOND" each, as both kinds of files of VTK.
std::vector<std::string> files_with(
    const test::TempFolder& folder,
    const std::vector<std::pair<std::string, std::string>>& arrays) {
    test::VtuParts parts = rich_parts(0);
    parts.triangles.resize(3, 0);
    parts.regions.clear();
    parts.temperature.clear();
    parts.cell_vectors.clear();
    std::string vtu = test::to_vtu(parts, {});
    std::string xml;
    std::string legacy = test::to_legacy_vtk(parts) + "CELL_DATA 2\n";
    for (const auto& [name, values] : arrays) {
        xml += "<DataArray type=\"Int32\" Name=\"" + name + "\" format=\"ascii\">" + values
               + "</DataArray>\n";
        std::string word = name;
        for (std::size_t at = word.find(' '); at != std::string::npos; at = word.find(' ')) {
            word.replace(at, 1, "%20");
        }
        legacy += "SCALARS " + word + " int\nLOOKUP_TABLE default\n" + values + "\n";
    }
    vtu.insert(vtu.find("</CellData>"), xml);
    test::write_file(folder / "a.vtu", vtu);
    test::write_file(folder / "a.vtk", legacy);
    return {(folder / "a.vtu").string(), (folder / "a.vtk").string()};
}

TEST(RegionArray, IsKnownByTheNamesThatOtherProgramsGiveIt) {
    const test::TempFolder folder;
    for (const std::string name :
         {"region",          "Region Id",   "REGIONS",         "Material",      "MaterialIDs",
          "material_id",     "attribute",   "Label",           "gmsh:physical", "gmsh:geometrical",
          "medit:ref",       "tetgen:ref",  "nastran:ref",     "netgen:index",  "su2:tag",
          "avsucd:material", "cell_tags",   "ElementBlockIds", "ObjectId",      "CellEntityIds",
          "PhysicalIds",     "GeometryIds", "elemTag",         "RefId"}) {
        for (const std::string& file : files_with(folder, {{"age", "5 6"}, {name, "3 4"}})) {
            const TetrahedraFile read = read_tetrahedra(file);
            EXPECT_EQ(read.mesh.regions, (std::vector<std::uint16_t>{3, 4})) << name;
            EXPECT_EQ(read.region_array, name);
            ASSERT_EQ(read.extras.cell_fields.size(), 1U) << name;
            EXPECT_EQ(read.extras.cell_fields[0].name, "age");
        }
    }
    for (const std::string name : {"temperature", "subdomain", "partition", "regional", "ref"}) {
        for (const std::string& file : files_with(folder, {{name, "3 4"}})) {
            EXPECT_TRUE(read_tetrahedra(file).mesh.regions.empty()) << name;
            EXPECT_EQ(read_tetrahedra(file).region_array, "");
            EXPECT_EQ(read_tetrahedra(file).extras.cell_fields.size(), 1U);
        }
    }
}

TEST(RegionArray, IsTheOneThatSaysMostOfSeveral) {
    const test::TempFolder folder;
    const std::vector<std::string> names = {"Material", "Label",         "gmsh:physical",
                                            "RefId",    "CellEntityIds", "gmsh:geometrical"};
    for (std::size_t better = 0; better < names.size(); ++better) {
        for (std::size_t worse = better + 1; worse < names.size(); ++worse) {
            for (const std::string& file :
                 files_with(folder, {{names[worse], "1 2"}, {names[better], "3 4"}})) {
                EXPECT_EQ(read_tetrahedra(file).region_array, names[better]);
                EXPECT_EQ(read_tetrahedra(file).mesh.regions, (std::vector<std::uint16_t>{3, 4}));
            }
            // But for one that has no labels.
            for (const std::string& file :
                 files_with(folder, {{names[better], "3 -1"}, {names[worse], "1 2"}})) {
                EXPECT_EQ(read_tetrahedra(file).region_array, names[worse]);
            }
        }
    }
}

TEST(ReadVtu, RefusesEveryCutOfAFileInOneLine) {
    const test::TempFolder folder;
    for (const VtuWay& way : {VtuWay{}, VtuWay{"binary", true, true}, VtuWay{"appended"},
                              VtuWay{"appended", false, true, true}}) {
        const std::string whole = test::to_vtu(rich_parts(0), way);
        // Behind the last array only the tags at the end are left.
        const std::size_t last = whole.rfind("</Piece>");
        const std::size_t end =
            way.format == "appended" ? whole.rfind("\n</AppendedData>") - 1 : last;
        for (std::size_t length = 0; length < end; length += 7) {
            test::write_file(folder / "a.vtu", whole.substr(0, length));
            const std::string error =
                test::error_of([&] { static_cast<void>(read_tetrahedra(folder / "a.vtu")); });
            ASSERT_NE(error, "") << way.format << " cut at " << length;
            ASSERT_EQ(error.find('\n'), std::string::npos) << error;
            ASSERT_NE(error.find("a.vtu: "), std::string::npos) << error;
        }
    }
}

TEST(ReadVtu, SaysWhatItDoesNotRead) {
    const test::TempFolder folder;
    const std::string good = test::to_vtu(rich_parts(0), {});
    const auto message = [&](const std::string& what, const std::string& with) {
        std::string text = good;
        text.replace(text.find(what), what.size(), with);
        test::write_file(folder / "a.vtu", text);
        return test::error_of([&] { static_cast<void>(read_tetrahedra(folder / "a.vtu")); });
    };
    test::expect_contains(message("header_type", "compressor=\"vtkLZ4DataCompressor\" header_type"),
                          {"vtkLZ4DataCompressor", "vtkZLibDataCompressor or none"});
    test::expect_contains(message("type=\"UnstructuredGrid\"", "type=\"PolyData\""),
                          {"line 2", "PolyData", "expected VTKFile of type UnstructuredGrid"});
    test::expect_contains(message("NumberOfPoints=\"5\"", "NumberOfPoints=\"4000000000\""),
                          {"array \"Points\"", "15 numbers, expected 12000000000"});
    test::expect_contains(message("NumberOfPoints=\"5\"", "NumberOfPoints=\"-5\""),
                          {"NumberOfPoints is \"-5\""});
    test::expect_contains(message("Name=\"offsets\"", "Name=\"ends\""), {"no array offsets"});
    test::expect_contains(message("<Points>", "<!DOCTYPE a><Points>"), {"no XML that can be read"});
    test::expect_contains(message("0 0 0 ", "0 nan 0 "),
                          {"array \"Points\"", "point 0 is not finite"});
    test::expect_contains(message("NumberOfPoints=\"5\"", ""), {"NumberOfPoints is \"\""});
    test::expect_contains(message("</Piece>", "</Piece><Piece/>"), {"a second piece", "merge"});
}

}  // namespace
}  // namespace pent::mesher
