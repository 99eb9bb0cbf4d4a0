#pragma once

#include <filesystem>

namespace pent {

/// Whether a mesh file says which cells lie in one quadratic cell (SimplexMesh::parents), as those
/// of pent-mesh --quadratic do. Reads the header alone.
///
/// Throws an Error that names the file where it is not there or has no header that is understood.
[[nodiscard]] bool has_parents(const std::filesystem::path& path);

}  // namespace pent
