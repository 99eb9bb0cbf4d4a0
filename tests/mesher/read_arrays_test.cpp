#include "fields_of_base.h"
#include "tet_files.h"

#include <pent/mesher/make_body.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

// What files of Gmsh, TetGen and Medit have of their nodes and cells.

namespace pent::mesher {
namespace {

using test::read_text;

const Eigen::MatrixXd& field(const std::vector<VertexField>& fields, const std::string& name) {
    for (const VertexField& one : fields) {
        if (one.name == name) {
            return one.values;
        }
    }
    throw Error("no " + name);
}

template <typename T>
std::string big_endian(T value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    std::reverse(bytes.begin(), bytes.end());
    return {bytes.data(), bytes.size()};
}

// What the file says follows from the places of vertices and from which cell a cell is, in
// whatever order it has them.
void expect_fields_of_base(const TetrahedraFile& file,
                           const SimplexMesh<3>& base,
                           const std::string& what) {
    const SimplexMesh<3>& mesh = file.mesh;
    ASSERT_EQ(mesh.cell_count(), base.cell_count()) << what;
    ASSERT_EQ(mesh.vertex_count(), base.vertex_count()) << what;
    const Eigen::MatrixXd& warmth = field(file.extras.vertex_fields, "warmth");
    EXPECT_EQ(field(file.extras.vertex_fields, "place"), mesh.positions) << what;
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        EXPECT_EQ(warmth(0, v), test::warmth(mesh.positions.col(v))) << what;
    }
    const Eigen::MatrixXd& number = field(file.extras.cell_fields, "number");
    ASSERT_EQ(mesh.fibers.cols(), mesh.cell_count()) << what;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        const auto of_base = static_cast<Eigen::Index>(number(0, cell));
        EXPECT_EQ(test::corners_of(mesh, cell), test::corners_of(base, of_base)) << what;
        EXPECT_EQ(mesh.fibers.col(cell), test::first_edge(base, of_base)) << what;
    }
}

// Numbers of nodes and elements are as in files of Gmsh: in no order, and with gaps.
TEST(ReadArrays, OfGmshAreThoseOfVtkInEveryVersionAndEncoding) {
    const SimplexMesh<3> base = test::base_box();
    expect_fields_of_base(read_text("a.vtk", test::vtk_with_fields(base)), base, "VTK");
    for (const int version : {2, 4}) {
        for (const char order : {'t', 'l', 'b'}) {  // text, little-endian, big-endian
            const std::string what =
                "version " + std::to_string(version) + " as " + std::string(1, order);
            const TetrahedraFile file =
                read_text("a.msh", test::gmsh_with_fields(base, {version, order}));
            expect_fields_of_base(file, base, what);
            EXPECT_EQ(file.left_out, "2 triangles") << what;
        }
    }
}

