#pragma once

#include <pent/simulator/scene.h>

#include <filesystem>

namespace pent::runs {

/// The scene as it is written in another folder, that of a run: paths of meshes, and those of files
/// in recipes, relative to that folder.
///
/// @param origin  The folder that recipes are relative to, that of the scene file.
[[nodiscard]] simulator::Scene relocated(const simulator::Scene& scene,
                                         const std::filesystem::path& origin,
                                         const std::filesystem::path& folder);

}  // namespace pent::runs
