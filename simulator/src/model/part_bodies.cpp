#include "model/part_bodies.h"

#include "model/append_bodies.h"
#include "model/gather_in_order.h"
#include "model/near_cells.h"
#include "model/part_selection.h"
#include "model/partition.h"
#include "model/selection_marks.h"

#include <pent/crc32c.h>
#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/facets.h>
#include <pent/simulator/mesh_parts.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace pent::simulator {

namespace {

// Places the parts and shares their vertices out. The meshes have their cells still.
template <int Dim>
void place_parts(const Scene& scene,
                 std::vector<MeshPart<Dim>>& parts,
                 const std::shared_ptr<const Ranks>& ranks,
                 Bodies<Dim>& bodies) {
    Eigen::Index cells = 0;
    bodies.first_vertex = {0};
    bodies.first_cell = {0};
    for (std::size_t i = 0; i < parts.size(); ++i) {
        agree(ranks.get(), [&] { parts[i] = place(std::move(parts[i]), scene.bodies[i]); });
        cells += parts[i].mesh.cell_count();
        bodies.cell_count += parts[i].cell_count;
        bodies.first_vertex.push_back(bodies.first_vertex.back() + parts[i].mesh.vertex_count());
        bodies.first_cell.push_back(cells);
        bodies.meshes.push_back(std::move(parts[i].mesh));
    }
    join_rest(bodies);
    bodies.joined_cells.emplace(Dim + 1, cells);
    bodies.mesh_cells.reserve(static_cast<std::size_t>(cells));
    refuse_others(ranks.get(),
                  crc32c(bodies.rest().data(),
                         static_cast<std::size_t>(bodies.rest().size()) * sizeof(double)),
                  "other meshes", "let all of them read the same files");
    bodies.sharing = Sharing(
        ranks,
        partition_columns<Dim>(bodies.rest(), number_columns(bodies.meshes), ranks->count()));
}

// Appends the cells of a body. Of its mesh only labels and fibers are kept, in the order of these
// cells.
template <int Dim>
void append_part(const Body& body,
                 std::size_t place,
                 const std::vector<std::uint32_t>& numbers,
                 const MadeQuadratic<Dim>* quadratic,
                 const std::vector<std::uint16_t>& materials,
                 Bodies<Dim>& bodies) {
    SimplexMesh<Dim>& mesh = bodies.meshes[place];
    const std::vector<Eigen::Index> order =
        append_cells(body, place, mesh, quadratic, materials, bodies);
    std::vector<std::uint16_t> labels;
    for (const Eigen::Index cell : order) {
        bodies.mesh_cells.push_back(numbers[static_cast<std::size_t>(cell)]);
        if (!mesh.regions.empty()) {
            labels.push_back(mesh.regions[static_cast<std::size_t>(cell)]);
        }
    }
    if (mesh.fibers.cols() > 0) {
        mesh.fibers = mesh.fibers(Eigen::all, order).eval();
    }
    mesh.cells.resize(Eigen::NoChange, 0);
    mesh.parents.clear();
    mesh.regions = std::move(labels);
}

}  // namespace

bool are_labels_asked_for(const Scene& scene, const Body& body) {
    const auto selects = [&](const auto& list) {
        return std::any_of(list.begin(), list.end(), [&](const auto& part) {
            return part.body == body.name && selects_by_region(part.select);
        });
    };
    return selects(scene.constraints) || selects(scene.loads) || selects(scene.attachments)
           || selects(scene.activations)
           || std::any_of(body.regions.begin(), body.regions.end(),
                          [](const Region& region) { return selects_by_region(region.select); });
}

bool are_fibers_asked_for(const Scene& scene, const Body& body) {
    return std::any_of(scene.activations.begin(), scene.activations.end(),
                       [&](const Activation& activation) {
                           return activation.body == body.name && activation.fibers == Fibers::Mesh;
                       });
}

template <int Dim>
std::vector<std::uint32_t> share_vertices(const Scene& scene,
                                          const std::vector<SimplexMesh<Dim>>& meshes,
                                          int ranks) {
    Eigen::Index count = 0;
    for (const SimplexMesh<Dim>& mesh : meshes) {
        count += mesh.vertex_count();
    }
    Positions<Dim> rest(Dim, count);
    count = 0;
    for (std::size_t body = 0; body < meshes.size(); ++body) {
        SimplexMesh<Dim> placed;
        placed.positions = meshes[body].positions;
        put_in_place(placed, scene.bodies[body].place);
        rest.middleCols(count, placed.vertex_count()) = placed.positions;
        count += placed.vertex_count();
    }
    return partition_columns<Dim>(rest, number_columns(meshes), ranks);
}