TEST(ReadArrays, OfTetGenAreItsAttributesAndMarkers) {
    const SimplexMesh<3> base = test::base_box();
    for (const int first : {0, 1}) {
        const test::TempFolder folder;
        std::string node = formatted("%d 3 2 1\n", static_cast<int>(base.vertex_count()));
        for (Eigen::Index v = 0; v < base.vertex_count(); ++v) {
            const Eigen::Vector3d x = base.positions.col(v);
            node += formatted("%d %.17g %.17g %.17g %.17g %.17g %d\n", static_cast<int>(v) + first,
                              x[0], x[1], x[2], test::warmth(x), -x[1], static_cast<int>(v % 3));
        }
        std::string ele = formatted("%d 4 2\n", static_cast<int>(base.cell_count()));
        for (Eigen::Index cell = 0; cell < base.cell_count(); ++cell) {
            ele += formatted("%d", static_cast<int>(cell) + first);
            for (const std::uint32_t corner : base.cells.col(cell)) {
                ele += formatted(" %d", static_cast<int>(corner) + first);
            }
            ele += formatted(" %d %.17g\n", static_cast<int>(cell % 2) + 5,
                             static_cast<double>(cell) / 8);
        }
        test::write_file(folder / "a.node", node);
        test::write_file(folder / "a.ele", ele);
        const TetrahedraFile file = read_tetrahedra(folder / "a.ele");
        ASSERT_EQ(file.extras.vertex_fields.size(), 3U);
        ASSERT_EQ(file.extras.cell_fields.size(), 1U);
        EXPECT_EQ(file.left_out, "");
        EXPECT_EQ(file.mesh.positions, base.positions);
        for (Eigen::Index v = 0; v < base.vertex_count(); ++v) {
            const Eigen::Vector3d x = base.positions.col(v);
            EXPECT_EQ(field(file.extras.vertex_fields, "attribute1")(0, v), test::warmth(x));
            EXPECT_EQ(field(file.extras.vertex_fields, "attribute2")(0, v), -x[1]);
            EXPECT_EQ(field(file.extras.vertex_fields, "boundary_marker")(0, v), v % 3);
        }
        for (Eigen::Index cell = 0; cell < base.cell_count(); ++cell) {
            EXPECT_EQ(file.mesh.regions[static_cast<std::size_t>(cell)], cell % 2 + 5);
            EXPECT_EQ(field(file.extras.cell_fields, "region_attribute2")(0, cell),
                      static_cast<double>(cell) / 8);
        }
    }
}

// Points that no tetrahedron has are left out, with what the file has of them.
TEST(ReadArrays, OfTetGenGoWithTheirPoints) {
    const test::TempFolder folder;
    test::write_file(folder / "a.node",
                     "6 3 1 0\n1 9 9 9 nan\n2 0 0 0 2\n3 1 0 0 3\n4 8 8 8 inf\n5 0 1 0 5\n"
                     "6 0 0 1 6\n");
    test::write_file(folder / "a.ele", "1 4\n1 2 3 5 6\n");
    const TetrahedraFile file = read_tetrahedra(folder / "a.node");
    EXPECT_EQ(field(file.extras.vertex_fields, "attribute1"), Eigen::RowVector4d(2, 3, 5, 6));
    EXPECT_EQ(file.mesh.regions.size(), 0U);
    test::write_file(folder / "a.ele", "1 4 0\n1 1 3 5 6\n");
    const TetrahedraFile other = read_tetrahedra(folder / "a.node");
    EXPECT_TRUE(other.extras.vertex_fields.empty());
    EXPECT_EQ(other.left_out, "array attribute1, which some points do not have in finite numbers");
}

TEST(ReadArrays, OfTetGenAreRefusedWhereALineHasFewer) {
    const test::TempFolder folder;
    const auto message = [&](const std::string& node, const std::string& ele) {
        test::write_file(folder / "a.node", node);
        test::write_file(folder / "a.ele", ele);
        return test::error_of([&] { static_cast<void>(read_tetrahedra(folder / "a.node")); });
    };
    const std::string points = "4 3 1 1\n1 0 0 0 7 0\n2 1 0 0 7 0\n3 0 1 0 7 0\n";
    const std::string cell = "1 4 2\n1 1 2 3 4 5 7\n";
    test::write_file(folder / "a.node", points + "4 0 0 1 7 0\n");
    test::write_file(folder / "a.ele", cell);
    EXPECT_NO_THROW(static_cast<void>(read_tetrahedra(folder / "a.node")));
    test::expect_contains(message(points + "4 0 0 1\n", cell),
                          {"a.node: line 5", "expected an attribute"});
    test::expect_contains(message(points + "4 0 0 1 7\n", cell),
                          {"a.node: line 5", "expected a boundary marker"});
    test::expect_contains(message(points + "4 0 0 1 7 0\n", "1 4 2\n1 1 2 3 4 5\n"),
                          {"a.ele: line 2", "expected an attribute"});
    test::expect_contains(message("4 3 x 1\n", cell),
                          {"a.node: line 1", "\"x\"", "the number of attributes"});
    test::expect_contains(message("4 3 0 0\n-1 0 0 0\n", cell),
                          {"a.node: line 2", "point number -1; expected 0 or 1"});
    test::expect_contains(message("4 3 900000 1\n1 0 0 0 7 0\n", cell),
                          {"a.node: line 1", "900000"});
}

