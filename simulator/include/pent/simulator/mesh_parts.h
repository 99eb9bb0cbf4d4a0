#pragma once

#include <pent/mesh_part.h>
#include <pent/simulator/ranks.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// Ranks need not have whole meshes: a Simulation takes, for each body, a part as loaded: all
/// vertices, and the cells that touch a vertex of this rank, with their labels of regions where the
/// scene asks for these. Its constructor then throws an Error for scenes that can_take_parts() says
/// no to, too, and for other vertices than on other ranks. Whether cells are missing is not
/// checked. Simulation::mesh() has no cells then, all ask for vertex_values() together, and bodies
/// and obstacles do not come and go.

/// Whether it may be so for a scene. Not for terms that look farther: elements of more than one
/// cell, activations and attachments.
[[nodiscard]] bool can_take_parts(const Scene& scene);

/// Whether the scene selects something of a body by the labels of its cells.
[[nodiscard]] bool are_labels_asked_for(const Scene& scene, const Body& body);

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
