#include "record/run_report.h"

#include "record/run_json.h"

#include <pent/error.h>

#include <algorithm>

namespace pent::runs {

namespace {

Json body_json(const RunReport& report, std::size_t body) {
    double most = 0;
    for (const FrameReport& frame : report.frames) {
        most = std::max(most, frame.non_rigid[body]);
    }
    return {{"name", report.bodies[body]}, {"non_rigid_max", most}};
}

}  // namespace

std::string report_text(const RunReport& report) {
    const RunPart& last = report.parts.back();
    Json json;
    json["created_by"] = last.created_by;
    json["verdict"] = last.verdict;
    if (!report.message.empty()) {
        json["message"] = report.message;
    }
    if (!report.penetration.empty()) {
        json["penetration"] = report.penetration;
    }
    json["seconds"] = report.seconds;
    json["threads"] = last.threads;
    json["isa"] = last.isa;
    json["size"] = {{"vertices", report.size.vertices},
                    {"cells", report.size.cells},
                    {"free_vertices", report.size.free_vertices},
                    {"elements", report.size.elements},
                    {"matrix_blocks", report.size.matrix_blocks},
                    {"contact_bytes", report.size.contact_bytes},
                    {"bytes", report.size.bytes}};
    if (!report.warnings.empty()) {
        json["warnings"] = report.warnings;
    }
    json["parts"] = Json::array();
    for (const RunPart& part : report.parts) {
        json["parts"].push_back(part_json(part));
    }
    json["bodies"] = Json::array();
    for (std::size_t body = 0; body < report.bodies.size(); ++body) {
        json["bodies"].push_back(body_json(report, body));
    }
    json["frames"] = Json::array();
    for (const FrameReport& frame : report.frames) {
        json["frames"].push_back(frame_json(frame, report.bodies));
    }
    json["steps"] = Json::array();
    for (const StepReport& step : report.steps) {
        json["steps"].push_back(step_json(step));
    }
    // Messages name files, whose names may have bytes that are not UTF-8.
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

ReportHistory parse_history(const std::string& text,
                            const std::string& name,
                            const std::vector<std::string>& bodies) {
    ReportHistory history;
    try {
        const Json json = Json::parse(text);
        for (const Json& entry : json.at("frames")) {
            history.frames.push_back(parse_frame(entry, bodies));
        }
        for (const Json& entry : json.at("steps")) {
            history.steps.push_back(parse_step(entry));
        }
        history.part = {.created_by = json.value("created_by", ""),
                        .threads = json.value("threads", 1),
                        .isa = json.value("isa", ""),
                        .last_frame = history.frames.empty() ? 0 : history.frames.back().frame,
                        .seconds = json.value("seconds", 0.0),
                        .verdict = json.value("verdict", "")};
        if (history.part.verdict == "running") {
            history.part.verdict = "died";
        }
    } catch (const nlohmann::json::exception& error) {
        throw Error(name + ": not the report of a run (" + error.what()
                    + "); remove it or start again with --force");
    }
    return history;
}

}  // namespace pent::runs
