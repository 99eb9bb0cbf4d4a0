// SPDX-License-Identifier: GPL-3.0-or-later

#include "mesh_text.h"

#include <pent/formatted.h>

namespace pent::apps {

namespace {

nlohmann::ordered_json to_json(const mesher::Spread& spread) {
    return {{"min", spread.min},           {"p1", spread.percentile_1},
            {"p5", spread.percentile_5},   {"median", spread.median},
            {"mean", spread.mean},         {"p95", spread.percentile_95},
            {"p99", spread.percentile_99}, {"max", spread.max}};
}

}  // namespace

std::string quality_line(const mesher::QualityReport& report) {
    return formatted("mean ratio min %.3f mean %.3f, condition of Dm mean %.3g max %.3g",
                     report.mean_ratio.min, report.mean_ratio.mean, report.condition.mean,
                     report.condition.max);
}

nlohmann::ordered_json to_json(const mesher::QualityReport& report) {
    return {{"mean_ratio", to_json(report.mean_ratio)},
            {"condition", to_json(report.condition)},
            {"smallest_angle_degrees", to_json(report.smallest_angle)},
            {"largest_angle_degrees", to_json(report.largest_angle)},
            {"histogram", report.histogram},
            {"worst_cells", report.worst_cells}};
}

}  // namespace pent::apps
