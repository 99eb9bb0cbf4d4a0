#include "../carried_arrays.h"
#include "../sound_base.h"
#include "../tet_readers.h"
#include "../vtk_grid.h"
#include "../xml_file.h"
#include "frame_list.h"
#include "moving_fields.h"
#include "run_frames.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/facets.h>
#include <pent/formatted.h>
#include <pent/input_path.h>
#include <pent/mesher/moving_mesh.h>

#include <algorithm>
#include <array>
#include <utility>

namespace pent::mesher {

namespace {

namespace fs = std::filesystem;
using Triangle = std::array<std::uint32_t, 3>;

FileGrid read_frame_grid(const fs::path& path) {
    require_file(path);
    const std::string ending = format_of(path, "");
    if (ending != ".vtu" && ending != ".vtk") {
        throw Error(path.string() + ": expected an unstructured grid as .vtu or legacy .vtk"
                    + (ending == ".pvtu" ? ": merge the parts first" : ""));
    }
    return read_grid(path);
}

std::string corners_text(const CellSoup& soup, std::size_t first, std::size_t count) {
    std::string text;
    for (std::size_t i = first; i < std::min(first + count, soup.corners.size()); ++i) {
        text += (text.empty() ? "" : " ") + std::to_string(soup.corners[i]);
    }
    return text;
}

// Throws unless both grids have the same cells.
void require_same_cells(const FileGrid& first,
                        const FileGrid& grid,
                        const fs::path& first_path,
                        const fs::path& path) {
    const std::string remedy =
        "; the frames of a space-time mesh have one connectivity: end the series before this file,"
        " or carry one mesh through all frames";
    const auto differ = [&](const std::string& found, const std::string& expected) {
        throw Error(path.string() + ": " + found + ", in " + first_path.filename().string() + " "
                    + expected + remedy);
    };
    const CellSoup& a = first.soup;
    const CellSoup& b = grid.soup;
    if (a.points.size() != b.points.size()) {
        differ(counted(b.points.size(), "point", "points"), std::to_string(a.points.size()));
    }
    std::size_t at = 0;
    for (std::size_t cell = 0; cell < std::min(a.kinds.size(), b.kinds.size()); ++cell) {
        const std::size_t count = corners_of(a.kinds[cell]);
        const std::size_t found = corners_of(b.kinds[cell]);
        if (a.kinds[cell] != b.kinds[cell]
            || !std::equal(a.corners.begin() + static_cast<std::ptrdiff_t>(at),
                           a.corners.begin() + static_cast<std::ptrdiff_t>(at + count),
                           b.corners.begin() + static_cast<std::ptrdiff_t>(at))) {
            differ("cell " + std::to_string(grid.solid_cells[cell]) + " has the corners "
                       + corners_text(b, at, found),
                   corners_text(a, at, count));
        }
        at += count;
    }
    if (a.kinds.size() != b.kinds.size()) {
        differ(counted(b.kinds.size(), "cell", "cells") + " of three dimensions",
               std::to_string(a.kinds.size()));
    }
}

// Collects the frames of a series of grids.
class Collector {
public:
    Collector(MovingMesh& mesh, const SeriesOptions& options) : mesh_(mesh), options_(options) {}

    void add_first(FileGrid grid, const fs::path& path) {
        first_path_ = path;
        const FileArray* regions = region_array(grid, options_.region_array, path);
        if (regions != nullptr) {
            region_name_ = regions->name;
            label_cells(grid, *regions);
            grid.soup.counts[static_cast<std::size_t>(CellKind::Triangle)] =
                std::count_if(grid.triangle_cells.begin(), grid.triangle_cells.end(),
                              [&](std::int64_t cell) { return !label_of(*regions, cell); });
        }
        NumberedTetrahedra numbered = number_tetrahedra(grid.soup, path.string());
        mesh_.base = std::move(numbered.file.mesh);
        mesh_.base.positions *= options_.scale;
        mesh_.cut = std::move(numbered.file.cut);
        mesh_.left_out = std::move(numbered.file.left_out);
        mesh_.curved_cells = numbered.file.curved_cells;
        for (const std::uint32_t point : numbered.points) {
            points_.push_back(point);
        }
        for (const std::uint32_t cell : numbered.cells) {
            cells_.push_back(grid.solid_cells[cell]);
            mesh_.cell_numbers.push_back(static_cast<std::uint32_t>(grid.solid_cells[cell]));
        }
        if (regions != nullptr) {
            add_triangles(grid, *regions);
        }
        const CarriedArrays of_points = carried_point_arrays(grid, dropped_);
        vertex_arrays_ = begin_fields(of_points, mesh_.vertex_fields);
        cell_arrays_ = begin_fields(carried_cell_arrays(grid, of_points, region_name_, dropped_),
                                    mesh_.cell_fields);
        first_ = std::move(grid);
        add_frame(first_, path);
    }

