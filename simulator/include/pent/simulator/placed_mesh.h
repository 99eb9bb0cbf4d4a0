#pragma once

#include <pent/mesh_part.h>
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

/// The same of a part of a mesh.
template <int Dim>
[[nodiscard]] MeshPart<Dim> place(MeshPart<Dim> part, const Body& body);

/// The same, in place, without any check.
template <int Dim>
void put_in_place(SimplexMesh<Dim>& mesh, const Placement& placement);

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

/// Which cells of a placed mesh are selected by any of these, one entry a cell: those whose center
/// (the mean of the corners) is in a ball, box or half-space, those with all corners in layers, and
/// those with a region label. Throws as select_vertices() does.
template <int Dim>
[[nodiscard]] std::vector<bool> select_cells(const SimplexMesh<Dim>& mesh,
                                             const std::vector<Selection>& select,
                                             const std::string& where);

/// The number of the material of every cell of a placed mesh: 0 for that of the body, i + 1 for
/// that of its i-th region. Throws an Error if a region selects nothing.
template <int Dim>
[[nodiscard]] std::vector<std::uint16_t> materials_of_cells(const SimplexMesh<Dim>& mesh,
                                                            const Body& body);

/// The material of that number.
[[nodiscard]] const Material& material_of(const Body& body, std::uint16_t number);

/// "scene.toml:4:8: constraint on "a"", for messages.
[[nodiscard]] std::string place_and_name(const Constraint& constraint);
[[nodiscard]] std::string place_and_name(const Load& load);
[[nodiscard]] std::string place_and_name(const Activation& activation);
[[nodiscard]] std::string place_and_name(const Attachment& attachment);
[[nodiscard]] std::string place_and_name(const Region& region);

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
