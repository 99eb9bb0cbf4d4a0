#pragma once

#include "simulator_names.h"

#include <pent/runs/run.h>

#include <string>

namespace pent::runs {

/// The text of report.json. Its verdict is that of the last part.
[[nodiscard]] std::string report_text(const RunReport& report);

/// What the report.json of a run without a journal, as version 0.1.0 left it, knows of the run.
struct ReportHistory {
    std::vector<FrameReport> frames;
    std::vector<StepReport> steps;
    RunPart part;
};

/// Throws an Error that names `name` if the text is not such a report.
[[nodiscard]] ReportHistory parse_history(const std::string& text,
                                          const std::string& name,
                                          const std::vector<std::string>& bodies);

}  // namespace pent::runs
