#pragma once

#include "document.h"

#include <filesystem>
#include <string>

namespace pent::scene_fuzz {

/// What in a run did work, or was written, though its scene leaves it out; empty if nothing.
///
/// @param written  The scene with every default filled in.
[[nodiscard]] std::string work_of_what_is_off(const Json& written,
                                              const std::filesystem::path& run);

}  // namespace pent::scene_fuzz
