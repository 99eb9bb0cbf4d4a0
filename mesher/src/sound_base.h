#pragma once

#include <pent/simplex_mesh.h>

#include <string>

namespace pent::mesher {

/// Throws an Error that begins with `name` unless tetrahedra fit together and their boundary is a
/// manifold: with the place where parts touch in an edge or a point alone, which no body may.
void require_sound_base(const SimplexMesh<3>& mesh, const std::string& name);

}  // namespace pent::mesher
