#pragma once

#include <pent/simplex_mesh.h>

namespace pent::mesher {

/// Edgewise subdivision [edelsbrunner2000]: every edge is cut in k parts, every cell in k^Dim cells
/// of equal volume, which fall into at most Dim!/2 shapes however large k is.
///
/// The old vertices keep their numbers, new ones follow. Cells of a face see it cut alike, since
/// the cut depends on the order of its vertices' numbers alone. Regions are handed down; columns
/// and layers have no meaning afterwards and are left out.
///
/// @param k  1 or more.
/// Throws an Error if the result would have more than 2^32 - 1 vertices.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> subdivide(const SimplexMesh<Dim>& mesh, int k);

}  // namespace pent::mesher
