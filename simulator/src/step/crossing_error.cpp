#include "step/crossing_error.h"

#include "model/part_bodies.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <string>

namespace pent::simulator {

namespace {

template <int Dim>
using Cell = Eigen::Matrix<std::uint32_t, Dim + 1, 1>;

// Whether a cell has all corners of a simplex.
template <int Dim>
bool has_corners(const Cell<Dim>& cell, const std::vector<std::uint32_t>& corners) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](std::uint32_t corner) { return (cell.array() == corner).any(); });
}

// The cells that have one of the simplices, with their own vertices alone.
template <int Dim>
SimplexMesh<Dim> cells_of(const Bodies<Dim>& bodies,
                          const std::vector<std::vector<std::uint32_t>>& simplices,
                          const Positions<Dim>& positions) {
    constexpr std::uint32_t kNone = 0xffffffff;
    std::vector<std::vector<std::uint32_t>> at_vertex(
        static_cast<std::size_t>(bodies.vertex_count()));
    for (std::uint32_t s = 0; s < simplices.size(); ++s) {
        at_vertex[simplices[s].front()].push_back(s);
    }
    const auto [cells, of_bodies] = list_cells<Dim>(bodies, [&](const Cell<Dim>& cell) {
        return std::any_of(cell.begin(), cell.end(), [&](std::uint32_t corner) {
            return std::any_of(
                at_vertex[corner].begin(), at_vertex[corner].end(),
                [&](std::uint32_t s) { return has_corners<Dim>(cell, simplices[s]); });
        });
    });
    SimplexMesh<Dim> mesh;
    mesh.regions.assign(of_bodies.begin(), of_bodies.end());
    std::vector<std::uint32_t> numbers(static_cast<std::size_t>(bodies.vertex_count()), kNone);
    std::vector<std::uint32_t> vertices;
    mesh.cells.resize(Dim + 1, static_cast<Eigen::Index>(cells.size()));
    for (std::size_t k = 0; k < cells.size(); ++k) {
        for (int corner = 0; corner <= Dim; ++corner) {
            const std::uint32_t vertex = cells[k][corner];
            if (numbers[vertex] == kNone) {
                numbers[vertex] = static_cast<std::uint32_t>(vertices.size());
                vertices.push_back(vertex);
            }
            mesh.cells(corner, static_cast<Eigen::Index>(k)) = numbers[vertex];
        }
    }
    mesh.positions.resize(Dim, static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        mesh.positions.col(static_cast<Eigen::Index>(v)) = positions.col(vertices[v]);
    }
    return mesh;
}

}  // namespace

template <int Dim>
CrossingError<Dim> crossing_error(const Bodies<Dim>& bodies,
                                  const ContactPotential<Dim>& contacts,
                                  const std::vector<contact::Crossing>& crossings,
                                  const Positions<Dim>& positions) {
    constexpr std::size_t kNamed = 3;
    std::string message = "contact: the barrier needs a start at which nothing touches: ";
    std::vector<std::vector<std::uint32_t>> simplices;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
        if (i < kNamed) {
            message += (i == 0 ? "" : ", ") + contacts.describe(crossings[i]);
        }
        for (const auto& corners : {crossings[i].first_corners, crossings[i].second_corners}) {
            if (!corners.empty()) {
                simplices.push_back(corners);
            }
        }
    }
    if (crossings.size() > kNamed) {
        message += ", and " + std::to_string(crossings.size() - kNamed) + " more";
    }
    return {message, cells_of(bodies, simplices, positions)};
}

#define PENT_INSTANTIATE(Dim)                                                                    \
    template CrossingError<Dim> crossing_error<Dim>(                                             \
        const Bodies<Dim>&, const ContactPotential<Dim>&, const std::vector<contact::Crossing>&, \
        const Positions<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
