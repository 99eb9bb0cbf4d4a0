#pragma once

#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pent::mesher {

/// A quantity of the vertices or cells of a moving mesh, at every frame.
struct MovingField {
    std::string name;                     ///< Letters, digits and '_'.
    std::vector<Eigen::MatrixXd> values;  ///< One or three numbers a column; a matrix a frame.
};

/// Tetrahedra that keep their connectivity while their vertices move.
struct MovingMesh {
    SimplexMesh<3> base;                  ///< At the first frame; regions if the files have labels.
    std::vector<double> times;            ///< s, increasing.
    std::vector<Positions<3>> positions;  ///< One for each time, m.
    std::vector<std::string> frames;      ///< What messages call each: a file name.
    std::vector<std::uint32_t> cell_numbers;  ///< What messages call each tetrahedron: the number
                                              ///< of its cell in the files, from 0.
    Simplices<3> triangles;                   ///< Of the surface, where the files label them.
    std::vector<std::uint16_t> triangle_labels;
    std::vector<MovingField> vertex_fields;
    std::vector<MovingField> cell_fields;
    std::string cut;                ///< Other cells and what they became, see TetrahedraFile.
    std::int64_t curved_cells = 0;  ///< Of the files, see TetrahedraFile.
    std::string
        left_out;  ///< Of the files: cells of fewer dimensions, arrays that are not carried.

    [[nodiscard]] std::size_t frame_count() const { return times.size(); }
};

struct SeriesOptions {
    std::optional<double> time_step = {};  ///< s, between numbered files, which do not say it.
    std::string body = {};                 ///< Of a run folder; may be empty if it has one.
    std::string region_array =
        {};            ///< Array of cells with their labels; empty: one with labels and a
                       ///< usual name, as "region" or "material".
    int every = 1;     ///< Only each so-many-th frame, from the first on.
    double scale = 1;  ///< Coordinates in the files times this are m.
};

/// Whether a path may be that of a moving mesh: a list of frames, a numbered file or a folder.
[[nodiscard]] bool is_series(const std::filesystem::path& path);

/// The files that a list of frames or the name of a numbered file stands for, in order; none for a
/// run folder. Throws an Error as read_moving_mesh() does for the list.
[[nodiscard]] std::vector<std::filesystem::path> frame_files(const std::filesystem::path& path,
                                                             const SeriesOptions& options);

/// Reads a moving mesh: a .pvd or .series file that lists .vtu or legacy .vtk files with their
/// times, the first of numbered .vtu or .vtk files, or a 3D run folder of pent-sim.
///
/// Pyramids, prisms and hexahedra are cut as read_tetrahedra() does, all frames alike.
/// Throws an Error in one line, with file and place: for what is damaged, fewer than two frames,
/// times that do not increase, another connectivity or other labels than the first frame's (with
/// the first cell that differs), points that are not finite.
[[nodiscard]] MovingMesh read_moving_mesh(const std::filesystem::path& path,
                                          const SeriesOptions& options = {});

}  // namespace pent::mesher
