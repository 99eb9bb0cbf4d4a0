#include "record.h"

#include "frontier.h"
#include "json_count.h"

#include <pent/csv_field.h>
#include <pent/error.h>
#include <pent/output_file.h>
#include <pent/read_text.h>

#include <fstream>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

namespace pent::study {

namespace {

using Json = nlohmann::ordered_json;
using simulator::word_of;

// Paths may have bytes that are not UTF-8.
std::string text_of(const Json& json) {
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json to_json(const Errors& errors) {
    return {{"position", errors.position},
            {"position_m", errors.position_m},
            {"center", errors.center},
            {"energy", errors.energy},
            {"contact_work", errors.contact_work},
            {"energy_drift", errors.energy_drift},
            {"angular_momentum", errors.angular_momentum},
            {"angular_momentum_scale", errors.angular_momentum_scale},
            {"smallest_J", errors.smallest_J},
            {"deepest_penetration", errors.deepest_penetration},
            {"iterations", errors.iterations},
            {"newton_iterations", errors.newton_iterations},
            {"refused", errors.refused}};
}

Errors errors_from(const Json& json) {
    Errors errors;
    json.at("position").get_to(errors.position);
    json.at("position_m").get_to(errors.position_m);
    json.at("center").get_to(errors.center);
    json.at("energy").get_to(errors.energy);
    json.at("contact_work").get_to(errors.contact_work);
    json.at("energy_drift").get_to(errors.energy_drift);
    json.at("angular_momentum").get_to(errors.angular_momentum);
    json.at("angular_momentum_scale").get_to(errors.angular_momentum_scale);
    json.at("smallest_J").get_to(errors.smallest_J);
    json.at("deepest_penetration").get_to(errors.deepest_penetration);
    errors.iterations = count_of(json.at("iterations"));
    errors.newton_iterations = count_of(json.at("newton_iterations"));
    errors.refused = count_of(json.at("refused"));
    return errors;
}

Json to_json(const Cost& cost) {
    return {{"wall_seconds", cost.wall_seconds},
            {"cpu_seconds", cost.cpu_seconds},
            {"peak_bytes", cost.peak_bytes},
            {"seconds_per_frame", cost.seconds_per_frame}};
}

Json to_json(const Settings& settings) {
    Json json = Json::object();
    for (const Setting& setting : settings) {
        json[setting.axis] = setting.value;
    }
    return json;
}

Json to_json(const std::vector<Machine>& machines) {
    Json json = Json::array();
    for (const Machine& machine : machines) {
        json.push_back({{"node", machine.node}, {"processor", machine.processor}});
    }
    return json;
}

std::vector<Machine> machines_from(const Json& json) {
    std::vector<Machine> machines;
    for (const Json& machine : json) {
        machines.push_back({.node = machine.at("node"), .processor = machine.at("processor")});
    }
    return machines;
}

UnitVerdict verdict_from(const Json& json) {
    const auto verdict = simulator::value_of<UnitVerdict>(json.get_ref<const std::string&>());
    if (!verdict) {
        throw Error("unknown verdict " + json.dump());
    }
    return *verdict;
}

Json to_json(const ReferenceReport& reference) {
    return {{"dt", reference.dt},
            {"difference", reference.difference},
            {"last", to_json(reference.last)},
            {"order", reference.order},
            {"error_bar", reference.error_bar},
            {"is_converged", reference.is_converged},
            {"window", reference.window},
            {"has_contact", reference.has_contact},
            {"cost", to_json(reference.cost)}};
}

}  // namespace

Cost cost_of(const Record& record, int frames) {
    Cost cost;
    cost.wall_seconds = median(record.wall_seconds);
    cost.cpu_seconds = median(record.cpu_seconds);
    cost.peak_bytes = median(record.peak_bytes);
    cost.seconds_per_frame = cost.wall_seconds / frames;
    return cost;
}

std::string read_text(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored) ? pent::read_text(path, "a file of a study") : "";
}

std::string fingerprint(const std::filesystem::path& program) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char byte : read_text(program)) {
        hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
    }
    std::ostringstream text;
    text << std::hex << std::setw(16) << std::setfill('0') << hash;
    return text.str();
}