// Of a quantity for each process, at several times, or of a name that is there twice.
// Each goes with its vertex, however many sections the file has them in and whichever of its points
// no cell uses; where all are 0 there are none.
TEST(ReadArrays, OfMeditAreTheLabelsOfVertices) {
    const SimplexMesh<3> base = test::base_box();
    const auto label = [](const Eigen::Vector3d& x) { return static_cast<int>(9 * x[0] + x[2]); };
    const auto vertices = [&](Eigen::Index first, Eigen::Index last, int factor) {
        std::string text = formatted("Vertices %d\n9 9 9 77\n", static_cast<int>(last - first) + 1);
        for (Eigen::Index v = first; v < last; ++v) {
            const Eigen::Vector3d x = base.positions.col(v);
            text += formatted("%.17g %.17g %.17g %d\n", x[0], x[1], x[2], factor * label(x));
        }
        return text;
    };
    const auto mesh = [&](const std::string& points, bool has_halves) {
        std::string text = "MeshVersionFormatted 2\nDimension 3\n" + points
                           + formatted("Tetrahedra %d\n", static_cast<int>(base.cell_count()));
        const auto half = static_cast<std::uint32_t>(base.vertex_count() / 2);
        for (Eigen::Index cell = 0; cell < base.cell_count(); ++cell) {
            for (const std::uint32_t corner : base.cells.col(cell)) {
                text += std::to_string(corner + (has_halves && corner >= half ? 3 : 2)) + " ";
            }
            text += "4\n";
        }
        return text + "End\n";
    };
    const Eigen::Index half = base.vertex_count() / 2;
    const std::string halves = vertices(0, half, 1) + vertices(half, base.vertex_count(), 1);
    for (const std::string& text :
         {mesh(vertices(0, base.vertex_count(), 1), false), mesh(halves, true)}) {
        const TetrahedraFile file = read_text("a.mesh", text);
        ASSERT_EQ(file.mesh.positions, base.positions);
        EXPECT_EQ(file.left_out, "");
        const Eigen::MatrixXd& labels = field(file.extras.vertex_fields, "vertex_label");
        for (Eigen::Index v = 0; v < base.vertex_count(); ++v) {
            EXPECT_EQ(labels(0, v), label(base.positions.col(v)));
        }
    }
    std::string none = mesh(vertices(0, base.vertex_count(), 0), false);
    none.replace(none.find("77"), 2, "0");
    EXPECT_TRUE(read_text("a.mesh", none).extras.vertex_fields.empty());
}

