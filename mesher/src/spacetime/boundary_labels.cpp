#include "boundary_labels.h"

#include <pent/facets.h>

namespace pent::mesher {

namespace {

// The triangle of the base that a lateral facet stands on: of its four columns two are one.
Triangle triangle_below(const SimplexMesh<4>& mesh, const Eigen::Vector4<std::uint32_t>& facet) {
    std::array<std::uint32_t, 4> columns{};
    for (int k = 0; k < 4; ++k) {
        columns[k] = mesh.columns[facet[k]];
    }
    std::sort(columns.begin(), columns.end());
    Triangle triangle{};
    std::unique_copy(columns.begin(), columns.end(), triangle.begin());
    return triangle;
}

}  // namespace

void label_boundary(const SimplexMesh<4>& mesh,
                    const TriangleLabels& triangles,
                    const EndLabels& ends,
                    MeshExtras<4>& extras) {
    FacetMatch<4> match = match_facets<4>(mesh.cells, mesh.vertex_count());
    const std::uint32_t first = *std::min_element(mesh.layers.begin(), mesh.layers.end());
    for (Eigen::Index f = 0; f < match.boundary.cols(); ++f) {
        const Eigen::Vector4<std::uint32_t> facet = match.boundary.col(f);
        const std::uint32_t layer = mesh.layers[facet[0]];
        const bool is_end = std::all_of(facet.begin(), facet.end(),
                                        [&](std::uint32_t v) { return mesh.layers[v] == layer; });
        BoundaryLabel label = BoundaryLabel::Lateral;
        std::uint16_t base = 0;
        if (is_end) {
            label = layer == first ? ends.first : ends.last;
            base = mesh.regions.empty()
                       ? std::uint16_t{0}
                       : mesh.regions[match.boundary_cells[static_cast<std::size_t>(f)]];
        } else {
            base = triangles.of(triangle_below(mesh, facet));
        }
        extras.labels.push_back(static_cast<std::uint16_t>(label));
        extras.base_labels.push_back(base);
    }
    extras.boundary = std::move(match.boundary);
}

TriangleLabels labels_of(const MovingMesh& moving) {
    TriangleLabels labels;
    for (Eigen::Index t = 0; t < moving.triangles.cols(); ++t) {
        labels.add({moving.triangles(0, t), moving.triangles(1, t), moving.triangles(2, t)},
                   moving.triangle_labels[static_cast<std::size_t>(t)]);
    }
    labels.sort();
    return labels;
}

TriangleLabels labels_of(const SpaceTimeBody& body) {
    TriangleLabels labels;
    for (Eigen::Index f = 0; f < body.extras.boundary.cols(); ++f) {
        const auto i = static_cast<std::size_t>(f);
        if (body.extras.labels[i] == static_cast<std::uint16_t>(BoundaryLabel::Lateral)) {
            labels.add(triangle_below(body.mesh, body.extras.boundary.col(f)),
                       body.extras.base_labels[i]);
        }
    }
    labels.sort();
    return labels;
}

}  // namespace pent::mesher
