#pragma once

#include "record/report_schema.h"

#include <pent/error.h>
#include <pent/simulator/words.h>

#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace pent::runs {

/// Reports of runs as JSON, by their schema. Reading throws a nlohmann::json::exception for what is
/// missing, has another type or is a count that is negative or not whole, and an Error for words
/// that are none.
using Json = nlohmann::ordered_json;

/// A visitor of the schema that writes the value of each key.
struct RecordWriter {
    using Field = simulator::Field;

    Json& json;

    template <typename Value>
    void operator()(const Field& field, const Value& value) const {
        Json entry = to_json(value);
        const bool is_empty = entry == "" || entry.is_null() || (entry.is_array() && entry.empty());
        if (!field.may_lack || !is_empty) {
            json[std::string(field.key)] = std::move(entry);
        }
    }

    static Json to_json(double value) { return std::isfinite(value) ? Json(value) : Json(); }
    static Json to_json(const std::string& text) { return text; }
    static Json to_json(const std::vector<NonRigidity>& bodies);
    static Json to_json(const simulator::Energies& energies);
    template <std::integral Value>
    static Json to_json(Value value) {
        return value;
    }
    template <typename Value>
    requires std::is_enum_v<Value>
    static Json to_json(Value value) { return simulator::word_of(value); }
    template <typename Part>
    static Json to_json(const std::vector<Part>& parts) {
        Json list = Json::array();
        for (const Part& part : parts) {
            list.push_back(to_json(part));
        }
        return list;
    }
    template <typename Part>
    requires std::is_class_v<Part>
    static Json to_json(const Part& part) {
        Json entry = Json::object();
        fields(part, RecordWriter{entry});
        return entry;
    }
};

/// A visitor of the schema that reads the value of each key.
struct RecordReader {
    using Field = simulator::Field;

    const Json& json;

    template <typename Value>
    void operator()(const Field& field, Value& value) const {
        const std::string key(field.key);
        if (!field.may_lack || json.contains(key)) {
            from_json(json.at(key), value);
        }
    }
    void operator()(const Field& field, simulator::Energies& energies) const;

    static void from_json(const Json& entry, double& value) {
        const bool is_infinite = entry.is_null() && std::isinf(value);  // as is its default
        value = is_infinite ? value : entry.get<double>();
    }
    static void from_json(const Json& entry, std::string& text) { entry.get_to(text); }
    static void from_json(const Json& entry, std::vector<NonRigidity>& bodies);
    static void from_json(const Json& entry, simulator::StepReport& step);
    template <std::integral Value>
    static void from_json(const Json& entry, Value& count) {
        // get_to() would round any number to a whole one.
        const auto found = entry.get_ref<const Json::number_unsigned_t&>();
        if (!std::in_range<Value>(found)) {
            throw Error("the number " + std::to_string(found) + " is too large");
        }
        count = static_cast<Value>(found);
    }
    template <typename Value>
    requires std::is_enum_v<Value>
    static void from_json(const Json& entry, Value& value) {
        const auto& word = entry.get_ref<const std::string&>();
        const std::optional<Value> known = simulator::value_of<Value>(word);
        if (!known) {
            throw Error("unknown word " + entry.dump());  // on one line, whatever is in it
        }
        value = *known;
    }
    template <typename Part>
    static void from_json(const Json& entry, std::vector<Part>& parts) {
        parts.clear();
        for (const Json& part : entry.get_ref<const Json::array_t&>()) {
            from_json(part, parts.emplace_back());
        }
    }
    template <typename Part>
    requires std::is_class_v<Part>
    static void from_json(const Json& entry, Part& part) { fields(part, RecordReader{entry}); }
};

/// A step, a frame, a part or a report of a run.
template <typename Part>
[[nodiscard]] Json write_record(const Part& part) {
    return RecordWriter::to_json(part);
}
template <typename Part>
[[nodiscard]] Part read_record(const Json& json) {
    Part part;
    RecordReader::from_json(json, part);
    return part;
}

}  // namespace pent::runs
