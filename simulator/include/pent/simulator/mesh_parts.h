#pragma once

#include <pent/mesh_part.h>
#include <pent/simulator/ranks.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <functional>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

namespace pent::simulator {

/// Ranks need not have whole meshes. For each body a Simulation takes a part as loaded: all
/// vertices, and the NeededCells; with region labels and fibers where the scene asks for these, and
/// with the parents of cells for quadratic elements. Its constructor throws an Error also if there
/// are no ranks, or if ranks have different vertices. Whether cells are missing is not checked.
/// With parts Simulation::mesh() has no cells, vertex_values() is collective, and bodies and
/// obstacles cannot be added or removed.

/// Which cells of a mesh a rank needs: those that touch a vertex of its own, and those that are
/// part of the same elements as one of these. For smoothed elements, of all cells around an edge, a
/// few more than necessary are chosen: those with two or more vertices of cells that touch a vertex
/// of the rank. Where has_to_see_all(), first see() all cells, then ask has() of each.
class NeededCells {
public:
    /// @param vertices  Of the mesh.
    /// @param is_own    Whether a vertex is of this rank.
    NeededCells(ElementKind kind, std::size_t vertices, std::function<bool(std::uint32_t)> is_own)
        : kind_(kind),
          is_own_(std::move(is_own)),
          is_near_vertex_(kind == ElementKind::Smoothed ? vertices : 0) {}

    /// Whether see() has to be called with all cells first.
    [[nodiscard]] bool has_to_see_all() const { return kind_ != ElementKind::Linear; }

    /// @param parent  The quadratic cell that a cell is part of; not used for other elements.
    void see(std::span<const std::uint32_t> corners, std::uint32_t parent);

    [[nodiscard]] bool has(std::span<const std::uint32_t> corners, std::uint32_t parent) const;

private:
    [[nodiscard]] bool is_near(std::span<const std::uint32_t> corners) const;

    ElementKind kind_;
    std::function<bool(std::uint32_t)> is_own_;
    // Of cells that touch a vertex of this rank: their parents, and their vertices.
    std::unordered_set<std::uint32_t> parents_;
    std::vector<bool> is_near_vertex_;
};

/// Whether the scene selects something of a body by the labels of its cells.
[[nodiscard]] bool are_labels_asked_for(const Scene& scene, const Body& body);

/// Whether an activation takes the fibers that the mesh of a body has.
[[nodiscard]] bool are_fibers_asked_for(const Scene& scene, const Body& body);

/// Which rank owns each vertex, of all bodies counted through. Throws an Error if there are more
/// ranks than extrusion columns.
///
/// @param meshes  Of each body as loaded; cells are not used.
/// @param ranks   At least 1.
template <int Dim>
[[nodiscard]] std::vector<std::uint32_t> share_vertices(const Scene& scene,
                                                        const std::vector<SimplexMesh<Dim>>& meshes,
                                                        int ranks);

}  // namespace pent::simulator