TEST(ReadArrays, OfGmshSayWhatIsLeftOut) {
    const std::string mesh =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n10 0 0 0\n20 1 0 0\n30 0 1 0\n40 0 0 1\n"
        "$EndNodes\n$Elements\n1\n7 4 2 0 1 10 20 30 40\n$EndElements\n";
    const auto data = [](const std::string& section, const std::string& name,
                         const std::string& step, int components, int part,
                         const std::vector<std::string>& lines) {
        std::string text = "$" + section + "\n1\n\"" + name + "\"\n1\n" + step + "\n4\n" + step
                           + "\n" + std::to_string(components) + "\n" + std::to_string(lines.size())
                           + "\n" + std::to_string(part) + "\n";
        for (const std::string& line : lines) {
            text += line + "\n";
        }
        return text + "$End" + section + "\n";
    };
    const TetrahedraFile file = read_text(
        "a.msh",
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
            + data("NodeData", "early", "0", 1, 0, {"40 4", "30 3", "20 2", "10 1", "99 9"}) + mesh
            + data("NodeData", "parts", "0", 1, 0, {"40 4", "20 2"})
            + data("NodeData", "parts", "0", 1, 1, {"10 1", "20 8", "30 3"})
            + data("NodeData", "parts", "0", 3, 2, {"10 1 2 3"})
            + data("NodeData", "times", "0", 1, 0, {"10 1", "20 2", "30 3", "40 4"})
            + data("NodeData", "times", "1", 1, 0, {"10 5", "20 5", "30 5", "40 5"})
            + data("NodeData", "times", "2", 1, 0, {"10 6", "20 6", "30 6", "40 6"})
            + data("NodeData", "times", "0", 1, 0, {"10 7", "20 7", "30 7", "40 7"})
            + data("NodeData", "lame", "0", 1, 0, {"10 1", "20 2", "40 4"})
            + data("NodeData", "lame", "1", 1, 0, {"30 2"})
            + data("NodeData", "spot", "0", 1, 0, {})
            + data("ElementData", "heat of a cell", "0", 1, 0, {"3 1", "7 6.5"})
            + data("ElementData", "stress", "0", 9, 0, {"7 1 2 3 4 5 6 7 8 9"})
            + data("ElementData", "hole", "0", 1, 0, {"7 nan"})
            + data("ElementNodeData", "corners", "0", 1, 0, {"7 4 1 2 3 4"}));
    ASSERT_EQ(file.extras.vertex_fields.size(), 3U);
    EXPECT_EQ(field(file.extras.vertex_fields, "early"), Eigen::RowVector4d(1, 2, 3, 4));
    EXPECT_EQ(field(file.extras.vertex_fields, "parts"), Eigen::RowVector4d(1, 2, 3, 4));
    EXPECT_EQ(field(file.extras.vertex_fields, "times"), Eigen::RowVector4d(1, 2, 3, 4));
    ASSERT_EQ(file.extras.cell_fields.size(), 1U);
    EXPECT_EQ(field(file.extras.cell_fields, "heat_of_a_cell")(0, 0), 6.5);
    EXPECT_EQ(file.left_out,
              "array parts, a second one, array times, a second one, array corners, of which a node"
              " has one value for each element, array times at 2 other times, array lame at 1 other"
              " time, array stress of 9 components, array lame, which some points do not have in"
              " finite numbers, array spot, which some points do not have in finite numbers, array"
              " hole, which some cells do not have in finite numbers");
}

// The first string, the first real number and the first whole one say which array it is; by the
// last of four, of which process.
TEST(ReadArrays, OfGmshAreToldApartByNameStepTimeAndProcess) {
    const std::string mesh =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n10 0 0 0\n20 1 0 0\n30 0 1 0\n40 0 0 1\n"
        "$EndNodes\n$Elements\n1\n7 4 2 0 1 10 20 30 40\n$EndElements\n";
    const auto half = [](const char* head, const char* values) {
        return std::string("$NodeData\n") + head + "2\n" + values + "$EndNodeData\n";
    };
    const auto text = [&](const char* second_head) {
        return mesh + half("2\n\"a\"\n\"s\"\n2\n0.5\n7\n4\n3\n1\n", "0\n10 1\n20 2\n")
               + half(second_head, "1\n30 3\n40 4\n");
    };
    const auto read = [&](const char* head) { return read_text("a.msh", text(head)); };
    const TetrahedraFile whole = read("2\n\"a\"\n\"t\"\n2\n0.5\n8\n4\n3\n1\n");
    EXPECT_EQ(field(whole.extras.vertex_fields, "a"), Eigen::RowVector4d(1, 2, 3, 4));
    EXPECT_EQ(whole.left_out, "");
    const std::string lacks = "array a, which some points do not have in finite numbers";
    EXPECT_EQ(read("1\n\"a\"\n1\n0.75\n4\n3\n1\n").left_out, "array a at 1 other time, " + lacks);
    EXPECT_EQ(read("1\n\"a\"\n1\n0.5\n4\n4\n1\n").left_out, "array a at 1 other time, " + lacks);
    EXPECT_EQ(read("1\n\"b\"\n1\n0.5\n4\n3\n1\n").left_out,
              lacks + ", array b, which some points do not have in finite numbers");
}

