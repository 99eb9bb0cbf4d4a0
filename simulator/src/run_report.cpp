#include "run_report.h"

#include <pent/error.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace pent::simulator {

namespace {

using Json = nlohmann::ordered_json;

Json contact_json(const ContactSummary& contact) {
    Json smallest;  // null where nothing touches
    if (std::isfinite(contact.smallest_distance)) {
        smallest = contact.smallest_distance;
    }
    return {{"point_facet", contact.point_facet},
            {"mixed", contact.mixed},
            {"self", contact.self},
            {"obstacle", contact.obstacle},
            {"deepest", contact.deepest},
            {"smallest_distance", smallest},
            {"searches", contact.searches},
            {"candidates", contact.candidates},
            {"obstacle_tests", contact.obstacle_tests},
            {"friction", contact.friction},
            {"trees_built", contact.trees_built},
            {"trees_refit", contact.trees_refit},
            {"ccd_seconds", contact.ccd_seconds},
            {"stiffness", contact.stiffness},
            {"seconds", contact.seconds}};
}

// A count: whole and not negative, where get_to() would round any number to one.
template <typename Count>
void read_count(const Json& json, const char* key, Count& count) {
    count = static_cast<Count>(json.at(key).get_ref<const Json::number_unsigned_t&>());
}

ContactSummary parse_contact(const Json& json) {
    ContactSummary contact;
    read_count(json, "point_facet", contact.point_facet);
    read_count(json, "mixed", contact.mixed);
    read_count(json, "self", contact.self);
    read_count(json, "obstacle", contact.obstacle);
    json.at("deepest").get_to(contact.deepest);
    if (!json.at("smallest_distance").is_null()) {
        json.at("smallest_distance").get_to(contact.smallest_distance);
    }
    read_count(json, "searches", contact.searches);
    read_count(json, "candidates", contact.candidates);
    read_count(json, "obstacle_tests", contact.obstacle_tests);
    read_count(json, "friction", contact.friction);
    read_count(json, "trees_built", contact.trees_built);
    read_count(json, "trees_refit", contact.trees_refit);
    json.at("ccd_seconds").get_to(contact.ccd_seconds);
    json.at("stiffness").get_to(contact.stiffness);
    json.at("seconds").get_to(contact.seconds);
    return contact;
}

Json step_json(const StepReport& step) {
    return {{"step", step.step},
            {"time", step.time},
            {"substeps", step.substeps},
            {"refused", step.refused},
            {"failure", step.failure},
            {"newton_iterations", step.newton_iterations},
            {"iterations", step.iterations},
            {"asleep", step.asleep},
            {"unknowns", step.unknowns},
            {"hessians", step.hessians},
            {"filtered", step.filtered},
            {"damping_hessians", step.damping_hessians},
            {"residual", step.residual},
            {"unbalanced", step.unbalanced},
            {"inverted", step.inverted},
            {"collapsed", step.collapsed},
            {"kinetic", step.energies.kinetic},
            {"elastic", step.energies.elastic},
            {"gravity", step.energies.gravity},
            {"obstacle", step.energies.obstacle},
            {"contact_energy", step.energies.contact},
            {"contact", contact_json(step.contact)},
            {"assembly_seconds", step.assembly_seconds},
            {"solve_seconds", step.solve_seconds},
            {"seconds", step.seconds}};
}

StepReport parse_step(const Json& json) {
    StepReport step;
    step.is_accepted = true;
    read_count(json, "step", step.step);
    json.at("time").get_to(step.time);
    read_count(json, "substeps", step.substeps);
    read_count(json, "refused", step.refused);
    json.at("failure").get_to(step.failure);
    read_count(json, "newton_iterations", step.newton_iterations);
    read_count(json, "iterations", step.iterations);
    read_count(json, "asleep", step.asleep);
    read_count(json, "unknowns", step.unknowns);
    read_count(json, "hessians", step.hessians);
    read_count(json, "filtered", step.filtered);
    read_count(json, "damping_hessians", step.damping_hessians);
    json.at("residual").get_to(step.residual);
    json.at("unbalanced").get_to(step.unbalanced);
    read_count(json, "inverted", step.inverted);
    read_count(json, "collapsed", step.collapsed);
    json.at("kinetic").get_to(step.energies.kinetic);
    json.at("elastic").get_to(step.energies.elastic);
    json.at("gravity").get_to(step.energies.gravity);
    json.at("obstacle").get_to(step.energies.obstacle);
    json.at("contact_energy").get_to(step.energies.contact);
    step.contact = parse_contact(json.at("contact"));
    json.at("assembly_seconds").get_to(step.assembly_seconds);
    json.at("solve_seconds").get_to(step.solve_seconds);
    json.at("seconds").get_to(step.seconds);
    return step;
}

Json frame_json(const FrameReport& frame, const std::vector<std::string>& bodies) {
    Json non_rigid = Json::object();
    for (std::size_t body = 0; body < bodies.size(); ++body) {
        non_rigid[bodies[body]] = frame.non_rigid[body];
    }
    return {{"frame", frame.frame},
            {"step", frame.step},
            {"time", frame.time},
            {"non_rigid", non_rigid}};
}

Json body_json(const RunReport& report, std::size_t body) {
    double most = 0;
    for (const FrameReport& frame : report.frames) {
        most = std::max(most, frame.non_rigid[body]);
    }
    return {{"name", report.bodies[body]}, {"non_rigid_max", most}};
}

}  // namespace

std::string report_text(const RunReport& report,
                        std::string_view verdict,
                        const std::string& created_by,
                        int threads) {
    Json json;
    json["created_by"] = created_by;
    json["verdict"] = verdict;
    if (!report.message.empty()) {
        json["message"] = report.message;
    }
    json["seconds"] = report.seconds;
    json["threads"] = threads;
    json["isa"] = report.isa;
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
                            const std::vector<std::string>& bodies,
                            int last_frame,
                            std::uint64_t last_step) {
    ReportHistory history;
    try {
        const Json json = Json::parse(text);
        for (const Json& entry : json.at("frames")) {
            FrameReport frame;
            read_count(entry, "frame", frame.frame);
            read_count(entry, "step", frame.step);
            entry.at("time").get_to(frame.time);
            for (const std::string& body : bodies) {
                frame.non_rigid.push_back(entry.at("non_rigid").at(body).get<double>());
            }
            if (frame.frame <= last_frame) {
                history.frames.push_back(std::move(frame));
            }
        }
        for (const Json& entry : json.at("steps")) {
            StepReport step = parse_step(entry);
            if (step.step <= last_step) {
                history.steps.push_back(step);
            }
        }
    } catch (const nlohmann::json::exception& error) {
        throw Error(name + ": not the report of a run (" + error.what()
                    + "); remove it or start again with --force");
    }
    return history;
}

}  // namespace pent::simulator
