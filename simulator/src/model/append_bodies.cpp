#include "model/append_bodies.h"

#include "model/part_selection.h"

#include <pent/dimensions.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace pent::simulator {

namespace {

// The order of the cells or elements of a body by their materials.
struct SortedByMaterial {
    std::vector<Eigen::Index> order;  // within a material as they were
    std::vector<Eigen::Index> first;  // materials + 1 entries
};

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

// Appends a range for each material of a body, whose cells or elements follow `begin` ones of
// others.
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

// Appends the quadratic cells of a body by their materials; returns where each is now.
template <int Dim>
std::vector<std::uint32_t> append_quadratic(const Body& body,
                                            std::size_t place,
                                            const MadeQuadratic<Dim>& own,
                                            const std::vector<std::uint16_t>& materials,
                                            Bodies<Dim>& bodies) {
    const SortedByMaterial sorted = sort_by_material(materials, body.regions.size() + 1);
    QuadraticCells<Dim>& all = bodies.quadratic;
    const Eigen::Index begin = all.nodes.cols();
    append_ranges(body, place, sorted.first, begin, all.ranges);
    all.nodes.conservativeResize(Eigen::NoChange, begin + own.nodes.cols());
    std::vector<std::uint32_t> places(sorted.order.size());
    for (Eigen::Index i = 0; i < own.nodes.cols(); ++i) {
        const Eigen::Index simplex = sorted.order[static_cast<std::size_t>(i)];
        all.nodes.col(begin + i) =
            own.nodes.col(simplex).array() + static_cast<std::uint32_t>(bodies.first_vertex[place]);
        places[static_cast<std::size_t>(simplex)] = static_cast<std::uint32_t>(begin + i);
    }
    return places;
}

}  // namespace

template <int Dim>
MadeQuadratic<Dim> make_quadratic(const SimplexMesh<Dim>& mesh,
                                  const Body& body,
                                  const CellsOfRank& whole) {
    const std::string name = (body.source.empty() ? "" : body.source + ": ") + body.mesh;
    const std::vector<Eigen::Index> children = child_cells<Dim>(mesh, name, whole);
    MadeQuadratic<Dim> made;
    made.nodes = quadratic_simplices<Dim>(mesh, children, name, whole);
    made.straight.positions = mesh.positions;
    made.straight.layers = mesh.layers;
    made.straight.cells = made.nodes.template topRows<Dim + 1>();
    made.parents.resize(children.size());
    constexpr std::size_t kChildren = std::size_t{1} << Dim;
    for (std::size_t i = 0; i < children.size(); ++i) {
        const auto child = static_cast<std::size_t>(children[i]);
        made.parents[child] = static_cast<std::uint32_t>(i / kChildren);
        if (i % kChildren == 0) {
            made.numbers.push_back(whole.number(children[i]));
            if (!mesh.regions.empty()) {
                made.straight.regions.push_back(mesh.regions[child]);
            }
        }
    }
    return made;
}

template <int Dim>
std::vector<Eigen::Index> append_cells(const Body& body,
                                       std::size_t place,
                                       const SimplexMesh<Dim>& mesh,
                                       const MadeQuadratic<Dim>* quadratic,
                                       const std::vector<std::uint16_t>& materials,
                                       Bodies<Dim>& bodies) {
    const auto first = static_cast<std::uint32_t>(bodies.first_vertex[place]);
    std::vector<std::uint16_t> of_cells;
    std::vector<std::uint32_t> places;
    if (quadratic != nullptr) {  // a quadratic cell is of one material
        places = append_quadratic(body, place, *quadratic, materials, bodies);
        for (const std::uint32_t parent : quadratic->parents) {
            of_cells.push_back(materials[parent]);
        }
    }
    SortedByMaterial sorted =
        sort_by_material(quadratic != nullptr ? of_cells : materials, body.regions.size() + 1);
    const Eigen::Index begin = bodies.first_cell[place];
    append_ranges(body, place, sorted.first, begin, bodies.ranges);
    for (std::size_t i = 0; i < sorted.order.size(); ++i) {
        const Eigen::Index own = sorted.order[i];
        if (bodies.joined_cells) {
            bodies.joined_cells->col(begin + static_cast<Eigen::Index>(i)) =
                mesh.cells.col(own).array() + first;
        }
        if (quadratic != nullptr) {
            bodies.quadratic.parents.push_back(
                places[quadratic->parents[static_cast<std::size_t>(own)]]);
        }
    }
    return std::move(sorted.order);
}

template <int Dim>
void join_rest(Bodies<Dim>& bodies) {
    if (bodies.count() == 1) {
        return;
    }
    Positions<Dim>& rest = bodies.joined_rest.emplace(Dim, bodies.vertex_count());
    for (std::size_t body = 0; body < bodies.count(); ++body) {
        const auto range = bodies.vertices(body);
        rest.middleCols(range.begin, range.size) = bodies.meshes[body].positions;
    }
}

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
    join_rest(bodies);
    bodies.cell_count = bodies.first_cell.back();
    const bool has_regions = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                         [](const Body& body) { return !body.regions.empty(); });
    if (has_regions || scene.bodies.size() != 1) {
        bodies.joined_cells.emplace(Dim + 1, bodies.cell_count);
    }
    for (std::size_t place = 0; place < scene.bodies.size(); ++place) {
        const Body& body = scene.bodies[place];
        const SimplexMesh<Dim>& mesh = bodies.meshes[place];
        std::optional<MadeQuadratic<Dim>> quadratic;
        if (scene.solver.elements == ElementKind::Quadratic) {
            quadratic = make_quadratic(mesh, body);
        }
        const std::vector<std::uint16_t> materials =
            quadratic ? materials_of_part(quadratic->straight, quadratic->numbers, body, nullptr)
                      : materials_of_cells(mesh, body);
        for (const Eigen::Index cell : append_cells(
                 body, place, mesh, quadratic ? &*quadratic : nullptr, materials, bodies)) {
            if (has_regions) {
                bodies.mesh_cells.push_back(static_cast<std::uint32_t>(cell));
            }
        }
    }
}

#define PENT_INSTANTIATE(Dim)                                                         \
    template MadeQuadratic<Dim> make_quadratic(const SimplexMesh<Dim>&, const Body&,  \
                                               const CellsOfRank&);                   \
    template std::vector<Eigen::Index> append_cells(                                  \
        const Body&, std::size_t, const SimplexMesh<Dim>&, const MadeQuadratic<Dim>*, \
        const std::vector<std::uint16_t>&, Bodies<Dim>&);                             \
    template void join_rest(Bodies<Dim>&);                                            \
    template void append_bodies(const Scene&, Bodies<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
