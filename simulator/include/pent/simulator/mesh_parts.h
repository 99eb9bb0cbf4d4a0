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

/// Ranks need not have whole meshes: a Simulation takes, for each body, a part as loaded: all
/// vertices, and the NeededCells, with their labels of regions and fibers where the scene asks for
/// these, and with their parents for quadratic elements. Its constructor then throws an Error
/// without ranks and for other vertices than on other ranks, too. Whether cells are missing is not
/// checked. Simulation::mesh() has no cells then, all ask for vertex_values() together, and bodies
/// and obstacles do not come and go.

/// The cells of a mesh that a rank needs: those that touch a vertex of its own, and those that make
/// up an element with one of these. Of smoothed elements, which cells make up that share an edge,
/// they have some more: all with two vertices of cells that touch one of its own. Whoever chooses
/// shows all cells, where one is not enough to tell, and then asks for each.
class NeededCells {
public:
    /// @param vertices  Of the mesh.
    /// @param is_own    Whether a vertex is of this rank.
    NeededCells(ElementKind kind, std::size_t vertices, std::function<bool(std::uint32_t)> is_own)
        : kind_(kind),
          is_own_(std::move(is_own)),
          is_near_vertex_(kind == ElementKind::Smoothed ? vertices : 0) {}

    /// Whether all cells have to be shown first.
    [[nodiscard]] bool has_to_see_all() const { return kind_ != ElementKind::Linear; }

    /// @param parent  That cells of one quadratic cell share; else it does not count.
    void see(std::span<const std::uint32_t> corners, std::uint32_t parent);

    [[nodiscard]] bool has(std::span<const std::uint32_t> corners, std::uint32_t parent) const;

private:
    [[nodiscard]] bool is_near(std::span<const std::uint32_t> corners) const;

    ElementKind kind_;
    std::function<bool(std::uint32_t)> is_own_;
    // Of cells that touch a vertex of this rank.
    std::unordered_set<std::uint32_t> parents_;
    std::vector<bool> is_near_vertex_;
};

/// Whether the scene selects something of a body by the labels of its cells.
[[nodiscard]] bool are_labels_asked_for(const Scene& scene, const Body& body);

/// Whether an activation takes the fibers that the mesh of a body has.
[[nodiscard]] bool are_fibers_asked_for(const Scene& scene, const Body& body);

/// Which rank each vertex is at home on, of all bodies counted through. Throws an Error where there
/// are more ranks than columns of vertices.
///
/// @param meshes  Of each body as loaded; cells do not count.
/// @param ranks   At least 1.
template <int Dim>
[[nodiscard]] std::vector<std::uint32_t> share_vertices(const Scene& scene,
                                                        const std::vector<SimplexMesh<Dim>>& meshes,
                                                        int ranks);

}  // namespace pent::simulator
