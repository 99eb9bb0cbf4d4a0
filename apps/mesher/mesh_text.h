#pragma once

#include <pent/mesher/quality.h>

#include <nlohmann/json.hpp>
#include <string>

namespace pent::apps {

/// printf into a string of up to 512 characters.
[[nodiscard]] std::string text(const char* format, ...) __attribute__((format(printf, 1, 2)));

/// One line with the figures that matter most.
[[nodiscard]] std::string quality_line(const mesher::QualityReport& report);

[[nodiscard]] nlohmann::ordered_json to_json(const mesher::QualityReport& report);

}  // namespace pent::apps
