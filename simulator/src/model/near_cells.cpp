#include "model/near_cells.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <utility>

namespace pent::simulator {

bool do_terms_need_all_cells(const Scene& scene) {
    return scene.solver.elements != ElementKind::Linear || !scene.activations.empty()
           || !scene.attachments.empty();
}

bool do_terms_couple_anything(const Scene& scene) {
    return scene.contact.has_value() || !scene.attachments.empty();
}

template <int Dim>
void keep_near_cells(Bodies<Dim>& bodies) {
    const auto is_near = [&](Eigen::Index cell) {
        const auto corners = bodies.cells.col(cell);
        return std::any_of(corners.begin(), corners.end(),
                           [&](std::uint32_t vertex) { return bodies.sharing.owns(vertex); });
    };
    std::vector<std::uint32_t> mesh_cells;
    std::vector<Eigen::Index> first_cell(bodies.first_cell.size(), 0);
    Eigen::Index next = 0;
    for (CellRange& range : bodies.ranges) {
        const Eigen::Index begin = next;
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
            if (is_near(cell)) {
                mesh_cells.push_back(bodies.mesh_cell(range.body, cell));
                bodies.cells.col(next++) = bodies.cells.col(cell);
            }
        }
        range.begin = begin;
        range.end = next;
        first_cell[range.body + 1] = next;
    }
    bodies.cells.conservativeResize(Eigen::NoChange, next);
    mesh_cells.shrink_to_fit();
    bodies.mesh_cells = std::move(mesh_cells);
    bodies.first_cell = std::move(first_cell);
}

#define PENT_INSTANTIATE(Dim) template void keep_near_cells(Bodies<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