// Groups of surfaces and of volumes have numbers of their own, and so have surfaces and volumes.
TEST(ReadArrays, OfGmshLeaveLabelsToTheGroupsOfVolumes) {
    const auto text = [](const char* surface_groups, const char* volume_groups) {
        return std::string(
                   "$MeshFormat\n4.1 0 8\n$EndMeshFormat\nbetween sections\n$Entities\n0 0 1 2\n"
                   "1 0 0 0 1 1 1 ")
               + surface_groups + " 0\n1 0 0 0 1 1 1 " + volume_groups
               + " 0\n2 0 0 0 1 1 1 1 5 0\n$EndEntities\n$Nodes\n1 5 1 5\n3 1 0 5\n1\n2\n3\n4\n"
                 "5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n-1 0 0\n$EndNodes\n$Elements\n2 2 1 2\n"
                 "3 1 4 1\n1 1 2 3 4\n3 2 4 1\n2 1 5 3 4\n$EndElements\n";
    };
    const auto regions = [&](const char* surface, const char* volume) {
        return read_text("a.msh", text(surface, volume)).mesh.regions;
    };
    EXPECT_EQ(regions("1 9", "0"), (std::vector<std::uint16_t>{0, 5}));
    EXPECT_EQ(regions("0", "2 -8 3"), (std::vector<std::uint16_t>{8, 5}));
}

// The first vector of the cells that is called so is the fibers, and names that a body cannot have
// beside others get a "_".
TEST(ReadArrays, KeepNamesOfNumbersAndVectorsApart) {
    const std::string mesh =
        test::to_legacy_vtk(test::parts_of(test::kuhn_box<3>({1, 1, 1}, {1, 1, 1})));
    const std::string vectors = " double\n1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3\n";
    const std::string others = " double\n4 5 6 4 5 6 4 5 6 4 5 6 4 5 6 4 5 6\n";
    const TetrahedraFile file = read_text(
        "a.vtk", mesh + "CELL_DATA 6\nSCALARS fiber double\nLOOKUP_TABLE default\n1 2 3 4 5 6\n"
                     + "VECTORS wind%20speed" + vectors + "VECTORS fibers" + others
                     + "POINT_DATA 8\nVECTORS u double\n1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3 1 2 3"
                       " 1 2 3\nSCALARS u_x double\nLOOKUP_TABLE default\n1 2 3 4 5 6 7 8\n");
    ASSERT_EQ(file.extras.cell_fields.size(), 2U);
    EXPECT_EQ(file.extras.cell_fields[0].name, "fiber");
    EXPECT_EQ(file.extras.cell_fields[1].name, "wind_speed");
    EXPECT_EQ(file.mesh.fibers.col(5), Eigen::Vector3d(4, 5, 6));
    ASSERT_EQ(file.extras.vertex_fields.size(), 2U);
    EXPECT_EQ(file.extras.vertex_fields[0].name, "u");
    EXPECT_EQ(file.extras.vertex_fields[1].name, "u_x_");

    const TetrahedraFile two = read_text(
        "a.vtk", mesh + "CELL_DATA 6\nVECTORS fibers" + others + "VECTORS fiber" + vectors);
    EXPECT_EQ(two.mesh.fibers.col(5), Eigen::Vector3d(4, 5, 6));
    ASSERT_EQ(two.extras.cell_fields.size(), 1U);
    EXPECT_EQ(two.extras.cell_fields[0].name, "fiber_");
    EXPECT_EQ(two.extras.cell_fields[0].values.col(5), Eigen::Vector3d(1, 2, 3));
}

