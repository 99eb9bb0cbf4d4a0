#pragma once

#include <pent/extrusion.h>
#include <pent/pent_file.h>

namespace pent::mesher {

/// The quantities of a base, carried over to its extrusion.
///
/// A number of a vertex is the same at each of its copies, a number of a cell in each cell over it.
/// Vectors and fibers go the way of their layer: those of a vertex become `linear` times what they
/// were, those of a cell the mean of the two layers that it lies between; so they have no part
/// along the new axis where layers are not turned. A point in which a body ends has the mean of the
/// vertices of the base, and a vector of zero.
///
/// @param fields  Quantities of the base.
/// @param mesh    What extrude() makes of base and layers; gets the fibers.
template <int Dim>
[[nodiscard]] MeshExtras<Dim> extrude_fields(const SimplexMesh<Dim - 1>& base,
                                             const MeshExtras<Dim - 1>& fields,
                                             const std::vector<Layer<Dim>>& layers,
                                             SimplexMesh<Dim>& mesh);

}  // namespace pent::mesher
