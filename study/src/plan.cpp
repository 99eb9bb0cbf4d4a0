#include "plan.h"

#include "json_count.h"

#include <pent/error.h>
#include <pent/output_file.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

namespace pent::study {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json to_json(const Unit& unit) {
    Json settings = Json::array();
    for (const Setting& setting : unit.settings) {
        settings.push_back({setting.axis, setting.value});
    }
    return {{"kind", kind_name(unit.kind)}, {"name", unit.name},     {"settings", settings},
            {"scene", unit.scene},          {"meshes", unit.meshes}, {"refusal", unit.refusal}};
}

Unit unit_from(const Json& json) {
    Unit unit;
    unit.kind = json.at("kind") == kind_name(UnitKind::Reference) ? UnitKind::Reference
                                                                  : UnitKind::Combination;
    json.at("name").get_to(unit.name);
    for (const Json& setting : json.at("settings")) {
        unit.settings.push_back({setting.at(0), setting.at(1)});
    }
    json.at("scene").get_to(unit.scene);
    unit.meshes = static_cast<std::uint32_t>(count_of(json.at("meshes")));
    json.at("refusal").get_to(unit.refusal);
    return unit;
}

Plan plan_from(const Json& json) {
    Plan plan;
    json.at("scene").get_to(plan.scene);
    json.at("frames").get_to(plan.frames);
    json.at("scene_frames").get_to(plan.scene_frames);
    json.at("repeats").get_to(plan.repeats);
    json.at("threads").get_to(plan.threads);
    json.at("keep_runs").get_to(plan.keep_runs);
    json.at("reference_integrator").get_to(plan.reference_integrator);
    json.at("reference").get_to(plan.reference);
    for (const Json& unit : json.at("units")) {
        plan.units.push_back(unit_from(unit));
    }
    return plan;
}

}  // namespace

std::string_view kind_name(UnitKind kind) {
    return kind == UnitKind::Reference ? "reference" : "combination";
}

std::size_t Plan::level_count() const {
    return static_cast<std::size_t>(std::ranges::count(units, UnitKind::Reference, &Unit::kind));
}

void write_plan(const fs::path& path, const Plan& plan) {
    Json units = Json::array();
    for (const Unit& unit : plan.units) {
        units.push_back(to_json(unit));
    }
    const Json json = {{"scene", plan.scene},
                       {"frames", plan.frames},
                       {"scene_frames", plan.scene_frames},
                       {"repeats", plan.repeats},
                       {"threads", plan.threads},
                       {"keep_runs", plan.keep_runs},
                       {"reference_integrator", plan.reference_integrator},
                       {"reference", plan.reference},
                       {"units", units}};
    // Paths may have bytes that are not UTF-8.
    write_text(path, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

Plan read_plan(const fs::path& folder) {
    const fs::path path = folder / kPlanFile;
    if (!fs::exists(path)) {
        throw Error(folder.string() + ": no study has been prepared here; run pent-study SCENE -o "
                    + folder.string() + " --vary ... --prepare first");
    }
    try {
        std::ifstream file(path);
        return plan_from(Json::parse(file));
    } catch (const nlohmann::json::exception& error) {
        throw Error(path.string() + ": not the plan of a study (" + error.what()
                    + "); run --prepare again, what has been run stays");
    }
}

}  // namespace pent::study