// Eight points and six tetrahedra, whose numbers follow as bytes, those of most weight first.
std::string binary_vtk(const std::string& arrays) {
    const SimplexMesh<3> base = test::kuhn_box<3>({1, 1, 1}, {1, 1, 1});
    std::string text =
        "# vtk DataFile Version 3.0\na\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n";
    for (const double coordinate : base.positions.reshaped()) {
        text += big_endian(coordinate);
    }
    text += "\nCELLS 6 30\n";
    for (const auto& cell : base.cells.colwise()) {
        text += big_endian(4);
        for (const std::uint32_t corner : cell) {
            text += big_endian(corner);
        }
    }
    text += "\nCELL_TYPES 6\n";
    for (int cell = 0; cell < 6; ++cell) {
        text += big_endian(10);
    }
    return text + "\n" + arrays;
}

template <typename T>
void expect_numbers_of_type(const std::string& type) {
    const std::array<T, 8> numbers = {
        0, 1, std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max(), 2, 3, 100, 127};
    std::string arrays = "POINT_DATA 8\nSCALARS n " + type + "\nLOOKUP_TABLE default\n";
    for (const T number : numbers) {
        arrays += big_endian(number);
    }
    arrays += "\nSCALARS after char\nLOOKUP_TABLE default\n" + std::string(8, '\7') + "\n";
    const TetrahedraFile file = read_text("a.vtk", binary_vtk(arrays));
    for (Eigen::Index v = 0; v < 8; ++v) {
        EXPECT_EQ(field(file.extras.vertex_fields, "n")(0, v),
                  static_cast<double>(numbers[static_cast<std::size_t>(v)]))
            << type;
        EXPECT_EQ(field(file.extras.vertex_fields, "after")(0, v), 7) << type;
    }
}

TEST(ReadArrays, OfLegacyVtkAreNumbersOfAnyType) {
    expect_numbers_of_type<std::int8_t>("char");
    expect_numbers_of_type<std::uint8_t>("unsigned_char");
    expect_numbers_of_type<std::int16_t>("short");
    expect_numbers_of_type<std::uint16_t>("unsigned_short");
    expect_numbers_of_type<std::int32_t>("int");
    expect_numbers_of_type<std::uint32_t>("unsigned_int");
    expect_numbers_of_type<std::int64_t>("long");
    expect_numbers_of_type<std::uint64_t>("unsigned_long");
    expect_numbers_of_type<std::int64_t>("vtktypeint64");
    expect_numbers_of_type<std::uint64_t>("vtktypeuint64");
    expect_numbers_of_type<std::int32_t>("vtkIdType");
    expect_numbers_of_type<float>("float");
    expect_numbers_of_type<double>("double");
}

// Four bytes a color in a file of bytes, none of which is of an array.
TEST(ReadArrays, OfLegacyVtkMayHaveATableOfColorsBetween) {
    const TetrahedraFile file = read_text(
        "a.vtk",
        binary_vtk("POINT_DATA 8\nSCALARS n char\nLOOKUP_TABLE hot\n" + std::string(8, '\3')
                   + "\nLOOKUP_TABLE hot 2\n" + std::string(8, '\377')
                   + "\nSCALARS after char\nLOOKUP_TABLE default\n" + std::string(8, '\7') + "\n"));
    EXPECT_EQ(field(file.extras.vertex_fields, "n"), Eigen::MatrixXd::Constant(1, 8, 3));
    EXPECT_EQ(field(file.extras.vertex_fields, "after"), Eigen::MatrixXd::Constant(1, 8, 7));
}

