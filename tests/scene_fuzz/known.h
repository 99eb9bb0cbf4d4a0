#pragma once

#include "document.h"
#include "laws.h"

#include <string>

namespace pent::scene_fuzz {

/// Why a finding is no news: the defect behind it, which is known and about to be mended. Empty if it is
/// news. The list is reviewed with every change and is empty in a release.
[[nodiscard]] std::string known_defect(const Json& scene, const Finding& finding);

}  // namespace pent::scene_fuzz
