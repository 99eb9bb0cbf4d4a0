#include "record/json_record.h"

namespace pent::runs {

Json RecordWriter::to_json(const std::vector<NonRigidity>& bodies) {
    Json entry = Json::object();
    for (const NonRigidity& body : bodies) {
        entry[body.body] = body.value;
    }
    return entry;
}

Json RecordWriter::to_json(const simulator::Energies& energies) {
    Json entry = {{"kinetic", energies.kinetic}};
    for (const simulator::TermEnergy& term : energies.terms) {
        if (term.is_stored) {
            entry[term.name] = term.energy;
        }
    }
    return entry;
}

void RecordReader::from_json(const Json& entry, std::vector<NonRigidity>& bodies) {
    bodies.clear();
    for (const auto& [name, value] : entry.get_ref<const Json::object_t&>()) {
        bodies.push_back({.body = name, .value = value.get<double>()});
    }
}

// Steps that were not accepted are in no report.
void RecordReader::from_json(const Json& entry, simulator::StepReport& step) {
    fields(step, RecordReader{entry});
    step.is_accepted = true;
}

void RecordReader::operator()(const Field& field, simulator::Energies& energies) const {
    const std::string key(field.key);
    if (!json.contains(key)) {  // as version 0.1.0 had it
        energies = {.kinetic = json.at("kinetic"),
                    .terms = {{"elastic", json.at("elastic")},
                              {"gravity", json.at("gravity")},
                              {"obstacle", json.at("obstacle")},
                              {"contact", json.at("contact_energy")}}};
        return;
    }
    for (const auto& [name, value] : json.at(key).get_ref<const Json::object_t&>()) {
        if (name == "kinetic") {
            energies.kinetic = value.get<double>();
        } else {
            energies.terms.push_back({name, value.get<double>()});
        }
    }
}

}  // namespace pent::runs
