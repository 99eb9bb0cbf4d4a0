#include "tet_files.h"

#include <pent/mesher/prove.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

// Files with cells of many kinds, as text and as bytes.

namespace pent::mesher {
namespace {

using test::message_for;
using test::read_text;

// A number of a binary file.
template <typename T>
std::string raw(T value, bool is_big_endian) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (is_big_endian) {
        std::reverse(bytes.begin(), bytes.end());
    }
    return {bytes.data(), bytes.size()};
}

template <typename T, typename Values>
std::string raw_all(const Values& values, bool is_big_endian) {
    std::string bytes;
    for (const auto value : values) {
        bytes += raw(static_cast<T>(value), is_big_endian);
    }
    return bytes;
}

template <typename Values>
std::string words(const Values& values) {
    std::ostringstream text;
    for (const auto value : values) {
        text << ' ' << value;
    }
    return text.str();
}

// A unit cube, a pyramid on it, a tetrahedron at the pyramid's side, a prism at the cube's; and a
// triangle and a line. Corners count from 0.
const std::vector<double> kCoordinates = {0, 0, 0, 1, 0, 0, 1,  1,  0, 0, 1,  0, 0, 0, 1, 1, 0, 1,
                                          1, 1, 1, 0, 1, 1, .5, .5, 2, 2, .5, 2, 2, 0, 0, 2, 1, 0};
constexpr std::int64_t kPoints = 12;
constexpr double kVolume = 1 + 1.0 / 3 + 0.25 + 0.5;

struct Cell {
    int gmsh;
    int vtk;
    std::string medit;
    std::vector<int> corners;
    int label;  // of Gmsh a physical group, 0 for none; each cell is an entity of its own
};
const std::vector<Cell> kCells = {{1, 3, "Edges", {0, 1}, 1},
                                  {2, 5, "Triangles", {0, 2, 1}, 1},
                                  {5, 12, "Hexahedra", {0, 1, 2, 3, 4, 5, 6, 7}, 7},
                                  {7, 14, "Pyramids", {4, 5, 6, 7, 8}, 8},
                                  {4, 10, "Tetrahedra", {5, 6, 8, 9}, 9},
                                  {6, 13, "Prisms", {1, 10, 5, 2, 11, 6}, 10}};

std::vector<int> plus(const std::vector<int>& corners, int number) {
    std::vector<int> result;
    for (const int corner : corners) {
        result.push_back(corner + number);
    }
    return result;
}

std::string medit() {
    std::string text = "MeshVersionFormatted 2\nDimension 3\nVertices 12\n";
    for (std::size_t i = 0; i < kCoordinates.size(); i += 3) {
        text += words(std::vector(kCoordinates.begin() + static_cast<std::ptrdiff_t>(i),
                                  kCoordinates.begin() + static_cast<std::ptrdiff_t>(i) + 3))
                + " 0\n";
    }
    for (const Cell& cell : kCells) {
        text += cell.medit + " 1\n" + words(plus(cell.corners, 1)) + " "
                + std::to_string(cell.label) + "\n";
    }
    return text + "End\n";
}

std::string gmsh_start(const std::string& version, bool is_binary, bool is_big_endian) {
    return "$MeshFormat\n" + version
           + (is_binary ? " 1 8\n" + raw(1, is_big_endian) + "\n" : " 0 8\n") + "$EndMeshFormat\n";
}

std::string gmsh_2(bool is_binary,
                   bool is_big_endian = false,
                   const std::vector<Cell>& cells = kCells) {
    std::string text = gmsh_start("2.2", is_binary, is_big_endian)
                       + "$PhysicalNames\n1\n3 7 \"cube\"\n$EndPhysicalNames\n$Nodes\n12\n";
    for (int i = 0; i < kPoints; ++i) {
        const std::vector<double> point(kCoordinates.begin() + 3 * i,
                                        kCoordinates.begin() + 3 * i + 3);
        text += is_binary ? raw(i + 5, is_big_endian) + raw_all<double>(point, is_big_endian)
                          : std::to_string(i + 5) + words(point) + "\n";
    }
    text += std::string(is_binary ? "\n" : "") + "$EndNodes\n$Elements\n6\n";
    int number = 0;
    for (const Cell& cell : cells) {
        ++number;
        const std::vector<int> tags = {cell.label, number};
        const std::vector<int> nodes = plus(cell.corners, 5);
        if (is_binary) {
            text += raw_all<int>(std::vector{cell.gmsh, 1, 2, number}, is_big_endian)
                    + raw_all<int>(tags, is_big_endian) + raw_all<int>(nodes, is_big_endian);
        } else {
            text += words(std::vector{number, cell.gmsh, 2}) + words(tags) + words(nodes) + "\n";
        }
    }
    return text + (is_binary ? "\n" : "") + "$EndElements\n";
}

int dimension_of(const Cell& cell) {
    return cell.gmsh == 1 ? 1 : cell.gmsh == 2 ? 2 : 3;
}

// In a mesh for several processes each cell is all of a part of its entity, by a number of its own.
std::string gmsh_4(bool is_binary,
                   bool is_big_endian = false,
                   const std::vector<Cell>& cells = kCells,
                   bool is_partitioned = false) {
    const auto numbers = [&](const std::vector<int>& values) {
        return is_binary ? raw_all<int>(values, is_big_endian) : words(values) + "\n";
    };
    const auto longs = [&](const std::vector<int>& values) {
        return is_binary ? raw_all<std::uint64_t>(values, is_big_endian) : words(values) + "\n";
    };
    const auto reals = [&](const std::vector<double>& values) {
        return is_binary ? raw_all<double>(values, is_big_endian) : words(values) + "\n";
    };
    const std::string end = is_binary ? "\n" : "";
    std::vector<int> names;
    for (int i = 0; i < kPoints; ++i) {
        names.push_back(i + 5);
    }
    // A point of a group, and each cell bounded by two of what has the numbers 1 and -2.
    std::string text = gmsh_start("4.1", is_binary, is_big_endian) + "$Entities\n"
                       + longs({1, 1, 1, 4}) + numbers({3}) + reals({0, 0, 0}) + longs({1})
                       + numbers({77});
    int number = 0;
    for (const Cell& cell : cells) {
        text += numbers({++number}) + reals({0, 0, 0, 1, 1, 2});
        // The first group counts, whichever way it is turned.
        text += cell.label == 0 ? longs({0}) : longs({2}) + numbers({-cell.label, 99});
        text += longs({2}) + numbers({1, -2});
    }
    text += end + "$EndEntities\n";
    constexpr int kFirstPart = 100;
    if (is_partitioned) {
        // Of two processes, with cells of the other one at 55; a surface has the number of a cell.
        text += "$PartitionedEntities\n" + longs({2, 1}) + numbers({55, 1}) + longs({1, 0, 1, 4})
                + numbers({7, 0, 3}) + longs({2}) + numbers({1, 2}) + reals({0, 0, 0}) + longs({0})
                + numbers({kFirstPart + 3, 2, 4}) + longs({1}) + numbers({1})
                + reals({0, 0, 0, 1, 1, 2}) + longs({1}) + numbers({66}) + longs({0});
        number = 0;
        for (const Cell& cell : cells) {
            ++number;
            if (dimension_of(cell) < 3) {
                continue;
            }
            text += numbers({kFirstPart + number, 3, number}) + longs({1}) + numbers({2})
                    + reals({0, 0, 0, 1, 1, 2});
            text += cell.label == 0 ? longs({0}) : longs({1}) + numbers({cell.label});
            text += longs({1}) + numbers({1});
        }
        text += end + "$EndPartitionedEntities\n";
    }
    text += "$Nodes\n" + longs({1, kPoints, 5, kPoints + 4}) + numbers({3, 1, 0}) + longs({kPoints})
            + longs(names) + reals(kCoordinates) + end + "$EndNodes\n$Elements\n"
            + longs({6, 6, 1, 6});
    number = 0;
    for (const Cell& cell : cells) {
        std::vector<int> row = plus(cell.corners, 5);
        row.insert(row.begin(), ++number);
        text += numbers({dimension_of(cell), number + (is_partitioned ? kFirstPart : 0), cell.gmsh})
                + longs({1}) + longs(row);
    }
    return text + end + "$EndElements\n";
}

// VTK's binary files are big-endian.
std::string vtk(bool is_binary, bool has_offsets) {
    const auto numbers = [&](const std::vector<int>& values) {
        return is_binary ? raw_all<int>(values, true) + "\n" : words(values) + "\n";
    };
    const auto longs = [&](const std::vector<int>& values) {
        return is_binary ? raw_all<std::int64_t>(values, true) + "\n" : words(values) + "\n";
    };
    std::vector<int> sized;
    std::vector<int> offsets = {0};
    std::vector<int> corners;
    std::vector<int> types;
    for (const Cell& cell : kCells) {
        sized.push_back(static_cast<int>(cell.corners.size()));
        sized.insert(sized.end(), cell.corners.begin(), cell.corners.end());
        corners.insert(corners.end(), cell.corners.begin(), cell.corners.end());
        offsets.push_back(static_cast<int>(corners.size()));
        types.push_back(cell.vtk);
    }
    std::string text = std::string("# vtk DataFile Version ") + (has_offsets ? "5.1" : "3.0")
                       + "\n\n" + (is_binary ? "BINARY" : "ASCII")
                       + "\nDATASET UNSTRUCTURED_GRID\nFIELD FieldData 1\nTIME 1 1 double\n"
                       + (is_binary ? raw(0.5, true) : "0.5") + "\nPOINTS 12 double\n"
                       + (is_binary ? raw_all<double>(kCoordinates, true) : words(kCoordinates))
                       + "\nMETADATA\nINFORMATION 0\n\n";
    if (has_offsets) {
        text += "CELLS 7 " + std::to_string(corners.size()) + "\nOFFSETS vtktypeint64\n"
                + longs(offsets) + "CONNECTIVITY vtktypeint64\n" + longs(corners);
    } else {
        text += "CELLS 6 " + std::to_string(sized.size()) + "\n" + numbers(sized);
    }
    return text + "\nCELL_TYPES 6\n" + numbers(types) + "\nCELL_DATA 6\n";
}

struct Sample {
    std::string name;
    std::string content;
    bool has_labels;
};

std::vector<Sample> texts() {
    return {{"a.mesh", medit(), true},
            {"a.msh", gmsh_2(false), true},
            {"a.msh", gmsh_4(false), true},
            {"a.vtk", vtk(false, false), false},
            {"a.vtk", vtk(false, true), false}};
}

std::vector<Sample> binaries() {
    return {{"a.msh", gmsh_2(true), true},      {"a.msh", gmsh_2(true, true), true},
            {"a.msh", gmsh_4(true), true},      {"a.msh", gmsh_4(true, true), true},
            {"a.vtk", vtk(true, false), false}, {"a.vtk", vtk(true, true), false}};
}

void expect_all_cells(const Sample& sample) {
    const TetrahedraFile file = read_text(sample.name, sample.content);
    EXPECT_EQ(file.cut, "1 pyramid, 1 prism, 1 hexahedron into 11 tetrahedra") << sample.name;
    EXPECT_EQ(file.left_out, "1 triangle, 1 line");
    EXPECT_EQ(file.mesh.cell_count(), 12);
    const Proof proof = prove<3>(file.mesh, kVolume);
    EXPECT_TRUE(proof.holds()) << describe_faults(proof, 3);
    // Squares 4 of the cube, 2 of the prism; triangles 3, 3 and 2 of the others.
    EXPECT_EQ(proof.boundary_facets, 2 * (4 + 2) + 3 + 3 + 2);
    if (sample.has_labels) {
        EXPECT_EQ(std::count(file.mesh.regions.begin(), file.mesh.regions.end(), 7), 6);
        EXPECT_EQ(std::count(file.mesh.regions.begin(), file.mesh.regions.end(), 10), 3);
    }
}

TEST(ReadCells, CutsWhatIsNoTetrahedronInEveryFormat) {
    for (const Sample& sample : texts()) {
        SCOPED_TRACE(sample.content);
        expect_all_cells(sample);
    }
}

TEST(ReadCells, ReadsBytesAsItReadsText) {
    for (const Sample& sample : binaries()) {
        expect_all_cells(sample);
    }
}

// Groups are regions; where there is none the volumes are, by their own numbers.
TEST(ReadCells, GivesTheSameRegionsInBothVersionsOfGmshAndInParts) {
    std::vector<Cell> some = kCells;
    some[3].label = 0;
    std::vector<Cell> none = kCells;
    for (Cell& cell : none) {
        cell.label = 0;
    }
    using Regions = std::vector<std::uint16_t>;  // 6 of the cube, 2 of the pyramid, 1 and 3
    const std::pair<std::vector<Cell>, Regions> expected[] = {
        {kCells, {7, 7, 7, 7, 7, 7, 8, 8, 9, 10, 10, 10}},
        {some, {7, 7, 7, 7, 7, 7, 0, 0, 9, 10, 10, 10}},
        {none, {3, 3, 3, 3, 3, 3, 4, 4, 5, 6, 6, 6}}};
    for (const auto& [cells, regions] : expected) {
        for (const std::string& file :
             {gmsh_2(false, false, cells), gmsh_2(true, false, cells), gmsh_2(true, true, cells),
              gmsh_4(false, false, cells), gmsh_4(true, false, cells), gmsh_4(true, true, cells),
              gmsh_4(false, false, cells, true), gmsh_4(true, true, cells, true)}) {
            EXPECT_EQ(read_text("a.msh", file).mesh.regions, regions);
        }
    }
}

TEST(ReadCells, RefusesBytesCutOffAnywhere) {
    for (const Sample& sample : binaries()) {
        // Behind the last corner or type only closing words follow.
        const std::size_t last =
            std::min(sample.content.find("\n$EndElements"), sample.content.find("\n\nCELL_DATA"));
        for (std::size_t length = 0; length < last; length += 3) {
            EXPECT_NE(message_for(sample.name, sample.content.substr(0, length)), "")
                << sample.name << " at " << length;
        }
    }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

TEST(ReadCells, SaysWhatIsWrongInBytesAndWhere) {
    const std::string gmsh = gmsh_2(true);
    test::expect_contains(message_for("a.msh", replaced(gmsh, "2.2 1 8", "2.2 1 4")),
                          {"a.msh: line 2", "numbers of 4 bytes", "expected 8"});
    test::expect_contains(message_for("a.msh", replaced(gmsh, raw(1, false), raw(2, false))),
                          {"a.msh: byte 24", "found 2", "the number 1 of a binary file"});
    const std::size_t nodes = gmsh.find("$Nodes\n12\n") + 10;
    test::expect_contains(message_for("a.msh", gmsh.substr(0, nodes + 20)),
                          {"a.msh: byte ", "the file ends here; expected a coordinate"});
    std::string infinite = gmsh;
    infinite.replace(nodes + 4, 8, raw(std::numeric_limits<double>::infinity(), false));
    test::expect_contains(message_for("a.msh", infinite),
                          {"a.msh: byte " + std::to_string(nodes + 28), "not finite"});
    test::expect_contains(
        message_for("a.vtk", replaced(vtk(true, false), "POINTS 12 double", "POINTS 12 bit")),
        {"points of type \"bit\"", "expected float or double"});
    test::expect_contains(
        message_for("a.vtk", replaced(vtk(true, true), "TIME 1 1 double", "TIME 1 1 half")),
        {"values of type \"half\"", "a type of numbers"});
    test::expect_contains(
        message_for("a.vtk", replaced(vtk(true, true), "CONNECTIVITY", "CONECTIVITY")),
        {"found \"CONECTIVITY\", expected CONNECTIVITY"});
}

TEST(ReadCells, RefusesCellsOfOtherKindsWithTheirNumber) {
    const std::string start =
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
        "0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 3 14\n4 0 1 2 3\n4 0 1 2 3\n3 0 1 2\nCELL_TYPES 3\n";
    test::expect_contains(message_for("a.vtk", start + "42\n42\n10\n"),
                          {"a.vtk: line 14", "1 tetrahedron with 3 corners; expected 4"});
    test::expect_contains(message_for("a.vtk", start + "10\n42\n42\n"),
                          {"a.vtk: 2 polyhedra; expected tetrahedra, pyramids, prisms"});
    test::expect_contains(message_for("a.vtk", start + "10\n17\n5\n"),
                          {"a.vtk: line 13", "a cell of VTK's type 17"});
    test::expect_contains(message_for("a.vtk", start + "5\n9\n0\n"),
                          {"no tetrahedron in it nor another", "1 triangle, 1 quadrilateral"});
    test::expect_contains(message_for("a.msh", replaced(gmsh_4(false), " 3 3 5\n", " 3 3 35\n")),
                          {"a.msh: line ", "elements of Gmsh's type 35", "up to order 5"});
    test::expect_contains(
        message_for("a.msh", replaced(gmsh_2(false), "6 7 8 9 10 11 12\n", "6 7\n")),
        {"a.msh: line "});
    test::expect_contains(
        message_for("a.msh", replaced(gmsh_4(false), " 1 1 1 4\n", " 1 1 1 3\n")),
        {"a.msh: line ", "more or less than the numbers of points", "expected $EndEntities"});
}

TEST(ReadCells, TakesTheCornersOfCellsOfHigherOrderAndSaysSo) {
    const std::string points =
        "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
    const TetrahedraFile medit =
        read_text("a.mesh", points + "TetrahedraP2 1\n1 2 3 4 1 1 1 1 1 1 5\nEnd\n");
    EXPECT_EQ(medit.curved_cells, 1);
    EXPECT_EQ(medit.mesh.cell_count(), 1);
    const TetrahedraFile gmsh = read_text(
        "a.msh", gmsh_start("2.2", false, false)
                     + "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n1\n"
                       "1 11 0 1 2 3 4 1 1 1 1 1 1\n$EndElements\n");
    EXPECT_EQ(gmsh.curved_cells, 1);
    EXPECT_EQ(read_text("a.mesh", points + "Tetrahedra 1\n1 2 3 4 5\n").curved_cells, 0);
}

TEST(ReadCells, CountsAVoxelAlongTheAxes) {
    const TetrahedraFile file = read_text(
        "a.vtk",
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n"
        "0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1\nCELLS 1 9\n8 0 1 2 3 4 5 6 7\n"
        "CELL_TYPES 1\n11\n");
    EXPECT_TRUE(prove<3>(file.mesh, 1).holds());
}

}  // namespace
}  // namespace pent::mesher
