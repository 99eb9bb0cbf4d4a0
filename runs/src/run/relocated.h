#pragma once

#include "simulator_names.h"

#include <filesystem>

namespace pent::runs {

/// The scene as written in a run folder: paths of meshes, and those of files in recipes, relative
/// to that folder.
///
/// @param origin  The folder that recipes are relative to, that of the scene file.
[[nodiscard]] Scene relocated(const Scene& scene,
                              const std::filesystem::path& origin,
                              const std::filesystem::path& folder);

}  // namespace pent::runs
