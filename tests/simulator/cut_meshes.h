#pragma once

#include <pent/mesh_part.h>
#include <pent/simulator/mesh_parts.h>

#include <span>
#include <vector>

namespace pent::simulator::test {

/// What a rank of a scene has of meshes that are here as a whole: vertices, and the cells that it
/// needs, with all that the mesh knows of these.
template <int Dim>
[[nodiscard]] std::vector<MeshPart<Dim>> cut_meshes(const Scene& scene,
                                                    const std::vector<SimplexMesh<Dim>>& meshes,
                                                    const Ranks& ranks) {
    const std::vector<std::uint32_t> owners = share_vertices<Dim>(scene, meshes, ranks.count());
    std::vector<MeshPart<Dim>> parts;
    std::size_t first = 0;
    for (const SimplexMesh<Dim>& mesh : meshes) {
        NeededCells needed(scene.solver.elements, static_cast<std::size_t>(mesh.vertex_count()),
                           [&](std::uint32_t vertex) {
                               return static_cast<int>(owners[first + vertex]) == ranks.rank();
                           });
        const auto corners = [&](Eigen::Index cell) {
            return std::span<const std::uint32_t>(mesh.cells.col(cell).data(), Dim + 1);
        };
        const auto parent = [&](Eigen::Index cell) {
            return mesh.parents.empty() ? static_cast<std::uint32_t>(cell >> Dim)
                                        : mesh.parents[static_cast<std::size_t>(cell)];
        };
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            needed.see(corners(cell), parent(cell));
        }
        MeshPart<Dim>& part = parts.emplace_back();
        part.cell_count = mesh.cell_count();
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            if (!needed.has(corners(cell), parent(cell))) {
                continue;
            }
            part.numbers.push_back(static_cast<std::uint32_t>(cell));
            if (!mesh.regions.empty()) {
                part.mesh.regions.push_back(mesh.regions[static_cast<std::size_t>(cell)]);
            }
            if (!mesh.parents.empty()) {
                part.mesh.parents.push_back(parent(cell));
            }
        }
        part.mesh.positions = mesh.positions;
        part.mesh.columns = mesh.columns;
        part.mesh.layers = mesh.layers;
        part.mesh.cells = mesh.cells(Eigen::all, part.numbers);
        if (mesh.fibers.cols() > 0) {
            part.mesh.fibers = mesh.fibers(Eigen::all, part.numbers);
        }
        first += static_cast<std::size_t>(mesh.vertex_count());
    }
    return parts;
}

}  // namespace pent::simulator::test
