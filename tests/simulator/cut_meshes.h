#pragma once

#include <pent/mesh_part.h>
#include <pent/simulator/mesh_parts.h>

#include <algorithm>
#include <vector>

namespace pent::simulator::test {

/// What a rank of a scene has of meshes that are here as a whole: vertices, and cells that touch
/// one of its own.
template <int Dim>
[[nodiscard]] std::vector<MeshPart<Dim>> cut_meshes(const Scene& scene,
                                                    const std::vector<SimplexMesh<Dim>>& meshes,
                                                    const Ranks& ranks) {
    const std::vector<std::uint32_t> owners = share_vertices<Dim>(scene, meshes, ranks.count());
    std::vector<MeshPart<Dim>> parts;
    std::size_t first = 0;
    for (const SimplexMesh<Dim>& mesh : meshes) {
        MeshPart<Dim>& part = parts.emplace_back();
        part.cell_count = mesh.cell_count();
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            const auto corners = mesh.cells.col(cell);
            if (std::any_of(corners.begin(), corners.end(), [&](std::uint32_t vertex) {
                    return static_cast<int>(owners[first + vertex]) == ranks.rank();
                })) {
                part.numbers.push_back(static_cast<std::uint32_t>(cell));
                if (!mesh.regions.empty()) {
                    part.mesh.regions.push_back(mesh.regions[static_cast<std::size_t>(cell)]);
                }
            }
        }
        part.mesh.positions = mesh.positions;
        part.mesh.columns = mesh.columns;
        part.mesh.layers = mesh.layers;
        part.mesh.cells = mesh.cells(Eigen::all, part.numbers);
        first += static_cast<std::size_t>(mesh.vertex_count());
    }
    return parts;
}

}  // namespace pent::simulator::test
