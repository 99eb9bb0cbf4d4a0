#pragma once

#include "cells.h"

#include <pent/mesher/step_limits.h>
#include <pent/simplex_mesh.h>

#include <cstdint>
#include <functional>
#include <string>

namespace pent::mesher {

/// Points and simplices on them: what steps in a process of their own give back.
template <int Corners>
struct Pieces {
    Positions<3> points;
    Simplices<Corners> cells;
    CellCounts left_out{};  ///< What a file had beside them.
};

/// Runs a step in a child process and brings its result back. A step that crashes, aborts, or
/// passes a limit costs the child alone; what it prints is lost.
///
/// The child is a copy of this process with this thread only: the step must not use threads. It
/// ends with this process. Instantiated for 3 and 4 corners. Throws an Error if the step throws one
/// (the same text), throws anything else, or does not live to give a result; `name` begins the
/// line, as in "the wrap".
template <int Corners>
[[nodiscard]] Pieces<Corners> run_isolated(const std::string& name,
                                           const StepLimits& limits,
                                           const std::function<Pieces<Corners>()>& step);

/// The limit on time as the kernel takes it, s, 1 or more.
[[nodiscard]] std::int64_t whole_seconds(const StepLimits& limits);

/// What to say of a step that was ended by a signal, as in "was ended after 300 s".
[[nodiscard]] std::string explain_signal(int signal, const StepLimits& limits);

/// The same of one that ran out of memory.
[[nodiscard]] std::string explain_out_of_memory(const StepLimits& limits);

}  // namespace pent::mesher
