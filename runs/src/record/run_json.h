#pragma once

#include "simulator_names.h"

#include <pent/runs/run.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pent::runs {

/// Steps, frames and parts of a run as JSON, for report.json and the journal. Parsing throws a
/// nlohmann::json::exception for anything else.
using Json = nlohmann::ordered_json;

[[nodiscard]] Json step_json(const StepReport& step);
[[nodiscard]] StepReport parse_step(const Json& json);

/// @param bodies  Their names, in the order of FrameReport::non_rigid.
[[nodiscard]] Json frame_json(const FrameReport& frame, const std::vector<std::string>& bodies);
[[nodiscard]] FrameReport parse_frame(const Json& json, const std::vector<std::string>& bodies);

[[nodiscard]] Json part_json(const RunPart& part);
[[nodiscard]] RunPart parse_part(const Json& json);

}  // namespace pent::runs
