#pragma once

#include "document.h"

#include <functional>
#include <vector>

namespace pent::scene_fuzz {

/// All scenes that are one step simpler: without a body, a constraint or obstacle, a block, a key
/// or an entry of a list; with fewer frames, cells or digits; with a number that is zero, one or
/// half of it. The largest steps come first. Some are no valid scenes.
[[nodiscard]] std::vector<Json> simpler_scenes(const Json& scene);

/// The simplest scene that can be reached by such steps over scenes that still fail.
///
/// @param fails  Whether a scene fails as the given one does.
/// @param tries  How often `fails` is asked, at most.
[[nodiscard]] Json shrink(const Json& scene,
                          const std::function<bool(const Json&)>& fails,
                          int tries);

}  // namespace pent::scene_fuzz
