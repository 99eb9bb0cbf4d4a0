#pragma once

#include <pent/simplex_mesh.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// The mesh scaled, turned about its origin and moved; cells and labels stay as they are.
///
/// Throws an Error that names the body if the placed mesh no longer passes validate().
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> place(SimplexMesh<Dim> mesh, const Body& body);

/// Vertices of a placed mesh that a constraint selects, in increasing order.
///
/// Throws an Error that names the body if nothing is selected, or if the mesh does not know the
/// layers or regions asked for.
template <int Dim>
[[nodiscard]] std::vector<std::uint32_t> select_vertices(const SimplexMesh<Dim>& mesh,
                                                         const Constraint& constraint);

}  // namespace pent::simulator
