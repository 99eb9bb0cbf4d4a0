#pragma once

#include <filesystem>

namespace pent::apps {

/// Throws an Error if what was given as a scene is a folder; it names the scene files in it, one of
/// which was meant.
void refuse_folder(const std::filesystem::path& scene);

}  // namespace pent::apps
