#pragma once

#include "scene/schema_table.h"
#include "simulator_names.h"

#include <pent/simulator/scene_checks.h>
#include <pent/simulator/scene_schema.h>
#include <pent/simulator/words.h>
#include <pent/toml_table.h>

#include <algorithm>
#include <concepts>
#include <type_traits>
#include <vector>

namespace pent::runs {

template <typename Part>
void read_part(TableReader& table, Part& part, const int& dimension);

/// A visitor of the schema that reads the value of each key from a table. What is missing keeps the
/// default of its member; vectors are zero. Throws an Error with file:line:column.
struct PartReader {
    using Field = simulator::Field;

    TableReader& table;
    const int& dimension;  ///< Of the scene, which is the first key to be read.

    void operator()(const Field& field, double& value) const {
        value = field.is_required
                    ? table.number(field.key, {}, field.range)
                    : table.number(field.key, field.fallback.value_or(value), field.range);
    }
    void operator()(const Field& field, bool& value) const { value = table.flag(field.key, value); }
    void operator()(const Field& field, std::string& value) const {
        value = field.is_required || table.has(field.key) ? table.text(field.key) : value;
    }
    void operator()(const Field& field, Eigen::VectorXd& value) const;
    void operator()(const Field& field, std::optional<Eigen::VectorXd>& value) const;
    void operator()(const Field& field, Plane& plane) const;
    void operator()(const Field& field, simulator::Lame& lame) const;
    void operator()(const Field& field, std::vector<Selection>& select) const;
    void operator()(const Field& field, std::vector<Motion>& motion) const;
    void read_shape(ObstacleShape& shape) const;

    template <std::integral Value>
    void operator()(const Field& field, Value& value) const {
        std::optional<std::int64_t> fallback;
        if (!field.is_required) {
            fallback = field.fallback ? static_cast<std::int64_t>(*field.fallback) : value;
        }
        value = static_cast<Value>(table.integer(field.key, fallback,
                                                 static_cast<std::int64_t>(field.range.low),
                                                 static_cast<std::int64_t>(field.range.high)));
    }
    template <typename Value>
    requires std::is_enum_v<Value>
    void operator()(const Field& field, Value& value) const {
        value = simulator::kWords<Value>[table.choice(field.key, simulator::words<Value>(),
                                                      simulator::place_of(value))]
                    .value;
    }
    template <typename Value>
    requires std::is_enum_v<Value>
    void operator()(const Field& field, std::vector<Value>& values) const {
        for (const std::size_t place : table.choices(field.key, simulator::words<Value>())) {
            const Value value = simulator::kWords<Value>[place].value;
            if (std::find(values.begin(), values.end(), value) == values.end()) {
                values.push_back(value);
            }
        }
    }
    template <typename Part>
    void operator()(const Field& field, std::vector<Part>& parts) const {
        for (TableReader& entry : table.tables(field.key)) {
            Part& part = parts.emplace_back();
            read_part(entry, part, dimension);
            if constexpr (requires { part.source; }) {
                part.source = entry.place("select");
            }
        }
    }
    template <typename Part>
    requires std::is_class_v<Part>
    void operator()(const Field& field, Part& part) const {
        static const toml::table kEmpty;  // a part that is not there has its defaults
        TableReader inner = table.has(field.key) ? table.table(field.key)
                                                 : TableReader(kEmpty, std::string(field.key), "");
        read_part(inner, part, dimension);
    }
};

/// A visitor that makes the keys known to a table before any of them is read.
struct KeyFinder {
    TableReader& table;

    template <typename Value>
    void operator()(const simulator::Field& field, const Value& /*value*/) const {
        static_cast<void>(table.has(field.key));
    }
    void operator()(const simulator::Field& /*field*/, const simulator::Lame& /*lame*/) const {
        for (const auto& field : simulator::kLamePairs) {
            static_cast<void>(table.has(field.key));
        }
    }
    void operator()(const simulator::Field& /*field*/, const ObstacleShape& /*shape*/) const {}
};

/// Throws an Error for a key that is there though those before it say that it does not apply.
inline void refuse_if_idle(TableReader& table, const simulator::Field& field) {
    if (!field.does_apply) {
        table.refuse(field.key, "goes with " + std::string(field.goes_with) + " alone");
    }
}

/// Reads all keys of a part and refuses others.
template <typename Part>
void read_part(TableReader& table, Part& part, const int& dimension) {
    simulator::fields(part, KeyFinder{table});
    const PartReader reader{table, dimension};
    simulator::fields(part, [&](const simulator::Field& field, auto& value) {
        refuse_if_idle(table, field);
        if constexpr (!std::is_same_v<decltype(value), ObstacleShape&>) {
            if (field.does_apply) {
                reader(field, value);
            }
        }
    });
    if constexpr (std::is_same_v<Part, Obstacle>) {
        reader.read_shape(part.shape);  // last: of the keys that are left, one is its name
    }
    table.finish([](const std::string& key) { return owners_text(key); });
    if (const auto fault = simulator::fault_of(part)) {
        table.fail(fault->key, fault->message);
    }
}

}  // namespace pent::runs
