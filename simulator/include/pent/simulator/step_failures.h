#pragma once

#include <string_view>

namespace pent::simulator {

/// What StepReport::failure says where what to try hangs on it: to be compared with as a whole.

inline constexpr std::string_view kSolverFailure = "the linear solver did not reach its tolerance";
inline constexpr std::string_view kIndefiniteFailure = "the matrix was not positive definite";

}  // namespace pent::simulator
