#include "boundary_labels.h"

#include <pent/mesher/space_time.h>

#include <utility>
#include <vector>

namespace pent::mesher {

namespace {

constexpr Eigen::Index kPerPrism = 4;

// What some vertices and cells of a body have, for a file of their own.
void hand_down(const SpaceTimeBody& body,
               const std::vector<Eigen::Index>& vertices,
               const std::vector<Eigen::Index>& cells,
               MeshFile<4>& file) {
    for (const Eigen::Index cell : cells) {
        if (!body.mesh.regions.empty()) {
            file.mesh.regions.push_back(body.mesh.regions[cell]);
        }
        if (!body.extras.bisection_tags.empty()) {
            file.extras.bisection_tags.push_back(body.extras.bisection_tags[cell]);
        }
    }
    if (body.mesh.fibers.cols() > 0) {
        file.mesh.fibers = body.mesh.fibers(Eigen::all, cells);
    }
    for (const VertexField& field : body.extras.vertex_fields) {
        file.extras.vertex_fields.push_back({field.name, field.values(Eigen::all, vertices)});
    }
    for (const VertexField& field : body.extras.cell_fields) {
        file.extras.cell_fields.push_back({field.name, field.values(Eigen::all, cells)});
    }
}

}  // namespace

MeshFile<4> slab_of(const SpaceTimeBody& body, std::size_t slab) {
    const std::uint32_t from = body.frame_layers[slab];
    const std::uint32_t to = body.frame_layers[slab + 1];
    const SimplexMesh<4>& whole = body.mesh;
    const std::uint32_t all = body.frame_layers.back() + 1;  // layers in a column
    const std::uint32_t own = to - from + 1;
    MeshFile<4> file;
    std::vector<Eigen::Index> vertices;
    for (Eigen::Index v = 0; v < whole.vertex_count(); ++v) {
        if (whole.layers[v] >= from && whole.layers[v] <= to) {
            vertices.push_back(v);
            file.mesh.columns.push_back(whole.columns[v]);
            file.mesh.layers.push_back(whole.layers[v]);
        }
    }
    const auto new_name = [&](std::uint32_t v) { return v / all * own + (v % all - from); };
    std::vector<Eigen::Index> cells;
    for (Eigen::Index cell = 0; cell < whole.cell_count(); ++cell) {
        const Eigen::Index layer = cell / kPerPrism % (all - 1);
        if (layer >= from && layer < to) {
            cells.push_back(cell);
        }
    }
    file.mesh.positions = whole.positions(Eigen::all, vertices);
    file.mesh.cells = whole.cells(Eigen::all, cells).unaryExpr(new_name);
    hand_down(body, vertices, cells, file);
    label_boundary(file.mesh, labels_of(body),
                   {from == 0 ? BoundaryLabel::Bottom : BoundaryLabel::InterfaceBelow,
                    to + 1 == all ? BoundaryLabel::Top : BoundaryLabel::InterfaceAbove},
                   file.extras);
    return file;
}

}  // namespace pent::mesher
