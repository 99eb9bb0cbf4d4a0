#pragma once

#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace pent::mesher {

/// Edgewise subdivision [edelsbrunner2000]: every edge is cut in k parts, every cell in k^Dim cells
/// of equal volume, which fall into at most Dim!/2 shapes however large k is.
///
/// The old vertices keep their numbers, new ones follow. Cells of a face see it cut alike, since
/// the cut depends on the order of its vertices' numbers alone. The cells of a cell follow one
/// another. Regions and fibers are handed down; columns and layers become those of the base mesh
/// subdivided alike, with k layers for each one before. Parents are left out.
///
/// @param k  1 or more.
/// Throws an Error if the result would have more than 2^32 - 1 vertices.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> subdivide(const SimplexMesh<Dim>& mesh, int k);

/// The quantities of a mesh (Dim 3 or 4) for what subdivide() makes of it: those of vertices are
/// interpolated linearly, those of a cell go to all cells that it is cut into.
template <int Dim>
[[nodiscard]] MeshExtras<Dim> subdivide_fields(const SimplexMesh<Dim>& mesh,
                                               const MeshExtras<Dim>& fields,
                                               int k);

/// Cells for quadratic elements (Dim 3 or 4): every edge is cut in two, as subdivide() does, and
/// each of the 2^Dim cells of a cell has that one's number as its parent.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> make_quadratic(const SimplexMesh<Dim>& mesh);

/// The edges of a mesh in the order of the vertices that make_quadratic() puts into their middles,
/// the first of which comes behind the last of the mesh.
template <int Dim>
[[nodiscard]] std::vector<std::array<std::uint32_t, 2>> cut_edges(const SimplexMesh<Dim>& mesh);

}  // namespace pent::mesher