// Eight to a byte, the first at its highest place; of the last byte those that there are.
TEST(ReadArrays, OfLegacyVtkMayBeBits) {
    const TetrahedraFile file = read_text(
        "a.vtk", binary_vtk("POINT_DATA 8\nSCALARS flag bit\nLOOKUP_TABLE default\n\xa6\n"
                            "CELL_DATA 6\nFIELD f 2\nflags 3 6 bit\n\xa6\x59\xc0\nflag 1 6 bit\n"
                            "\xb4\n"));
    const auto row = [](const std::vector<double>& bits) {
        return Eigen::MatrixXd(Eigen::Map<const Eigen::RowVectorXd>(
            bits.data(), static_cast<Eigen::Index>(bits.size())));
    };
    EXPECT_EQ(field(file.extras.vertex_fields, "flag"), row({1, 0, 1, 0, 0, 1, 1, 0}));
    EXPECT_EQ(Eigen::MatrixXd(field(file.extras.cell_fields, "flags").reshaped(1, 18)),
              row({1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 1}));
    EXPECT_EQ(field(file.extras.cell_fields, "flag_"), row({1, 0, 1, 1, 0, 1}));
}

// Words of a damaged file are as long as it likes; of those that are told 40 letters are.
TEST(ReadArrays, OfLegacyVtkAreRefusedWithWhatStandsThere) {
    const std::string name = "a_word_of_more_letters_than_anybody_would_want_to_read";
    const std::string told = name.substr(0, 40);
    const auto message = [](const std::string& arrays) {
        return test::message_for("a.vtk", binary_vtk("POINT_DATA 8\n" + arrays));
    };
    test::expect_contains(message("FIELD f 1\n" + name + " 1 7 char\n"),
                          {"array " + told + " has 7 rows, expected 8"});
    test::expect_contains(message("VECTORS v " + name + "\n12345678"),
                          {"values of type \"" + told + "\"; expected a type of numbers"});
    test::expect_contains(message("SCALARS s char\n" + name + "\n"),
                          {"found \"" + told + "\", expected LOOKUP_TABLE"});
}

// What shows numbers of vertices and of cells side by side, as slices do, knows them by name.
TEST(ReadArrays, OfPointsAndCellsThatHaveOneNameGetTwo) {
    const SimplexMesh<3> base = test::base_box();
    const Eigen::Index points = base.vertex_count();
    const Eigen::Index cells = base.cell_count();
    const auto numbers = [](Eigen::Index count, int offset) {
        std::string text;
        for (int i = 0; i < count; ++i) {
            text += std::to_string(i + offset) + " ";
        }
        return text + "\n";
    };
    const auto counting = [](Eigen::Index count, int offset) {
        Eigen::VectorXd values(count);
        std::iota(values.begin(), values.end(), offset);
        return values;
    };
    const std::string scalar = "SCALARS heat double\nLOOKUP_TABLE default\n";
    const std::string vector = "VECTORS heat double\n";
    for (const int of_points : {1, 3}) {
        for (const int of_cells : {1, 3}) {
            const TetrahedraFile file = read_text(
                "a.vtk", test::to_legacy_vtk(test::parts_of(base))
                             + formatted("POINT_DATA %d\n", static_cast<int>(points))
                             + (of_points == 1 ? scalar : vector) + numbers(of_points * points, 0)
                             + formatted("CELL_DATA %d\n", static_cast<int>(cells))
                             + (of_cells == 1 ? scalar : vector) + numbers(of_cells * cells, 1000));
            EXPECT_EQ(file.left_out, "");
            ASSERT_EQ(file.extras.vertex_fields.size(), 1U);
            ASSERT_EQ(file.extras.cell_fields.size(), 1U);
            EXPECT_EQ(file.extras.vertex_fields[0].name, "heat");
            EXPECT_EQ(file.extras.cell_fields[0].name, "heat_");
            EXPECT_EQ(Eigen::VectorXd(file.extras.vertex_fields[0].values.reshaped()),
                      counting(of_points * points, 0));
            EXPECT_EQ(Eigen::VectorXd(file.extras.cell_fields[0].values.reshaped()),
                      counting(of_cells * cells, 1000));
        }
    }
}

