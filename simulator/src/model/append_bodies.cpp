#include "model/append_bodies.h"

#include <pent/dimensions.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace pent::simulator {

SortedByMaterial sort_by_material(const std::vector<std::uint16_t>& materials, std::size_t count) {
    SortedByMaterial sorted;
    sorted.order.resize(materials.size());
    std::iota(sorted.order.begin(), sorted.order.end(), Eigen::Index{0});
    const auto of = [&](Eigen::Index i) { return materials[static_cast<std::size_t>(i)]; };
    std::stable_sort(sorted.order.begin(), sorted.order.end(),
                     [&](Eigen::Index a, Eigen::Index b) { return of(a) < of(b); });
    for (std::size_t material = 0; material <= count; ++material) {
        const auto at = std::partition_point(sorted.order.begin(), sorted.order.end(),
                                             [&](Eigen::Index i) { return of(i) < material; });
        sorted.first.push_back(at - sorted.order.begin());
    }
    return sorted;
}

void append_ranges(const Body& body,
                   std::size_t place,
                   const std::vector<Eigen::Index>& first,
                   Eigen::Index begin,
                   std::vector<CellRange>& ranges) {
    for (std::size_t region = 0; region + 1 < first.size(); ++region) {
        ranges.push_back({.begin = begin + first[region],
                          .end = begin + first[region + 1],
                          .material = material_of(body, static_cast<std::uint16_t>(region)),
                          .body = place,
                          .region = region});
    }
}

namespace {

// Appends the quadratic cells of a body by their materials; returns those of its cells, since a
// quadratic cell is of one material.
template <int Dim>
std::vector<std::uint16_t> append_quadratic(const Body& body,
                                            std::size_t place,
                                            Bodies<Dim>& bodies) {
    const SimplexMesh<Dim>& mesh = bodies.meshes[place];
    const std::string name = (body.source.empty() ? "" : body.source + ": ") + body.mesh;
    const std::vector<Eigen::Index> children = child_cells<Dim>(mesh, name);
    const QuadraticSimplices<Dim> own = quadratic_simplices<Dim>(mesh, children, name);
    const std::size_t per_simplex = children.size() / static_cast<std::size_t>(own.cols());
    SimplexMesh<Dim> straight;
    straight.positions = mesh.positions;
    straight.layers = mesh.layers;
    straight.cells = own.template topRows<Dim + 1>();
    for (std::size_t i = 0; i < children.size() && !mesh.regions.empty(); i += per_simplex) {
        straight.regions.push_back(mesh.regions[static_cast<std::size_t>(children[i])]);
    }
    const std::vector<std::uint16_t> materials = materials_of_cells(straight, body);
    const SortedByMaterial sorted = sort_by_material(materials, body.regions.size() + 1);
    QuadraticCells<Dim>& all = bodies.quadratic;
    const Eigen::Index begin = all.nodes.cols();
    append_ranges(body, place, sorted.first, begin, all.ranges);
    all.nodes.conservativeResize(Eigen::NoChange, begin + own.cols());
    for (Eigen::Index i = 0; i < own.cols(); ++i) {
        const Eigen::Index simplex = sorted.order[static_cast<std::size_t>(i)];
        all.nodes.col(begin + i) =
            own.col(simplex).array() + static_cast<std::uint32_t>(bodies.first_vertex[place]);
        all.first_child.push_back(
            static_cast<std::uint32_t>(children[static_cast<std::size_t>(simplex) * per_simplex]));
    }
    std::vector<std::uint16_t> of_cells(children.size());
    for (std::size_t i = 0; i < children.size(); ++i) {
        of_cells[static_cast<std::size_t>(children[i])] = materials[i / per_simplex];
    }
    return of_cells;
}

}  // namespace

template <int Dim>
void append_bodies(const Scene& scene, Bodies<Dim>& bodies) {
    bodies.first_vertex.push_back(0);
    bodies.first_cell.push_back(0);
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        SimplexMesh<Dim>& mesh = bodies.meshes[body];
        mesh = place(std::move(mesh), scene.bodies[body]);
        bodies.first_vertex.push_back(bodies.first_vertex.back() + mesh.vertex_count());
        bodies.first_cell.push_back(bodies.first_cell.back() + mesh.cell_count());
    }
    bodies.rest.resize(Dim, bodies.first_vertex.back());
    bodies.cell_count = bodies.first_cell.back();
    bodies.cells.resize(Dim + 1, bodies.cell_count);
    const bool has_regions = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                         [](const Body& body) { return !body.regions.empty(); });
    for (std::size_t place = 0; place < scene.bodies.size(); ++place) {
        const Body& body = scene.bodies[place];
        const SimplexMesh<Dim>& mesh = bodies.meshes[place];
        const auto first = static_cast<std::uint32_t>(bodies.first_vertex[place]);
        bodies.rest.middleCols(first, mesh.vertex_count()) = mesh.positions;
        const bool is_quadratic = scene.solver.elements == ElementKind::Quadratic;
        const SortedByMaterial sorted = sort_by_material(
            is_quadratic ? append_quadratic(body, place, bodies) : materials_of_cells(mesh, body),
            body.regions.size() + 1);
        const auto range = bodies.cells_of(place);
        append_ranges(body, place, sorted.first, range.begin, bodies.ranges);
        for (Eigen::Index cell = 0; cell < range.size; ++cell) {
            const Eigen::Index own = sorted.order[static_cast<std::size_t>(cell)];
            bodies.cells.col(range.begin + cell) = mesh.cells.col(own).array() + first;
            if (has_regions) {
                bodies.mesh_cells.push_back(static_cast<std::uint32_t>(own));
            }
        }
    }
}

#define PENT_INSTANTIATE(Dim) template void append_bodies(const Scene&, Bodies<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
