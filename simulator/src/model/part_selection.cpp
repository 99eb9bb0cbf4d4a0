#include "model/part_selection.h"

#include "model/part_bodies.h"
#include "model/selection_marks.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>

namespace pent::simulator {

template <int Dim>
std::vector<std::uint16_t> materials_of_part(const SimplexMesh<Dim>& part,
                                             const Body& body,
                                             const Ranks& ranks) {
    const auto mark = [&](const Region& region) {
        const std::string where = place_and_name(region);
        std::vector<bool> is_in;
        agree(&ranks, [&] { is_in = mark_cells(part, region.select, where); });
        if (!any(ranks, std::find(is_in.begin(), is_in.end(), true) != is_in.end())) {
            throw Error(where + " selects no cell; " + extent_text(part.positions));
        }
        return is_in;
    };
    return materials_by_regions(static_cast<std::size_t>(part.cell_count()), body, mark);
}

// A rank has all cells of its own vertices: of these it knows which have a label, and tells the
// others.
template <int Dim>
std::vector<std::uint32_t> select_vertices(const Bodies<Dim>& bodies,
                                           std::size_t body,
                                           const std::vector<Selection>& select,
                                           const std::string& where) {
    const SimplexMesh<Dim>& mesh = bodies.meshes[body];
    if (!is_of_parts(bodies) || !selects_by_region(select)) {
        return select_vertices(mesh, select, where);
    }
    const auto vertices = bodies.vertices(body);
    const auto cells = bodies.cells_of(body);
    SimplexMesh<Dim> part;
    part.positions = mesh.positions;
    part.layers = mesh.layers;
    part.regions = mesh.regions;
    part.cells = bodies.cells.middleCols(cells.begin, cells.size).array()
                 - static_cast<std::uint32_t>(vertices.begin);
    const std::vector<bool> marks = mark_vertices(part, select, where);
    Eigen::Matrix<double, 1, Eigen::Dynamic> is_in =
        Eigen::RowVectorXd::Zero(bodies.vertex_count());
    for (std::size_t vertex = 0; vertex < marks.size(); ++vertex) {
        is_in[vertices.begin + static_cast<Eigen::Index>(vertex)] = marks[vertex] ? 1 : 0;
    }
    bodies.sharing.gather(is_in);
    std::vector<std::uint32_t> selected;
    for (Eigen::Index vertex = 0; vertex < vertices.size; ++vertex) {
        if (is_in[vertices.begin + vertex] > 0) {
            selected.push_back(static_cast<std::uint32_t>(vertex));
        }
    }
    if (selected.empty()) {
        throw Error(where + " selects no vertex: no cell has the label that it asks for; "
                    + extent_text(mesh.positions));
    }
    return selected;
}

#define PENT_INSTANTIATE(Dim)                                                                   \
    template std::vector<std::uint16_t> materials_of_part(const SimplexMesh<Dim>&, const Body&, \
                                                          const Ranks&);                        \
    template std::vector<std::uint32_t> select_vertices(                                        \
        const Bodies<Dim>&, std::size_t, const std::vector<Selection>&, const std::string&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