    void add(const FileGrid& grid, const fs::path& path) {
        require_same_cells(first_, grid, first_path_, path);
        if (!region_name_.empty()) {
            require_same_regions(grid, path);
        }
        note_late(grid.point_arrays, first_.point_arrays, vertex_arrays_, mesh_.vertex_fields);
        note_late(grid.cell_arrays, first_.cell_arrays, cell_arrays_, mesh_.cell_fields);
        add_frame(grid, path);
    }

    // Says what the files have and the mesh will not.
    void finish() {
        for (std::vector<MovingField>* fields : {&mesh_.vertex_fields, &mesh_.cell_fields}) {
            for (std::string& name : remove_unfinished(*fields, mesh_.frame_count(), "array")) {
                dropped_.push_back(std::move(name));
            }
        }
        for (const std::string& name : dropped_) {
            mesh_.left_out += (mesh_.left_out.empty() ? "" : ", ") + name;
        }
    }

private:
    static Triangle sorted(Triangle corners) {
        std::sort(corners.begin(), corners.end());
        return corners;
    }

    // In the order of their sorted corners.
    [[nodiscard]] std::vector<Triangle> boundary_triangles() const {
        std::vector<Triangle> triangles;
        const FacetMatch<3> match = match_facets<3>(mesh_.base.cells, mesh_.base.vertex_count());
        for (const auto& facet : match.boundary.colwise()) {
            triangles.push_back(sorted({facet[0], facet[1], facet[2]}));
        }
        std::sort(triangles.begin(), triangles.end());
        return triangles;
    }

    void add_triangles(const FileGrid& grid, const FileArray& regions) {
        std::vector<std::int64_t> vertex_of(grid.soup.points.size(), -1);
        for (std::size_t vertex = 0; vertex < points_.size(); ++vertex) {
            vertex_of[static_cast<std::size_t>(points_[vertex])] =
                static_cast<std::int64_t>(vertex);
        }
        const std::vector<Triangle> sides = boundary_triangles();
        std::vector<Triangle> kept;
        std::int64_t inner = 0;
        for (std::size_t t = 0; t < grid.triangles.size(); ++t) {
            const auto label = label_of(regions, grid.triangle_cells[t]);
            if (!label) {
                continue;
            }
            Triangle corners{};
            bool is_of_mesh = true;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int64_t vertex = vertex_of[grid.triangles[t][k]];
                is_of_mesh = is_of_mesh && vertex >= 0;
                corners[k] = static_cast<std::uint32_t>(std::max<std::int64_t>(vertex, 0));
            }
            if (is_of_mesh && std::binary_search(sides.begin(), sides.end(), sorted(corners))) {
                kept.push_back(corners);
                mesh_.triangle_labels.push_back(*label);
            } else {
                ++inner;
            }
        }
        if (inner > 0) {
            dropped_.push_back(std::to_string(inner) + (inner == 1 ? " triangle" : " triangles")
                               + " with a label that " + (inner == 1 ? "is" : "are")
                               + " not on the boundary");
        }
        mesh_.triangles.resize(3, static_cast<Eigen::Index>(kept.size()));
        for (std::size_t t = 0; t < kept.size(); ++t) {
            for (int k = 0; k < 3; ++k) {
                mesh_.triangles(k, static_cast<Eigen::Index>(t)) = kept[t][k];
            }
        }
    }

    static std::vector<std::string> begin_fields(CarriedArrays carried,
                                                 std::vector<MovingField>& fields) {
        for (std::string& name : carried.names) {
            fields.push_back({std::move(name), {}});
        }
        return std::move(carried.arrays);
    }

    // Arrays that the first frame lacks become fields without its values, which finish() tells of.
    static void note_late(const std::vector<FileArray>& arrays,
                          const std::vector<FileArray>& first,
                          std::vector<std::string>& names,
                          std::vector<MovingField>& fields) {
        for (const FileArray& array : arrays) {
            if (find_array(first, array.name) == nullptr
                && std::find(names.begin(), names.end(), array.name) == names.end()) {
                names.push_back(array.name);
                fields.push_back({array.name, {}});
            }
        }
    }

