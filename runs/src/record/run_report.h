#pragma once

#include <pent/runs/report.h>

#include <string>

namespace pent::runs {

/// The text of report.json.
[[nodiscard]] std::string report_text(const RunReport& report);

/// How long to wait from one writing of report.json to the next while a run goes on, s: it tells of
/// every step anew, and in long runs takes seconds.
///
/// @param seconds  That the last writing took.
/// @return         At least 10, and so long that writing takes no more than a hundredth of the
///                 time.
[[nodiscard]] double report_pause(double seconds);

}  // namespace pent::runs
