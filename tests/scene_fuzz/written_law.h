#pragma once

#include "document.h"

#include <string>

namespace pent::scene_fuzz {

/// The first key of a scene that the scene as written back lacks, or has with another value; empty
/// if there is none.
[[nodiscard]] std::string what_is_lost(const Json& scene, const Json& written);

}  // namespace pent::scene_fuzz
