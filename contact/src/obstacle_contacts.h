#pragma once

#include "colliders.h"
#include "shared_work.h"

#include <pent/contact/contact.h>

#include <vector>

namespace pent::contact {

/// The vertices that meet the surfaces of obstacles: under the penalty model all that are free,
/// under a barrier those of bodies' surfaces, and obstacles that repel vertices. Ascending.
template <int Dim>
[[nodiscard]] std::vector<std::uint32_t> vertices_at_obstacles(const Colliders<Dim>& colliders);

/// Whether vertices meet the surface of an obstacle; if not, its core is a collider.
template <int Dim>
[[nodiscard]] bool meets_vertices(const Colliders<Dim>& colliders, std::size_t obstacle) {
    return !colliders.is_barrier()
           || repels(colliders.scene().obstacles[obstacle].shape) == Repels::Vertices;
}

/// Contacts of vertices with the surfaces of obstacles, by obstacle, then in the order of
/// `vertices`, without energies. Parallel.
///
/// @param vertices  Which columns of `positions` to look at.
template <int Dim>
[[nodiscard]] std::vector<Contact<Dim>> find_obstacle_contacts(
    const Colliders<Dim>& colliders,
    const std::vector<std::uint32_t>& vertices,
    const PositionsView<Dim>& positions,
    const SharedWork& shared = {});

}  // namespace pent::contact
