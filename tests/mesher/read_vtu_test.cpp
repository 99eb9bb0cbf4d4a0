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

TEST(ReadVtu, ReadsLinesThatEndInAnyWay) {
    const test::TempFolder folder;
    const std::string text = test::to_vtu(rich_parts(0), {});
    test::write_file(folder / "a.vtu", text);
    const TetrahedraFile plain = read_tetrahedra(folder / "a.vtu");
    for (const std::string end : {"\r\n", "\r", "\n\t"}) {
        std::string other;
        for (const char c : text) {
            other += c == '\n' ? end : std::string(1, c);
        }
        test::write_file(folder / "a.vtu", other);
        const TetrahedraFile file = read_tetrahedra(folder / "a.vtu");
        EXPECT_EQ(file.mesh.positions, plain.mesh.positions);
        EXPECT_EQ(file.mesh.cells, plain.mesh.cells);
        EXPECT_EQ(file.extras.vertex_fields, plain.extras.vertex_fields);
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
    for (const VtuWay& way :
         {VtuWay{}, VtuWay{"binary", true, true}, VtuWay{"appended"},
          VtuWay{"appended", true, true}, VtuWay{"appended", false, true, true}}) {
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
    for (const std::string count : {"-5", "5x", "4294967296", "99999999999999999999"}) {
        test::expect_contains(
            message("NumberOfPoints=\"5\"", "NumberOfPoints=\"" + count + "\""),
            {"NumberOfPoints is \"" + count + "\", expected a whole number below 2^32"});
    }
    test::expect_contains(message("Name=\"offsets\"", "Name=\"ends\""), {"no array offsets"});
    test::expect_contains(message("<Points>", "<!DOCTYPE a><Points>"), {"no XML that can be read"});
    test::expect_contains(message("0 0 0 ", "0 nan 0 "),
                          {"array \"Points\"", "point 0 is not finite"});
    test::expect_contains(message("NumberOfPoints=\"5\"", ""), {"NumberOfPoints is \"\""});
    test::expect_contains(message("</Piece>", "</Piece><Piece/>"), {"a second piece", "merge"});
    test::expect_contains(message("<VTKFile", "<!DOCTYPE a [<!ENTITY b \"c\">]><VTKFile"),
                          {"line 2: ", "a document type definition; expected none"});
    test::expect_contains(message("Float64", "Float16"),
                          {"type \"Float16\", expected Int8 to UInt64, Float32 or Float64"});
    for (const std::string type : {"Float32", "Float64"}) {
        test::expect_contains(message("Int64", type),
                              {"type \"" + type + "\", expected whole numbers"});
    }
    for (const std::string word : {"1e999", "0x", "--1"}) {
        test::expect_contains(message("0 0 0 ", "0 " + word + " 0 "),
                              {"array \"Points\"", "found \"" + word + "\", expected a number"});
    }
    // Words of up to 60 letters are told as they are.
    for (const std::size_t length : {60U, 61U}) {
        const std::string word(length, 'a');
        test::expect_contains(message("0 0 0 ", "0 " + word + " 0 "),
                              {"found \"" + word.substr(0, 60) + (length > 60 ? "...\"" : "\"")});
    }
    std::string nested;
    for (int depth = 0; depth < 40; ++depth) {
        nested += "<a>";
    }
    test::expect_contains(message("<Cells>", nested), {"elements more than 32 deep"});
}

// What an array says of itself, and what it holds beside numbers.
TEST(ReadVtu, ReadsArraysOfOneToAThousandNumbers) {
    const test::TempFolder folder;
    const auto read_with = [&](const std::string& array) {
        std::string text = test::to_vtu(rich_parts(0), {});
        text.insert(text.find("</PointData>"), array);
        test::write_file(folder / "a.vtu", text);
        return read_tetrahedra(folder / "a.vtu");
    };
    const auto with = [](const std::string& components, const std::string& format) {
        return "<DataArray type=\"Int8\" Name=\"n\" NumberOfComponents=\"" + components
               + "\" format=\"" + format + "\">1 2 3 4 5</DataArray>";
    };
    const std::string words =
        "<DataArray type=\"String\" Name=\"s\">left right</DataArray>"
        "<Array type=\"Int8\" Name=\"a\">7</Array>";
    const TetrahedraFile file = read_with(words + with("1", ""));
    ASSERT_EQ(file.extras.vertex_fields.size(), 2U);
    EXPECT_EQ(file.extras.vertex_fields[1].name, "n");
    EXPECT_EQ(file.extras.vertex_fields[1].values(0, 4), 5);
    const auto message = [&](const std::string& array) {
        return test::error_of([&] { static_cast<void>(read_with(array)); });
    };
    for (const std::string components : {"0", "1001", "1.5", "-1", "99999999999999999999"}) {
        test::expect_contains(
            message(with(components, "ascii")),
            {"NumberOfComponents \"" + components + "\", expected a whole number from 1 to 1000"});
    }
    test::expect_contains(message(with("1&#10;2", "ascii")), {"NumberOfComponents \"1 2\","});
    test::expect_contains(message(with("1000", "ascii")),
                          {"array \"n\": 5 numbers, expected 5000"});
    test::expect_contains(message(with("1", "hex")),
                          {"format \"hex\", expected ascii, binary or appended"});
}

// Of VTK's type 0, without a corner; arrays have values of them, too.
TEST(ReadVtu, PassesOverEmptyCells) {
    const test::TempFolder folder;
    test::VtuParts parts = rich_parts(0);
    parts.triangles.resize(3, 0);
    parts.regions = {3, 5, 4};
    parts.cell_vectors.clear();
    std::string text = test::to_vtu(parts, {});
    const auto put = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    put("NumberOfCells=\"2\"", "NumberOfCells=\"3\"");
    put("4 8", "4 4 8");
    put("10 10", "10 0 10");
    test::write_file(folder / "a.vtu", text);
    const TetrahedraFile file = read_tetrahedra(folder / "a.vtu");
    EXPECT_EQ(file.mesh.regions, (std::vector<std::uint16_t>{3, 4}));
    EXPECT_EQ(file.mesh.cell_count(), 2);
}

TEST(ReadVtu, SaysWhatIsMissing) {
    const auto message = [&](const std::string& grid) {
        const test::TempFolder folder;
        test::write_file(folder / "a.vtu", grid);
        return test::error_of([&] { static_cast<void>(read_tetrahedra(folder / "a.vtu")); });
    };
    const std::string start = "<VTKFile type=\"UnstructuredGrid\">";
    const std::string piece =
        start + "<UnstructuredGrid><Piece NumberOfPoints=\"0\" NumberOfCells=\"0\">";
    const std::string end = "</Piece></UnstructuredGrid></VTKFile>";
    test::expect_contains(message(start + "</VTKFile>"), {"no UnstructuredGrid in \"VTKFile\""});
    test::expect_contains(message(start + "<UnstructuredGrid/></VTKFile>"),
                          {"no Piece in \"UnstructuredGrid\""});
    test::expect_contains(message(piece + end), {"no Points in \"Piece\""});
    test::expect_contains(message(piece + "<Points/>" + end), {"no DataArray in \"Points\""});
    test::expect_contains(message(piece + "<Points><DataArray type=\"Float64\"/></Points>" + end),
                          {"no Cells in \"Piece\""});
    const std::string no_points = "<Points><DataArray type=\"Float64\"/></Points>";
    const auto array = [](const std::string& name) {
        return "<DataArray type=\"Int64\" Name=\"" + name + "\"/>";
    };
    test::expect_contains(message(piece + no_points + "<Cells>" + array("offsets") + array("types")
                                  + array("connectivity") + "</Cells>" + end),
                          {"no tetrahedron in it"});
    std::string back = test::to_vtu(rich_parts(0), {});  // each cell ends behind the one before
    back.replace(back.find("4 8 11"), 6, "8 4 11");
    test::expect_contains(message(back), {"array \"offsets\": cell 1 ends at 4, expected 8 to 11"});
    std::string beyond = test::to_vtu(rich_parts(0), {});
    beyond.replace(beyond.find("4 8 11"), 6, "4 12 11");
    test::expect_contains(message(beyond), {"cell 1 ends at 12, expected 4 to 11"});
    test::expect_contains(message("<Other type=\"UnstructuredGrid\"/>"),
                          {"found \"Other\" of type \"UnstructuredGrid\", expected VTKFile"});
    std::string with_more = test::to_vtu(rich_parts(0), {});
    with_more.insert(with_more.find("<Piece"), "<FieldData></FieldData>");
    const test::TempFolder folder;
    test::write_file(folder / "a.vtu", with_more);
    EXPECT_EQ(read_tetrahedra(folder / "a.vtu").mesh.cell_count(), 2);
    test::expect_contains(message("<AppendedData></AppendedData>"),
                          {"AppendedData without the '_' in front of its bytes"});
    test::expect_contains(message("<AppendedData>_</AppendedData>"),
                          {"found \"AppendedData\" of type \"\", expected VTKFile"});
}

// An array's numbers are written with an offset, a length, or lengths of its blocks, which a
// damaged file may have anything for.
TEST(ReadVtu, RefusesLengthsAndOffsetsThatAreWrong) {
    const test::TempFolder folder;
    const auto message = [&](const std::string& text) {
        test::write_file(folder / "a.vtu", text);
        return test::error_of([&] { static_cast<void>(read_tetrahedra(folder / "a.vtu")); });
    };
    const std::string cut = "array \"temperature\": its bytes end too soon or are damaged";
    const std::string damaged = "array \"temperature\": a block that zlib cannot read";
    for (const bool has_long_headers : {false, true}) {
        const std::size_t word = has_long_headers ? 8 : 4;
        const auto with = [&](const std::string& text, std::size_t index, std::uint64_t value) {
            std::string changed = text;
            changed.replace(changed.find("\n_") + 2 + index * word, word,
                            std::string(reinterpret_cast<const char*>(&value), word));
            return changed;
        };
        // Five numbers in one block: 1, 64, 40 and how many bytes they are compressed to.
        const std::string packed =
            test::to_vtu(rich_parts(0), {"appended", true, true, has_long_headers});
        const std::size_t compressed =
            static_cast<std::uint8_t>(packed[packed.find("\n_") + 2 + 3 * word]);
        test::write_file(folder / "a.vtu", with(packed, 2, 40));
        EXPECT_EQ(read_tetrahedra(folder / "a.vtu").mesh.cell_count(), 2);
        test::expect_contains(message(with(packed, 0, 0)), {"0 numbers, expected 5"});
        // As many that the length of all lengths would be small again.
        const std::uint64_t blocks = std::uint64_t{1} << (has_long_headers ? 61 : 30);
        test::expect_contains(message(with(packed, 0, blocks)), {cut});
        for (const std::uint64_t partial : {39, 41, 48}) {
            test::expect_contains(message(with(packed, 2, partial)), {damaged});
        }
        test::expect_contains(message(with(packed, 2, 65)), {cut});
        // More than zlib could have made so small.
        test::expect_contains(message(with(with(packed, 1, 1000000), 2, 1000000)), {cut});
        for (const std::uint64_t bytes : {packed.size() - 8, packed.size() + 8}) {
            test::expect_contains(message(with(packed, 3, bytes)), {cut});
        }
        test::expect_contains(message(with(packed, 3, compressed - 1)), {damaged});

        // Two blocks, whose lengths together are small again.
        if (has_long_headers) {
            std::string wrapped = packed;
            const std::size_t flow = wrapped.find("offset=\"", wrapped.find("Name=\"flow\"")) + 8;
            const std::size_t first =
                wrapped.find("\n_") + 2 + std::stoul(wrapped.substr(flow)) + 3 * word;
            const std::uint64_t half = std::uint64_t{1} << 63;
            for (const std::size_t at : {first, first + word}) {
                wrapped.replace(at, word, std::string(reinterpret_cast<const char*>(&half), word));
            }
            test::expect_contains(message(wrapped), {"array \"flow\": its bytes end too soon"});
        }

        const std::string plain =
            test::to_vtu(rich_parts(0), {"appended", true, false, has_long_headers});
        test::expect_contains(message(with(plain, 0, 39)), {"4 numbers, expected 5"});
        for (const std::uint64_t bytes :
             {std::uint64_t{plain.size() - 8}, std::uint64_t{plain.size() + 8},
              has_long_headers ? ~std::uint64_t{0} : std::uint64_t{0xFFFFFFFF}}) {
            test::expect_contains(message(with(plain, 0, bytes)), {cut});
        }
        const std::string first = "offset=\"0\"";
        for (const std::string offset : {"", "12x", "-1", "99999999999999999999"}) {
            std::string changed = plain;
            changed.replace(changed.find(first), first.size(), "offset=\"" + offset + "\"");
            test::expect_contains(message(changed),
                                  {"offset \"" + offset + "\", expected a whole number"});
        }
        std::string behind = plain;
        behind.replace(behind.find(first), first.size(), "offset=\"999999\"");
        test::expect_contains(message(behind), {cut});
    }
}

// The largest of the whole numbers that a file may have are more than any index.
TEST(ReadVtu, RefusesWholeNumbersThatAreTooLarge) {
    const test::TempFolder folder;
    const auto read_with = [&](std::uint64_t corner) {
        test::VtuText text({"binary"});
        std::string grid =
            "<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\n<Points>";
        grid += text.array("Float64", "Points", 3,
                           std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
        grid +=
            "</Points>\n<Cells>\n"
            + text.array("UInt64", "connectivity", 1, std::vector<std::uint64_t>{0, 1, 2, corner})
            + text.array("UInt64", "offsets", 1, std::vector<std::uint64_t>{4})
            + text.array("UInt8", "types", 1, std::vector<std::uint8_t>{10})
            + "</Cells>\n</Piece>\n</UnstructuredGrid>\n";
        test::write_file(folder / "a.vtu", text.file(grid));
        return read_tetrahedra(folder / "a.vtu");
    };
    const auto message = [&](std::uint64_t corner) {
        return test::error_of([&] { static_cast<void>(read_with(corner)); });
    };
    EXPECT_EQ(read_with(3).mesh.cell_count(), 1);
    test::expect_contains(message((std::uint64_t{1} << 63) - 1),
                          {"cell 0: index 9223372036854775807 of 4"});
    test::expect_contains(
        message(std::uint64_t{1} << 63),
        {"array \"connectivity\": found 9223372036854775808, which is too large"});
}

}  // namespace
}  // namespace pent::mesher
