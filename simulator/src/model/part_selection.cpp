#include "model/part_selection.h"

#include "model/gather_in_order.h"
#include "model/part_bodies.h"
#include "model/selection_marks.h"

#include <pent/dimensions.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <array>

namespace pent::simulator {

namespace {

// The nearest miss of all ranks.
template <int Dim>
NearMiss<Dim> nearest_of_all(const Ranks* ranks, const NearMiss<Dim>& own) {
    if (ranks == nullptr) {
        return own;
    }
    std::array<double, Dim + 4> row = {own.distance, own.number, own.least_label, own.most_label};
    std::copy(own.point.begin(), own.point.end(), row.begin() + 4);
    const auto rows = gather_in_order<Dim + 4>(*ranks, {row});
    NearMiss<Dim> miss;
    miss.distance = rows[0][0];
    miss.number = rows[0][1];
    std::copy(rows[0].begin() + 4, rows[0].end(), miss.point.begin());
    for (const auto& of_rank : rows) {
        miss.least_label = std::min(miss.least_label, of_rank[2]);
        miss.most_label = std::max(miss.most_label, of_rank[3]);
    }
    return miss;
}

}  // namespace

template <int Dim>
std::vector<bool> select_cells(const SimplexMesh<Dim>& part,
                               const std::vector<std::uint32_t>& numbers,
                               const std::vector<Selection>& select,
                               const std::string& where,
                               const Ranks* ranks) {
    std::vector<bool> is_in;
    agree(ranks, [&] { is_in = mark_cells(part, select, where); });
    const bool has_any = std::find(is_in.begin(), is_in.end(), true) != is_in.end();
    if (!(ranks == nullptr ? has_any : any(*ranks, has_any))) {
        const NearMiss<Dim> own = near_miss(part, centers(part), numbers, select.front());
        refuse_none(part, "cell", nearest_of_all(ranks, own), select, where);
    }
    return is_in;
}

template <int Dim>
std::vector<std::uint16_t> materials_of_part(const SimplexMesh<Dim>& part,
                                             const std::vector<std::uint32_t>& numbers,
                                             const Body& body,
                                             const Ranks* ranks) {
    return materials_by_regions(
        static_cast<std::size_t>(part.cell_count()), body, [&](const Region& region) {
            return select_cells(part, numbers, region.select, place_and_name(region), ranks);
        });
}

// A rank has all cells of its own vertices. So it knows which of these a label selects, and tells
// the others.
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
    part.cells = bodies.cells().middleCols(cells.begin, cells.size).array()
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
        const NearMiss<Dim> own = near_miss(part, part.positions, {}, select.front());
        refuse_none(part, "vertex", nearest_of_all(&bodies.sharing.ranks(), own), select, where);
    }
    return selected;
}

#define PENT_INSTANTIATE(Dim)                                                                      \
    template std::vector<bool> select_cells(                                                       \
        const SimplexMesh<Dim>&, const std::vector<std::uint32_t>&, const std::vector<Selection>&, \
        const std::string&, const Ranks*);                                                         \
    template std::vector<std::uint16_t> materials_of_part(                                         \
        const SimplexMesh<Dim>&, const std::vector<std::uint32_t>&, const Body&, const Ranks*);    \
    template std::vector<std::uint32_t> select_vertices(                                           \
        const Bodies<Dim>&, std::size_t, const std::vector<Selection>&, const std::string&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
