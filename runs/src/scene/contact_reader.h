#pragma once

#include "simulator_names.h"

#include <pent/toml_table.h>

namespace pent::runs {

/// Parts of scene files that say what bodies meet. Every function throws an Error with
/// file:line:column.

/// A vector that is not zero, made unit length.
[[nodiscard]] Eigen::VectorXd read_direction(TableReader& reader,
                                             std::string_view key,
                                             int dimension);

[[nodiscard]] Contact read_contact(TableReader reader);

[[nodiscard]] Obstacle read_obstacle(TableReader& reader, int dimension);

}  // namespace pent::runs
