#pragma once

#include <pent/mesher/quality.h>

#include <nlohmann/json.hpp>
#include <string>

namespace pent::apps {

/// One line with the figures that matter most.
[[nodiscard]] std::string quality_line(const mesher::QualityReport& report);

[[nodiscard]] nlohmann::ordered_json to_json(const mesher::QualityReport& report);

}  // namespace pent::apps