template <int Dim>
Bodies<Dim> make_part_bodies(const Scene& scene,
                             std::vector<MeshPart<Dim>> parts,
                             const std::shared_ptr<const Ranks>& ranks) {
    check_meshes<Dim>(scene, parts.size());
    if (ranks == nullptr) {
        throw Error("parts of meshes were given without ranks that have the others");
    }
    Bodies<Dim> bodies;
    place_parts(scene, parts, ranks, bodies);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Body& body = scene.bodies[i];
        const SimplexMesh<Dim>& mesh = bodies.meshes[i];
        const auto first = static_cast<std::uint32_t>(bodies.first_vertex[i]);
        std::optional<MadeQuadratic<Dim>> quadratic;
        if (scene.solver.elements == ElementKind::Quadratic) {
            quadratic = make_quadratic<Dim>(
                mesh, body,
                {.ranks = ranks.get(),
                 .count = parts[i].cell_count,
                 .numbers = parts[i].numbers,
                 .owns = [&](std::uint32_t v) { return bodies.sharing.owns(first + v); }});
        }
        const std::vector<std::uint16_t> materials =
            quadratic
                ? materials_of_part(quadratic->straight, quadratic->numbers, body, ranks.get())
                : materials_of_part(mesh, parts[i].numbers, body, ranks.get());
        agree(ranks.get(), [&] {
            append_part(body, i, parts[i].numbers, quadratic ? &*quadratic : nullptr, materials,
                        bodies);
            parts[i] = MeshPart<Dim>();
        });
    }
    bodies.may_couple_anything = do_terms_couple_anything(scene);
    lump_masses(scene, bodies);
    return bodies;
}

// Each facet is found by one rank: that which owns its lowest corner, and so has all cells of the
// facet.
template <int Dim>
Simplices<Dim> boundary_of(const Bodies<Dim>& bodies, std::size_t body) {
    if (!is_of_parts(bodies)) {
        const SimplexMesh<Dim>& mesh = bodies.meshes[body];
        return match_facets<Dim>(mesh.cells, mesh.vertex_count()).boundary;
    }
    const auto range = bodies.cells_of(body);
    const auto first = static_cast<std::uint32_t>(bodies.first_vertex[body]);
    const Simplices<Dim + 1> cells =
        bodies.cells().middleCols(range.begin, range.size).array() - first;
    const FacetMatch<Dim> match = match_facets<Dim>(
        cells, bodies.meshes[body].vertex_count(),
        [&](std::uint32_t vertex) { return bodies.sharing.owns(vertex + first); });
    std::vector<std::array<double, Dim + 2>> own;
    for (std::size_t i = 0; i < match.boundary_cells.size(); ++i) {
        const auto facet = match.boundary.col(static_cast<Eigen::Index>(i));
        const std::uint32_t cell = match.boundary_cells[i];
        const auto corners = cells.col(cell);
        int opposite = 0;
        while ((facet.array() == corners[opposite]).any()) {
            ++opposite;
        }
        std::array<double, Dim + 2>& row = own.emplace_back();
        row[0] = bodies.mesh_cell(body, range.begin + cell);
        row[1] = opposite;
        std::copy(facet.begin(), facet.end(), row.begin() + 2);
    }
    const auto all = gather_in_order(bodies.sharing.ranks(), own);
    Simplices<Dim> boundary(Dim, static_cast<Eigen::Index>(all.size()));
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (int corner = 0; corner < Dim; ++corner) {
            boundary(corner, static_cast<Eigen::Index>(i)) =
                static_cast<std::uint32_t>(all[i][static_cast<std::size_t>(corner) + 2]);
        }
    }
    return boundary;
}

template <int Dim>
CellList<Dim> list_cells(
    const Bodies<Dim>& bodies,
    const std::function<bool(const Eigen::Matrix<std::uint32_t, Dim + 1, 1>&)>& is_wanted) {
    using Cell = Eigen::Matrix<std::uint32_t, Dim + 1, 1>;
    CellList<Dim> list;
    std::vector<std::array<double, Dim + 3>> own;
    for (std::size_t body = 0; body < bodies.count(); ++body) {
        const auto first = static_cast<std::uint32_t>(bodies.first_vertex[body]);
        const Simplices<Dim + 1>& whole = bodies.meshes[body].cells;
        for (Eigen::Index i = 0; i < whole.cols(); ++i) {
            const Cell cell = whole.col(i).array() + first;
            if (is_wanted(cell)) {
                list.cells.push_back(cell);
                list.bodies.push_back(body);
            }
        }
        const auto range = bodies.cells_of(body);
        for (Eigen::Index i = range.begin; is_of_parts(bodies) && i < range.begin + range.size;
             ++i) {
            const Cell cell = bodies.cells().col(i);
            if (bodies.sharing.owns(cell[0]) && is_wanted(cell)) {
                std::array<double, Dim + 3>& row = own.emplace_back();
                row[0] = static_cast<double>(body);
                row[1] = bodies.mesh_cell(body, i);
                std::copy(cell.begin(), cell.end(), row.begin() + 2);
            }
        }
    }
    if (is_of_parts(bodies)) {
        for (const auto& row : gather_in_order(bodies.sharing.ranks(), own)) {
            list.bodies.push_back(static_cast<std::size_t>(row[0]));
            std::transform(row.begin() + 2, row.end(), list.cells.emplace_back().begin(),
                           [](double vertex) { return static_cast<std::uint32_t>(vertex); });
        }
    }
    return list;
}

#define PENT_INSTANTIATE(Dim)                                                            \
    template std::vector<std::uint32_t> share_vertices<Dim>(                             \
        const Scene&, const std::vector<SimplexMesh<Dim>>&, int);                        \
    template Bodies<Dim> make_part_bodies<Dim>(const Scene&, std::vector<MeshPart<Dim>>, \
                                               const std::shared_ptr<const Ranks>&);     \
    template Simplices<Dim> boundary_of<Dim>(const Bodies<Dim>&, std::size_t);           \
    template CellList<Dim> list_cells<Dim>(                                              \
        const Bodies<Dim>&,                                                              \
        const std::function<bool(const Eigen::Matrix<std::uint32_t, Dim + 1, 1>&)>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
