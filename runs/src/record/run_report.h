#pragma once

#include <pent/runs/report.h>

#include <string>

namespace pent::runs {

/// The text of report.json.
[[nodiscard]] std::string report_text(const RunReport& report);

}  // namespace pent::runs
