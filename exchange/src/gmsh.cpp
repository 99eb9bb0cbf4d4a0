#include "formats.h"
#include "text_lines.h"

#include <pent/output_file.h>

#include <string>

namespace pent::exchange {

void write_gmsh(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options) {
    const auto& surface = std::get<TetSurface>(content);
    const std::string points = std::to_string(surface.points.cols());
    // Version 2.2: what all that read Gmsh's files know.
    std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\n" + options.created_by
                       + ": the boundary of a body of four dimensions, w as a view\n$EndComments\n"
                         "$Nodes\n"
                       + points + '\n';
    for (Eigen::Index p = 0; p < surface.points.cols(); ++p) {
        text += std::to_string(p + 1);
        append_numbers(text, surface.points.col(p).head<3>());
        text += '\n';
    }
    text += "$EndNodes\n$Elements\n" + std::to_string(surface.tetrahedra.cols()) + '\n';
    for (Eigen::Index t = 0; t < surface.tetrahedra.cols(); ++t) {
        text += std::to_string(t + 1) + " 4 2 1 1";  // a tetrahedron with two tags
        append_corners(text, surface.tetrahedra.col(t), 1);
        text += '\n';
    }
    // One name, at the time 0; step 0, one component, so many values.
    text += "$EndElements\n$NodeData\n1\n\"w\"\n1\n0\n3\n0\n1\n" + points + '\n';
    for (Eigen::Index p = 0; p < surface.points.cols(); ++p) {
        text += std::to_string(p + 1);
        append_numbers(text, surface.points.col(p).tail<1>());
        text += '\n';
    }
    text += "$EndNodeData\n";
    write_text(path, text);
}

}  // namespace pent::exchange
