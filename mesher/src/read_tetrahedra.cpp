#include "carried_arrays.h"
#include "cut_cells.h"
#include "spacetime/moving_fields.h"
#include "tet_readers.h"
#include "vtk_grid.h"

#include <pent/error.h>
#include <pent/input_path.h>
#include <pent/mesher/read_tetrahedra.h>

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace pent::mesher {

namespace {

using Reader = FileGrid (*)(const std::filesystem::path&);

// Of formats that have no arrays.
template <CellSoup (*read)(const std::filesystem::path&)>
FileGrid cells_alone(const std::filesystem::path& path) {
    FileGrid grid;
    grid.soup = read(path);
    return grid;
}

constexpr std::array<std::pair<std::string_view, Reader>, 5> kReaders = {
    {{".node", read_tetgen},
     {".ele", read_tetgen},
     {".mesh", read_medit},
     {".msh", read_gmsh},
     {".tobj", cells_alone<read_tobj>}}};

Reader reader_for(const std::filesystem::path& path, const std::string& format) {
    const std::string ending = format_of(path, format);
    for (const auto& [known, reader] : kReaders) {
        if (ending == known) {
            return reader;
        }
    }
    return nullptr;
}

std::uint16_t region_of(std::int64_t label, const std::string& name) {
    if (label < 0 || label > std::numeric_limits<std::uint16_t>::max()) {
        throw Error(name + ": label " + std::to_string(label)
                    + " of a tetrahedron; expected 0 to 65535");
    }
    return static_cast<std::uint16_t>(label);
}

// What the file calls some of its points or cells.
// @param numbers  Of all of them; empty: from 0.
std::vector<std::int64_t> numbers_of(const std::vector<std::uint32_t>& some,
                                     const std::vector<std::int64_t>& numbers) {
    std::vector<std::int64_t> result;
    for (const std::uint32_t one : some) {
        result.push_back(numbers.empty() ? one : numbers[one]);
    }
    return result;
}

// The values of arrays that are there and finite, as quantities.
// @param things  "points" or "cells".
std::vector<VertexField> fields_of(const std::vector<FileArray>& arrays,
                                   const CarriedArrays& carried,
                                   const std::vector<std::int64_t>& numbers,
                                   const std::string& things,
                                   std::vector<std::string>& left_out) {
    std::vector<VertexField> fields;
    for (std::size_t i = 0; i < carried.arrays.size(); ++i) {
        Eigen::MatrixXd values = values_at(*find_array(arrays, carried.arrays[i]), numbers);
        if (values.allFinite()) {
            fields.push_back({carried.names[i], std::move(values)});
        } else {
            left_out.push_back("array " + carried.arrays[i] + ", which some " + things
                               + " do not have in finite numbers");
        }
    }
    return fields;
}

// Gives the mesh what the arrays of its points and cells have.
void carry_arrays(const FileGrid& grid, const NumberedTetrahedra& numbered, TetrahedraFile& file) {
    std::vector<std::string> left_out = grid.left_out;
    const CarriedArrays of_points = carried_point_arrays(grid, left_out);
    const CarriedArrays of_cells =
        carried_cell_arrays(grid, of_points, file.region_array, left_out);
    file.extras.vertex_fields =
        fields_of(grid.point_arrays, of_points, numbers_of(numbered.points, grid.point_numbers),
                  "points", left_out);
    for (VertexField& field :
         fields_of(grid.cell_arrays, of_cells, numbers_of(numbered.cells, grid.solid_cells),
                   "cells", left_out)) {
        const bool is_fiber = is_fiber_name(field.name) && field.values.rows() == 3;
        if (is_fiber && file.mesh.fibers.cols() == 0) {
            file.mesh.fibers = std::move(field.values);
        } else {
            file.extras.cell_fields.push_back(std::move(field));
        }
    }
    for (const std::string& one : left_out) {
        file.left_out += (file.left_out.empty() ? "" : ", ") + one;
    }
}

}  // namespace

bool has_region_arrays(const std::filesystem::path& path, const std::string& format) {
    const std::string ending = format_of(path, format);
    return ending == ".vtk" || ending == ".vtu";
}

bool is_tetrahedra_file(const std::filesystem::path& path, const std::string& format) {
    return has_region_arrays(path, format) || reader_for(path, format) != nullptr;
}

NumberedTetrahedra number_tetrahedra(const CellSoup& soup, const std::string& name) {
    CutCells cut = cut_cells(soup, name);
    NumberedTetrahedra numbered;
    TetrahedraFile& file = numbered.file;
    file.cut = cut.cut;
    file.left_out = list_counts(soup.counts, CellKind::Triangle, CellKind::Point);
    file.curved_cells = soup.curved_cells;
    file.turned_cells = cut.turned_cells;
    if (cut.tets.empty()) {
        const bool is_surface =
            !list_counts(soup.counts, CellKind::Triangle, CellKind::Polygon).empty();
        throw Error(name + ": no tetrahedron in it nor another cell of three dimensions"
                    + (file.left_out.empty() ? "" : ", but " + file.left_out)
                    + (is_surface ? "; write a surface as .ply, .stl, .obj or .off" : ""));
    }
    std::vector<std::uint32_t> names(soup.points.size(), 0);
    for (const auto& tet : cut.tets) {
        for (const std::uint32_t corner : tet) {
            names[corner] = 1;
        }
    }
    std::uint32_t used = 0;
    for (std::size_t point = 0; point < names.size(); ++point) {
        if (names[point] == 1) {
            numbered.points.push_back(static_cast<std::uint32_t>(point));
            names[point] = used++;
        }
    }
    file.unused_points = static_cast<std::int64_t>(soup.points.size()) - used;
    file.mesh.positions.resize(3, used);
    file.mesh.cells.resize(4, static_cast<Eigen::Index>(cut.tets.size()));
    for (std::size_t t = 0; t < cut.tets.size(); ++t) {
        const auto cell = static_cast<Eigen::Index>(t);
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t point = cut.tets[t][i];
            file.mesh.cells(i, cell) = names[point];
            file.mesh.positions.col(names[point]) = soup.points[point];
        }
    }
    for (const std::int64_t label : cut.labels) {
        file.mesh.regions.push_back(region_of(label, name));
    }
    validate(file.mesh, name);
    numbered.cells = std::move(cut.cells);
    return numbered;
}

TetrahedraFile read_tetrahedra(const std::filesystem::path& path,
                               const std::string& format,
                               const std::string& region_array) {
    const std::string name = input_name(path);
    require_file(path);
    FileGrid grid;
    std::string region_name;
    if (has_region_arrays(path, format)) {
        grid = read_grid(path, format);
        if (const FileArray* regions = mesher::region_array(grid, region_array, path)) {
            region_name = regions->name;
            label_cells(grid, *regions);
        }
    } else if (const Reader reader = reader_for(path, format)) {
        grid = reader(path);
    } else {
        throw Error(name
                    + ": tetrahedra are in .node and .ele, .mesh, .msh, .vtk, .vtu or .tobj files");
    }
    NumberedTetrahedra numbered = number_tetrahedra(grid.soup, name);
    TetrahedraFile file = std::move(numbered.file);
    file.region_array = region_name;
    carry_arrays(grid, numbered, file);
    return file;
}

}  // namespace pent::mesher