TEST(ReadArrays, OfGmshAreRefusedWithTheLineWhereTheyAreDamaged) {
    const std::string mesh =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n10 0 0 0\n20 1 0 0\n30 0 1 0\n40 0 0 1\n"
        "$EndNodes\n$Elements\n1\n7 4 2 0 1 10 20 30 40\n$EndElements\n";
    const auto message = [&](const std::string& text) {
        return test::error_of(
            [&] { static_cast<void>(read_text("a.msh", mesh + "$ElementData\n" + text)); });
    };
    const std::string head = "1\n\"a\"\n1\n0\n3\n0\n1\n";
    EXPECT_NO_THROW(static_cast<void>(
        read_text("a.msh", mesh + "$ElementData\n" + head + "1\n7 3.5\n$EndElementData\n")));
    test::expect_contains(
        message(head + "2\n7 3.5\n$EndElementData\n"),
        {"a.msh: line 25", "\"$EndElementData\"", "expected a number of a node or element"});
    test::expect_contains(message(head + "1\n7 3.5\n8 3\n$EndElementData\n"),
                          {"a.msh: line 25", "more or less than the 1", "$EndElementData"});
    test::expect_contains(message(head + "1\n7 3.5 4.5\n$EndElementData\n"),
                          {"a.msh: line 24", "more than a number and 1 value"});
    test::expect_contains(message("1\n\"a\"\n1\n0\n2\n0\n1\n1\n7 3.5\n$EndElementData\n"),
                          {"2 whole numbers; expected 3 or more"});
    test::expect_contains(message("1\n\"a\"\n1\n0\n3\n0\n99999999\n0\n$EndElementData\n"),
                          {"99999999", "the numbers of a value"});
    test::expect_contains(message("1\n"), {"the file ends here", "a name"});
    test::expect_contains(message("1\n\"a\"\n1\nwarm\n"), {"\"warm\"", "a real number"});
    test::expect_contains(message(head + "1\n7 warm\n"), {"line 24", "\"warm\"", "a value"});
}

// Quantities go the whole way, as those of VTK do (extrude_fields_test).
TEST(ReadArrays, OfGmshGoIntoAnExtrudedBody) {
    const test::TempFolder folder;
    const SimplexMesh<3> base = test::base_box();
    test::write_file(folder / "a.msh", test::gmsh_with_fields(base, {4, 'l'}));
    test::write_file(folder / "a.vtk", test::vtk_with_fields(base));
    const auto made = [&](const char* name, const std::function<void(BodyRequest&)>& change) {
        BodyRequest request;
        request.input = folder / name;
        request.extrusion.layers = 3;
        change(request);
        return make_body(request);
    };
    const std::vector<std::function<void(BodyRequest&)>> changes = {
        [](BodyRequest&) {},
        [](BodyRequest& r) { r.extrusion.direction = Eigen::Vector4d(0.1, 0.2, 0.3, -0.5); },
        [](BodyRequest& r) { r.extrusion.round = true; }, [](BodyRequest& r) { r.subdivide = 2; }};
    for (const auto& change : changes) {
        const Body<4> body = made("a.msh", change);
        const Body<4> other = made("a.vtk", change);
        ASSERT_EQ(body.mesh.vertex_count(), other.mesh.vertex_count());
        const auto sum = [](const Body<4>& of, const std::string& name) {
            return field(name == "number" ? of.extras.cell_fields : of.extras.vertex_fields, name)
                .rowwise()
                .sum()
                .eval();
        };
        for (const char* const name : {"warmth", "place", "number"}) {
            // In another order: rounding of a sum of some hundred numbers below 10.
            EXPECT_LT((sum(body, name) - sum(other, name)).norm(), 1e-9) << name;
        }
        ASSERT_EQ(body.mesh.fibers.cols(), body.mesh.cell_count());
        EXPECT_NEAR(body.mesh.fibers.squaredNorm(), other.mesh.fibers.squaredNorm(), 1e-9);
    }
}

}  // namespace
}  // namespace pent::mesher
