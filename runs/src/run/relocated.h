#pragma once

#include "simulator_names.h"

#include <filesystem>

namespace pent::runs {

/// The scene as written in a run folder: mesh paths relative to that folder.
[[nodiscard]] inline Scene relocated(const Scene& scene, const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    Scene moved = scene;
    for (Body& body : moved.bodies) {
        body.mesh = fs::proximate(fs::absolute(body.mesh), fs::absolute(folder)).string();
    }
    return moved;
}

}  // namespace pent::runs
