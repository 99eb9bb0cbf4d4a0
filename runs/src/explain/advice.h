#pragma once

#include "explain/trial.h"

#include <string>
#include <vector>

namespace pent::runs {

/// What could be left out of a scene or is missing, a line each.
[[nodiscard]] std::vector<std::string> advice(const Trial& trial);

}  // namespace pent::runs
