#include "cut_cells.h"
#include "tet_readers.h"

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

// By the path, and the array of VTK's cells that has their labels.
using Reader = CellSoup (*)(const std::filesystem::path&, const std::string&);

// Other formats have one place for labels.
template <CellSoup (*read)(const std::filesystem::path&)>
CellSoup without_arrays(const std::filesystem::path& path, const std::string& /*region_array*/) {
    return read(path);
}

constexpr std::array<std::pair<std::string_view, Reader>, 7> kReaders = {
    {{".node", without_arrays<read_tetgen>},
     {".ele", without_arrays<read_tetgen>},
     {".mesh", without_arrays<read_medit>},
     {".msh", without_arrays<read_gmsh>},
     {".vtk", read_vtk},
     {".vtu", read_vtu},
     {".tobj", without_arrays<read_tobj>}}};

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

}  // namespace

bool has_region_arrays(const std::filesystem::path& path, const std::string& format) {
    const std::string ending = format_of(path, format);
    return ending == ".vtk" || ending == ".vtu";
}

bool is_tetrahedra_file(const std::filesystem::path& path, const std::string& format) {
    return reader_for(path, format) != nullptr;
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
        throw Error(name + ": no tetrahedron in it nor another cell of three dimensions"
                    + (file.left_out.empty() ? "" : ", but " + file.left_out));
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
    const Reader reader = reader_for(path, format);
    if (reader == nullptr) {
        throw Error(name
                    + ": tetrahedra are in .node and .ele, .mesh, .msh, .vtk, .vtu or .tobj files");
    }
    return number_tetrahedra(reader(path, region_array), name).file;
}

}  // namespace pent::mesher
