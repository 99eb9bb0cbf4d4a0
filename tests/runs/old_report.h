#pragma once

#include "record/run_report.h"

#include <nlohmann/json.hpp>
#include <string>

namespace pent::runs::test {

/// The text of report.json as version 0.1.0 wrote it: no parts, and every step with the same
/// energies beside its other keys.
inline std::string report_text_of_version_010(const RunReport& report) {
    auto json = nlohmann::ordered_json::parse(report_text(report));
    json.erase("parts");
    json.erase("thinnest");
    for (auto& step : json["steps"]) {
        const auto energies = step["energies"];
        step.erase("energies");
        for (const char* name : {"kinetic", "elastic", "gravity", "obstacle"}) {
            step[name] = energies.value(name, 0.0);
        }
        step["contact_energy"] = energies.value("contact", 0.0);
    }
    return json.dump(1);
}

}  // namespace pent::runs::test
