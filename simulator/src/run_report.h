#pragma once

#include <pent/simulator/run.h>

#include <string>

namespace pent::simulator {

/// The text of report.json.
///
/// @param verdict  As a run ended, or "running".
[[nodiscard]] std::string report_text(const RunReport& report,
                                      std::string_view verdict,
                                      const std::string& created_by,
                                      int threads);

/// Frames and steps of an earlier report.json, up to the given frame and step.
///
/// Throws an Error that names `name` if the text is not such a report.
struct ReportHistory {
    std::vector<FrameReport> frames;
    std::vector<StepReport> steps;
};
[[nodiscard]] ReportHistory parse_history(const std::string& text,
                                          const std::string& name,
                                          const std::vector<std::string>& bodies,
                                          int last_frame,
                                          std::uint64_t last_step);

}  // namespace pent::simulator
