#pragma once

#include <pent/simplex_mesh.h>
#include <pent/simulator/scene.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pent::simulator {

/// The mesh scaled, turned about its origin and moved; cells and labels stay as they are.
///
/// Throws an Error that names the body if the placed mesh no longer passes validate().
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> place(SimplexMesh<Dim> mesh, const Body& body);

/// Vertices of a placed mesh that are selected by any of these, in increasing order.
///
/// @param where  Who selects, for messages.
///
/// Throws an Error if nothing is selected, or if the mesh does not know the layers or regions asked
/// for.
template <int Dim>
[[nodiscard]] std::vector<std::uint32_t> select_vertices(const SimplexMesh<Dim>& mesh,
                                                         const std::vector<Selection>& select,
                                                         const std::string& where);

/// "scene.toml:4:8: constraint on "a"", for messages.
[[nodiscard]] std::string place_and_name(const Constraint& constraint);
[[nodiscard]] std::string place_and_name(const Load& load);
[[nodiscard]] std::string place_and_name(const Attachment& attachment);

/// Vertices that a constraint, a load or an attachment selects.
template <int Dim, typename Selecting>
requires requires(Selecting part) {
    part.select;
}
[[nodiscard]] std::vector<std::uint32_t> select_vertices(const SimplexMesh<Dim>& mesh,
                                                         const Selecting& part) {
    return select_vertices(mesh, part.select, place_and_name(part));
}

}  // namespace pent::simulator
