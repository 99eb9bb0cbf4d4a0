#include "run/run_meshes.h"

#include "run/resume.h"
#include "scene/scene_meshes.h"

#include <pent/error.h>
#include <pent/mesh_extras.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

namespace pent::runs {

namespace {

// The copy of a scene in the folder of a run names meshes as seen from there: whoever has moved the
// folder, or was sent it, has to be told what else it takes.
void require_files(const Scene& scene) {
    for (const Body& body : scene.bodies) {
        std::error_code ignored;
        if (std::filesystem::status(body.mesh, ignored).type()
            == std::filesystem::file_type::not_found) {
            throw Error((body.source.empty() ? "" : body.source + ": ") + body.mesh
                        + ": cannot be read: No such file or directory; it is the mesh of \""
                        + body.name + "\": put it there, or let `mesh` name it where it is");
        }
    }
}

}  // namespace

template <int Dim>
Simulation<Dim> RunMeshes<Dim>::simulate(const simulator::SimulationOptions& options,
                                         const Look& look) {
    ranks_.agree([&] { require_files(scene_); });
    if (ranks_.count() > 0) {
        SceneParts<Dim> parts = read_parts<Dim>(scene_, ranks_);
        warnings_ = std::move(parts.warnings);
        if (look) {
            show(parts, options.ranks.get(), look);
        }
        sources_ = std::move(parts.sources);
        return {scene_, std::move(parts.parts), options};
    }
    SceneMeshes<Dim> meshes = read_meshes<Dim>(scene_);
    warnings_ = std::move(meshes.warnings);
    for (std::size_t body = 0; look && body < meshes.meshes.size(); ++body) {
        const SimplexMesh<Dim>& mesh = meshes.meshes[body];
        look(body,
             {.share = {mesh}, .cells = mesh.cell_count(), .has_parents = !mesh.parents.empty()});
    }
    return {scene_, std::move(meshes.meshes), options};
}

template <int Dim>
void RunMeshes<Dim>::show(const SceneParts<Dim>& parts,
                          const simulator::Ranks* ranks,
                          const Look& look) const {
    std::size_t first = 0;
    for (std::size_t body = 0; body < parts.parts.size(); ++body) {
        const MeshPart<Dim>& part = parts.parts[body];
        const auto count = static_cast<std::size_t>(part.mesh.vertex_count());
        bool has_parents = false;
        ranks_.agree([&] { has_parents = !parts.sources[body].cells(0, 1).parents.empty(); });
        look(body,
             {.share = {part.mesh,
                        std::span<const std::uint32_t>(parts.owners).subspan(first, count), ranks},
              .cells = part.cell_count,
              .has_parents = has_parents});
        first += count;
    }
}

// Which rows this process writes or compares.
template <int Dim>
MeshSlab RunMeshes<Dim>::slab_of_rows(const SimplexMesh<Dim>& mesh, int body) const {
    if (ranks_.count() == 0) {
        return slab_of(mesh.vertex_count(), mesh.cell_count(), 0, 1);
    }
    const MeshSource<Dim>& source = sources_[static_cast<std::size_t>(body)];
    return slab_of(mesh.vertex_count(), static_cast<Eigen::Index>(source.info().cells),
                   ranks_.place(), ranks_.count());
}

// They, on a rank.
template <int Dim>
SimplexMesh<Dim> RunMeshes<Dim>::slab_of_mesh(const SimplexMesh<Dim>& mesh, int body) const {
    const auto index = static_cast<std::size_t>(body);
    const MeshSlab slab = slab_of_rows(mesh, body);
    SimplexMesh<Dim> rows = sources_[index].cells(slab.first_cell, slab.last_cell);
    put_in_place(rows, scene_.bodies[index].place);  // fibers
    SimplexMesh<Dim> vertices =
        rows_of(mesh, {.first_vertex = slab.first_vertex, .last_vertex = slab.last_vertex});
    rows.positions = std::move(vertices.positions);
    rows.columns = std::move(vertices.columns);
    rows.layers = std::move(vertices.layers);
    return rows;
}

template <int Dim>
std::uint32_t RunMeshes<Dim>::write(const std::filesystem::path& file,
                                    const Simulation<Dim>& simulation,
                                    int body,
                                    const std::string& created_by) const {
    const SimplexMesh<Dim>& mesh = simulation.mesh(body);
    const Body& of_scene = scene_.bodies[static_cast<std::size_t>(body)];
    SimplexMesh<Dim> slab;
    MeshExtras<Dim> extras;
    ranks_.agree([&] {
        const MeshSlab rows = slab_of_rows(mesh, body);
        if (ranks_.count() > 0) {
            slab = slab_of_mesh(mesh, body);
        }
        extras = read_extras<Dim>(of_scene.mesh, rows);
        turn<Dim>(extras.vertex_fields, of_scene.place);
        turn<Dim>(extras.cell_fields, of_scene.place);
        validate_extras(extras, rows, mesh.vertex_count(), file.string());
    });
    return write_mesh_slab(file, ranks_.count() > 0 ? slab : mesh, extras,
                           {.created_by = created_by, .writers = ranks_.writers()});
}

template <int Dim>
std::uint32_t RunMeshes<Dim>::compare(const std::filesystem::path& file,
                                      const Simulation<Dim>& simulation,
                                      int body) const {
    const SimplexMesh<Dim>& mesh = simulation.mesh(body);
    if (ranks_.count() == 0) {
        return check_same_mesh(file, mesh, ranks_);
    }
    SimplexMesh<Dim> slab;
    ranks_.agree([&] { slab = slab_of_mesh(mesh, body); });
    return check_same_mesh(file, slab, ranks_);
}

template class RunMeshes<3>;
template class RunMeshes<4>;

}  // namespace pent::runs
