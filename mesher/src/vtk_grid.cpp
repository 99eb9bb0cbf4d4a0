#include "vtk_grid.h"

#include "xml_file.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/input_path.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pent::mesher {

namespace {

// VTK's number for a type of cells and what it is. In all of them the corners come first.
constexpr std::array<std::pair<std::int64_t, CellKind>, 50> kTypes = {{
    {1, CellKind::Point},
    {2, CellKind::Point},
    {3, CellKind::Line},
    {4, CellKind::Line},
    {5, CellKind::Triangle},
    {6, CellKind::Polygon},  // a strip of triangles
    {7, CellKind::Polygon},
    {8, CellKind::Quadrilateral},  // a pixel
    {9, CellKind::Quadrilateral},
    {10, CellKind::Tetrahedron},
    {11, CellKind::Hexahedron},
    {12, CellKind::Hexahedron},  // the first of these a voxel
    {13, CellKind::Prism},
    {14, CellKind::Pyramid},
    {15, CellKind::PentagonalPrism},
    {16, CellKind::HexagonalPrism},
    {21, CellKind::Line},
    {22, CellKind::Triangle},
    {23, CellKind::Quadrilateral},
    {24, CellKind::Tetrahedron},
    {25, CellKind::Hexahedron},
    {26, CellKind::Prism},
    {27, CellKind::Pyramid},
    {28, CellKind::Quadrilateral},
    {29, CellKind::Hexahedron},
    {30, CellKind::Quadrilateral},
    {31, CellKind::Prism},
    {32, CellKind::Prism},
    {33, CellKind::Hexahedron},
    {34, CellKind::Triangle},
    {35, CellKind::Line},
    {36, CellKind::Polygon},
    {37, CellKind::Pyramid},
    {41, CellKind::Polyhedron},
    {42, CellKind::Polyhedron},
    {68, CellKind::Line},
    {69, CellKind::Triangle},
    {70, CellKind::Quadrilateral},
    {71, CellKind::Tetrahedron},
    {72, CellKind::Hexahedron},
    {73, CellKind::Prism},
    {74, CellKind::Pyramid},
    {75, CellKind::Line},
    {76, CellKind::Triangle},
    {77, CellKind::Quadrilateral},
    {78, CellKind::Tetrahedron},
    {79, CellKind::Hexahedron},
    {80, CellKind::Prism},
    {81, CellKind::Pyramid},
    {0, CellKind::Point},  // empty
}};
// What programs call the labels of cells, without case and separators, those first that say most:
// ours and MFEM; FreeFem; Gmsh and meshio from Gmsh, Medit, TetGen, Nastran, Netgen, SU2, AVS, MED;
// OpenGeoSys; Exodus in ParaView; Elmer; openCARP. The number of a volume is what a file of Gmsh
// without groups has.
constexpr std::array<std::string_view, 28> kRegionNames = {
    "region",          "regions",       "regionid",        "regionids",       "material",
    "materials",       "materialid",    "materialids",     "attribute",       "attributes",
    "label",           "labels",        "gmsh:physical",   "medit:ref",       "tetgen:ref",
    "nastran:ref",     "netgen:index",  "su2:tag",         "avsucd:material", "celltags",
    "elementblockids", "objectid",      "physicalids",     "geometryids",     "elemtag",
    "refid",           "cellentityids", "gmsh:geometrical"};
constexpr std::int64_t kEmpty = 0;
constexpr std::int64_t kVoxel = 11;

// A name as kRegionNames has it.
std::string plain(std::string_view name) {
    std::string result;
    for (const char c : name) {
        if (c != '_' && c != '-' && c != ' ') {
            result += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        }
    }
    return result;
}

CellKind kind_of(std::int64_t number, const Fail& fail) {
    for (const auto& [known, kind] : kTypes) {
        if (number == known) {
            return kind;
        }
    }
    fail("a cell of VTK's type " + std::to_string(number)
         + "; expected 0 to 16, 21 to 37, 41, 42 or 68 to 81");
    return CellKind::Point;  // GCOVR_EXCL_LINE: fail() does not return
}

std::uint32_t checked_corner(std::int64_t corner, std::size_t points, const Fail& fail) {
    if (corner < 0 || std::cmp_greater_equal(corner, points)) {
        fail("index " + std::to_string(corner) + " of " + std::to_string(points));
    }
    return static_cast<std::uint32_t>(corner);
}

const FileArray& array_asked_for(const FileGrid& grid,
                                 const std::string& name,
                                 const std::filesystem::path& path) {
    const FileArray* found = find_array(grid.cell_arrays, name);
    if (found == nullptr || found->components != 1) {
        std::string all;
        for (const FileArray& array : grid.cell_arrays) {
            all += (all.empty() ? "" : ", ") + in_quotes(array.name);
        }
        throw Error(input_name(path) + ": no array \"" + name
                    + "\" of one number a cell; its cells have " + (all.empty() ? "none" : all));
    }
    for (const std::int64_t cell : grid.solid_cells) {
        if (!label_of(*found, cell)) {
            throw Error(input_name(path) + ": array " + in_quotes(name) + ": cell "
                        + std::to_string(cell)
                        + formatted(" has %g; expected whole numbers from 0 to 65535",
                                    found->values[static_cast<std::size_t>(cell)]));
        }
    }
    return *found;
}

}  // namespace