    void add_frame(const FileGrid& grid, const fs::path& path) {
        Positions<3> positions(3, static_cast<Eigen::Index>(points_.size()));
        for (std::size_t vertex = 0; vertex < points_.size(); ++vertex) {
            positions.col(static_cast<Eigen::Index>(vertex)) =
                grid.soup.points[static_cast<std::size_t>(points_[vertex])] * options_.scale;
        }
        mesh_.positions.push_back(std::move(positions));
        mesh_.frames.push_back(path.filename().string());
        add_fields(grid.point_arrays, points_, vertex_arrays_, mesh_.vertex_fields);
        add_fields(grid.cell_arrays, cells_, cell_arrays_, mesh_.cell_fields);
    }

    static void add_fields(const std::vector<FileArray>& arrays,
                           const std::vector<std::int64_t>& tuples,
                           const std::vector<std::string>& names,
                           std::vector<MovingField>& fields) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            const FileArray* found = find_array(arrays, names[i]);
            if (found == nullptr) {
                continue;
            }
            Eigen::MatrixXd values = values_at(*found, tuples);
            if (values.allFinite()) {
                add_values(std::move(values), fields[i]);
            }
        }
    }

    void require_same_regions(const FileGrid& grid, const fs::path& path) const {
        const FileArray& first = *find_array(first_.cell_arrays, region_name_);
        const FileArray* now = find_array(grid.cell_arrays, region_name_);
        for (const std::int64_t cell : cells_) {
            if (now == nullptr || now->components != 1
                || now->values[static_cast<std::size_t>(cell)]
                       != first.values[static_cast<std::size_t>(cell)]) {
                throw Error(path.string() + ": array " + in_quotes(region_name_)
                            + (now == nullptr ? " is missing"
                                              : ": cell " + std::to_string(cell)
                                                    + " has another label")
                            + " than in " + first_path_.filename().string()
                            + "; labels are those of the cells in all frames: choose another array"
                              " by --region-array");
            }
        }
    }

    MovingMesh& mesh_;
    const SeriesOptions& options_;
    FileGrid first_;
    fs::path first_path_;
    std::string region_name_;
    std::vector<std::int64_t> points_;  // of the files, for each vertex
    std::vector<std::int64_t> cells_;   // the same for each tetrahedron
    std::vector<std::string> vertex_arrays_;
    std::vector<std::string> cell_arrays_;
    std::vector<std::string> dropped_;
};

MovingMesh read_grids(const fs::path& path, const SeriesOptions& options) {
    const std::vector<FrameFile> all = list_frames(path, options.time_step);
    MovingMesh mesh;
    Collector collector(mesh, options);
    for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(options.every)) {
        mesh.times.push_back(all[i].time);
        if (i == 0) {
            collector.add_first(read_frame_grid(all[i].path), all[i].path);
        } else {
            collector.add(read_frame_grid(all[i].path), all[i].path);
        }
    }
    collector.finish();
    return mesh;
}

}  // namespace

bool is_series(const fs::path& path) {
    const std::string ending = format_of(path, "");
    return ending == ".pvd" || ending == ".series" || ending == ".vtu" || ending == ".vtk"
           || fs::is_directory(path);
}

std::vector<fs::path> frame_files(const fs::path& path, const SeriesOptions& options) {
    std::vector<fs::path> files;
    if (is_series(path) && !fs::is_directory(path)) {
        for (const FrameFile& frame : list_frames(path, options.time_step)) {
            files.push_back(frame.path);
        }
    }
    return files;
}

MovingMesh read_moving_mesh(const fs::path& path, const SeriesOptions& options) {
    if (options.every < 1) {
        throw Error("one frame of every " + std::to_string(options.every) + "; expected 1 or more");
    }
    if (!is_series(path)) {
        throw Error(path.string()
                    + ": expected a list of frames (.pvd, .series), the first of numbered .vtu or"
                      " .vtk files, or a run folder of three dimensions");
    }
    MovingMesh mesh =
        fs::is_directory(path) ? read_run_frames(path, options) : read_grids(path, options);
    require_sound_base(mesh.base, path.string());
    if (mesh.frame_count() < 2) {
        throw Error(path.string()
                    + formatted(": one frame of every %d leaves one; a space-time mesh"
                                " needs two or more",
                                options.every));
    }
    return mesh;
}

}  // namespace pent::mesher
