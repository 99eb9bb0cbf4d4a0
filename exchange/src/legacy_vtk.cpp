#include "formats.h"
#include "text_lines.h"

#include <pent/output_file.h>

#include <string>

namespace pent::exchange {

void write_legacy_vtk(const std::filesystem::path& path,
                      const Content& content,
                      const WriteOptions& options) {
    constexpr const char* kTetrahedron = "10\n";
    const auto& surface = std::get<TetSurface>(content);
    const std::string points = std::to_string(surface.points.cols());
    const std::string cells = std::to_string(surface.tetrahedra.cols());
    std::string text = "# vtk DataFile Version 3.0\n" + options.created_by
                       + ": the boundary of a body of four dimensions, w as a scalar\nASCII\n"
                         "DATASET UNSTRUCTURED_GRID\nPOINTS "
                       + points + " double\n";
    for (const auto& point : surface.points.colwise()) {
        append_numbers(text, point.head<3>());
        text += '\n';
    }
    text += "CELLS " + cells + ' ' + std::to_string(5 * surface.tetrahedra.cols()) + '\n';
    for (const auto& tetrahedron : surface.tetrahedra.colwise()) {
        text += '4';
        append_corners(text, tetrahedron);
        text += '\n';
    }
    text += "CELL_TYPES " + cells + '\n';
    for (Eigen::Index t = 0; t < surface.tetrahedra.cols(); ++t) {
        text += kTetrahedron;
    }
    text += "POINT_DATA " + points + "\nSCALARS w double 1\nLOOKUP_TABLE default\n";
    for (const auto& point : surface.points.colwise()) {
        append_numbers(text, point.tail<1>());
        text += '\n';
    }
    write_text(path, text);
}

}  // namespace pent::exchange
