#pragma once

#include "soup.h"

#include <pent/mesher/step_limits.h>

#include <filesystem>

namespace pent::mesher {

/// Readers of one format each, in double precision where the format has it. Every one throws an
/// Error that names file and line (or offset) for what is damaged, and allocates no more than the
/// size of the file bears out.

/// `v` and `f` lines of a Wavefront OBJ file; `l` and `p` are counted, all else is skipped.
[[nodiscard]] TriangleSoup read_obj(const std::filesystem::path& path);

/// OFF as text, also COFF, NOFF and the like: what follows coordinates and corners is skipped.
[[nodiscard]] TriangleSoup read_off(const std::filesystem::path& path);

/// STL, as text or binary.
[[nodiscard]] TriangleSoup read_stl(const std::filesystem::path& path);

/// PLY, as text or binary: x, y, z of `vertex`, vertex_indices (or vertex_index) of `face`.
[[nodiscard]] TriangleSoup read_ply(const std::filesystem::path& path);

/// glTF, as text or binary, in float, with the placements of its scene, through assimp, in a
/// process of its own with these limits.
[[nodiscard]] TriangleSoup read_gltf(const std::filesystem::path& path, const StepLimits& limits);

}  // namespace pent::mesher