void write_record(const std::filesystem::path& path, const Record& record) {
    const Json json = {
        {"verdict", word_of(record.verdict)},  {"message", record.message},
        {"wall_seconds", record.wall_seconds}, {"cpu_seconds", record.cpu_seconds},
        {"peak_bytes", record.peak_bytes},     {"machines", to_json(record.machines)},
        {"errors", to_json(record.errors)},    {"meshes", record.meshes},
        {"threads", record.threads},           {"scene", record.scene},
        {"reference", record.reference}};
    write_text(path, text_of(json));
}

std::optional<Record> read_record(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) {
        return std::nullopt;
    }
    try {
        std::ifstream file(path);
        const Json json = Json::parse(file);
        Record record;
        record.verdict = verdict_from(json.at("verdict"));
        json.at("message").get_to(record.message);
        json.at("wall_seconds").get_to(record.wall_seconds);
        json.at("cpu_seconds").get_to(record.cpu_seconds);
        json.at("peak_bytes").get_to(record.peak_bytes);
        record.machines = machines_from(json.at("machines"));
        record.meshes = static_cast<std::uint32_t>(count_of(json.at("meshes")));
        record.threads = json.value("threads", 0);  // not in those of older versions
        json.at("scene").get_to(record.scene);
        json.at("reference").get_to(record.reference);
        record.errors = errors_from(json.at("errors"));
        return record;
    } catch (const std::exception& error) {
        throw Error(path.string() + ": not the record of a run (" + error.what()
                    + "); remove it, and the run is taken again");
    }
}

std::string study_json(const StudyReport& report, const std::string& created_by) {
    Json json;
    json["created_by"] = created_by;
    json["scene"] = report.scene;
    json["frames"] = report.frames;
    json["vertices"] = report.vertices;
    json["cells"] = report.cells;
    json["threads"] = report.threads;
    json["reference"] = to_json(report.reference);
    json["results"] = Json::array();
    for (const Result& result : report.results) {
        json["results"].push_back({{"settings", to_json(result.settings)},
                                   {"verdict", word_of(result.verdict)},
                                   {"message", result.message},
                                   {"cost", to_json(result.cost)},
                                   {"errors", to_json(result.errors)}});
    }
    json["frontier"] = report.frontier;
    json["sentences"] = report.sentences;
    json["warnings"] = report.warnings;
    return text_of(json);
}

std::string study_csv(const StudyReport& report) {
    std::ostringstream csv;
    csv.precision(9);
    for (const Setting& setting : report.results.front().settings) {
        csv << setting.axis << ',';
    }
    csv << "verdict,wall_seconds,cpu_seconds,peak_bytes,seconds_per_frame,position_error,"
           "position_error_m,center_error,energy_error,contact_work_error,energy_drift_J,"
           "angular_momentum_error,smallest_J,deepest_penetration_m,iterations,"
           "newton_iterations,refused,is_on_frontier\n";
    for (std::size_t i = 0; i < report.results.size(); ++i) {
        const Result& result = report.results[i];
        const Errors& errors = result.errors;
        for (const Setting& setting : result.settings) {
            csv << csv_field(setting.value) << ',';
        }
        double twist = 0;
        for (const double plane : errors.angular_momentum) {
            twist = std::max(twist, plane);
        }
        const bool is_on_frontier = std::ranges::find(report.frontier, i) != report.frontier.end();
        csv << word_of(result.verdict) << ',' << result.cost.wall_seconds << ','
            << result.cost.cpu_seconds << ',' << result.cost.peak_bytes << ','
            << result.cost.seconds_per_frame << ',' << errors.position << ',' << errors.position_m
            << ',' << errors.center << ',' << errors.energy << ',' << errors.contact_work << ','
            << errors.energy_drift << ','
            << (errors.angular_momentum_scale > 0 ? twist / errors.angular_momentum_scale : twist)
            << ',' << errors.smallest_J << ',' << errors.deepest_penetration << ','
            << errors.iterations << ',' << errors.newton_iterations << ',' << errors.refused << ','
            << (is_on_frontier ? 1 : 0) << '\n';
    }
    return csv.str();
}

}  // namespace pent::study