void add_cell(FileGrid& grid,
              std::int64_t type,
              std::span<const std::int64_t> corners,
              const Fail& fail) {
    const std::int64_t number = grid.cell_count++;
    if (type == kEmpty) {
        return;
    }
    const CellKind kind = kind_of(type, fail);
    const std::size_t needed = kind == CellKind::Triangle ? 3 : corners_of(kind);
    if (corners.size() < needed) {
        CellCounts one{};
        one[static_cast<std::size_t>(kind)] = 1;
        fail(list_counts(one, kind, kind) + " with " + counted(corners.size(), "corner", "corners")
             + "; expected " + std::to_string(needed));
    }
    std::vector<std::uint32_t> nodes;
    for (std::size_t i = 0; i < corners.size() && needed > 0; ++i) {
        nodes.push_back(checked_corner(corners[i], grid.soup.points.size(), fail));
    }
    if (type == kVoxel) {  // it counts along the axes, not around its sides
        std::swap(nodes[2], nodes[3]);
        std::swap(nodes[6], nodes[7]);
    }
    grid.soup.add(kind, nodes);
    if (dimension_of(kind) == 3) {
        grid.solid_cells.push_back(number);
    } else if (kind == CellKind::Triangle) {
        grid.triangles.push_back({nodes[0], nodes[1], nodes[2]});
        grid.triangle_cells.push_back(number);
    }
}

std::optional<std::uint16_t> label_of(const FileArray& array, std::int64_t cell) {
    const double value = array.values[static_cast<std::size_t>(cell)];
    if (!(value >= 0 && value <= std::numeric_limits<std::uint16_t>::max())
        || value != std::floor(value)) {
        return std::nullopt;
    }
    return static_cast<std::uint16_t>(value);
}

const FileArray* region_array(const FileGrid& grid,
                              const std::string& asked,
                              const std::filesystem::path& path) {
    if (!asked.empty()) {
        return &array_asked_for(grid, asked, path);
    }
    const auto has_labels = [&](const FileArray& array) {
        return array.components == 1
               && std::all_of(grid.solid_cells.begin(), grid.solid_cells.end(),
                              [&](std::int64_t cell) { return label_of(array, cell).has_value(); });
    };
    for (const std::string_view name : kRegionNames) {
        for (const FileArray& array : grid.cell_arrays) {
            if (plain(array.name) == name && has_labels(array)) {
                return &array;
            }
        }
    }
    return nullptr;
}

void label_cells(FileGrid& grid, const FileArray& regions) {
    grid.soup.has_labels = true;
    for (std::size_t i = 0; i < grid.solid_cells.size(); ++i) {
        grid.soup.labels[i] = *label_of(regions, grid.solid_cells[i]);
    }
}

FileGrid read_grid(const std::filesystem::path& path, const std::string& format) {
    return format_of(path, format) == ".vtu" ? read_vtu_grid(path) : read_vtk_grid(path);
}

}  // namespace pent::mesher
