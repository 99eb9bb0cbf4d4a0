#pragma once

#include "common/program.h"

#include <pent/simulator/ranks.h>

#include <memory>

namespace pent::apps {

/// What pent-sim is, alone or as one of several ranks: options, run folders, messages, exit codes.
///
/// @param ranks  Null for one process alone. All but rank 0 have a program that is silent.
[[nodiscard]] int run_simulation_program(Program& program,
                                         std::shared_ptr<const simulator::Ranks> ranks,
                                         int argc,
                                         char** argv);

}  // namespace pent::apps
