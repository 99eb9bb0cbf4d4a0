#include "record/run_json.h"

#include <cmath>

namespace pent::runs {

namespace {

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

}  // namespace

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
            {"elastic", step.energies.of("elastic")},
            {"gravity", step.energies.of("gravity")},
            {"obstacle", step.energies.of("obstacle")},
            {"contact_energy", step.energies.of("contact")},
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
    step.energies.terms = {{"elastic", json.at("elastic")},
                           {"gravity", json.at("gravity")},
                           {"obstacle", json.at("obstacle")},
                           {"contact", json.at("contact_energy")}};
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

FrameReport parse_frame(const Json& json, const std::vector<std::string>& bodies) {
    FrameReport frame;
    read_count(json, "frame", frame.frame);
    read_count(json, "step", frame.step);
    json.at("time").get_to(frame.time);
    for (const std::string& body : bodies) {
        frame.non_rigid.push_back(json.at("non_rigid").at(body).get<double>());
    }
    return frame;
}

Json part_json(const RunPart& part) {
    return {{"created_by", part.created_by},
            {"threads", part.threads},
            {"isa", part.isa},
            {"first_frame", part.first_frame},
            {"last_frame", part.last_frame},
            {"seconds", part.seconds},
            {"verdict", part.verdict}};
}

RunPart parse_part(const Json& json) {
    RunPart part;
    json.at("created_by").get_to(part.created_by);
    read_count(json, "threads", part.threads);
    json.at("isa").get_to(part.isa);
    read_count(json, "first_frame", part.first_frame);
    read_count(json, "last_frame", part.last_frame);
    json.at("seconds").get_to(part.seconds);
    json.at("verdict").get_to(part.verdict);
    return part;
}

}  // namespace pent::runs
