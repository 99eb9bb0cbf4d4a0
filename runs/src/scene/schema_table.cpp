#include "scene/schema_table.h"

#include "scene/presets.h"

#include <pent/runs/scene_file.h>
#include <pent/simulator/scene_schema.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

namespace pent::runs {

namespace {

using simulator::Field;

std::string in_code(std::string_view text) {
    return "`" + std::string(text) + "`";
}

std::string comma(const std::string& before, const std::string& after) {
    return before + (before.empty() || after.empty() ? "" : ", ") + after;
}

std::string range_text(const Range& range) {
    const bool has_low = std::isfinite(range.low);
    if (!has_low || std::abs(range.low) >= kMaxDegrees) {
        return "";
    }
    if (std::isfinite(range.high)) {
        return (range.low_included ? "in [" : "in (") + readable(range.low) + ", "
               + readable(range.high) + (range.high_included ? "]" : ")");
    }
    return (range.low_included ? ">= " : "> ") + readable(range.low);
}

std::string whole_text(const Range& range) {
    const auto low = static_cast<std::int64_t>(range.low);
    const auto high = static_cast<std::int64_t>(range.high);
    return std::to_string(low) + (high - low == 1 ? ", " : "..") + std::to_string(high);
}

std::string number_text(const Field& field) {
    return comma(comma("number", std::string(field.unit)), range_text(field.range));
}

template <typename Value>
std::string words_of() {
    std::string words;
    for (const std::string_view word : simulator::words<Value>()) {
        words = comma(words, in_code("\"" + std::string(word) + "\""));
    }
    return words;
}

// "{ center, radius }"
template <typename Part>
std::string keys_of(const Part& part) {
    std::string keys;
    simulator::fields(
        part, [&](const Field& field, const auto&) { keys = comma(keys, std::string(field.key)); });
    return "{ " + keys + " }";
}

// A visitor of the schema that collects rows, of a part with every default.
struct RowCollector {
    std::vector<SchemaRow>& rows;
    std::string block;
    std::string prefix = {};
    bool is_within = false;

    void operator()(const Field& field, double value) const {
        const double standard = field.fallback.value_or(value);
        add(field, number_text(field), std::isfinite(standard) ? readable(standard) : "none");
    }
    void operator()(const Field& field, bool value) const {
        add(field, "true or false", value ? "true" : "false");
    }
    void operator()(const Field& field, const std::string& /*text*/) const {
        add(field, "text", "none");
    }
    void operator()(const Field& field, const Eigen::VectorXd& /*value*/) const {
        add(field, comma("vector", std::string(field.unit)), "zero");
    }
    void operator()(const Field& field, const std::optional<Eigen::VectorXd>& /*value*/) const {
        add(field, comma("vector", std::string(field.unit)), "none");
    }
    void operator()(const Field& field, const simulator::Plane& plane) const {
        add(field, "two axes", in_code("\"" + simulator::plane_name(plane) + "\""));
    }
    void operator()(const Field& field, const std::vector<Selection>& /*select*/) const {
        add(field, "a selection, or a list of them", "none");
        add_kinds(field, std::make_index_sequence<std::variant_size_v<Selection>>());
    }
    void operator()(const Field& field, const std::vector<Motion>& /*motion*/) const {
        add(field, "a table, or a list of them",
            in_code("\"" + std::string(simulator::kFixed) + "\""));
        (*this)(field, Motion());
    }
    void operator()(const Field& /*field*/, const simulator::Lame& /*lame*/) const {
        for (const Field& one : simulator::kLamePairs) {
            add(one, number_text(one), one.fallback ? readable(*one.fallback) : "");
        }
    }
    void operator()(const Field& field, const ObstacleShape& /*shape*/) const {
        for (const ObstacleShape& shape : all_shapes(3)) {
            std::visit(
                [&](const auto& one) {
                    const std::string key = std::string(one.kName) + " = " + keys_of(one);
                    add(simulator::key(key).default_is("one of the shapes"),
                        comma("table", std::string(field.unit)), "");
                    add_within(std::string(one.kName) + ".", one);
                },
                shape);
        }
    }
    template <std::integral Value>
    void operator()(const Field& field, Value value) const {
        add(field, comma("integer", whole_text(field.range)), std::to_string(value));
    }
    template <typename Value>
    requires std::is_enum_v<Value>
    void operator()(const Field& field, Value value) const {
        add(field, words_of<Value>(),
            in_code("\"" + std::string(simulator::word_of(value)) + "\""));
    }
    template <typename Value>
    requires std::is_enum_v<Value>
    void operator()(const Field& field, const std::vector<Value>& /*values*/) const {
        add(field, "list of " + words_of<Value>(), "none");
    }
    template <typename Part>
    void operator()(const Field& field, const std::vector<Part>& /*parts*/) const {
        add(field, "list of " + in_code(keys_of(Part())), "none");
        add_within(std::string(field.key) + ".", Part());
    }
    template <typename Part>
    requires std::is_class_v<Part>
    void operator()(const Field& field, const Part& part) const {
        simulator::fields(
            part, RowCollector{rows, block, prefix + std::string(field.key) + ".", is_within});
    }

private:
    template <typename Part>
    void add_within(const std::string& path, const Part& part) const {
        simulator::fields(part, RowCollector{rows, block, prefix + path, true});
    }
    template <std::size_t... Kind>
    void add_kinds(const Field& field, std::index_sequence<Kind...> /*kinds*/) const {
        const std::string path = std::string(field.key) + ".";
        const auto add_kind = [&](std::string_view name, const auto& selection) {
            using Type = std::remove_cvref_t<decltype(selection)>;
            const bool is_inline = std::is_same_v<Type, simulator::RegionSelection>;
            add_within(path + (is_inline ? "" : std::string(name) + "."), selection);
        };
        (add_kind(simulator::kSelectionNames[Kind], std::variant_alternative_t<Kind, Selection>()),
         ...);
    }
    void add(const Field& field, const std::string& values, const std::string& standard) const {
        std::string said(field.default_says);
        said = field.is_required ? "required" : said.empty() ? standard : said;
        const std::string with = field.goes_with.empty() ? "" : "with " + in_code(field.goes_with);
        rows.push_back({.block = block,
                        .key = prefix + std::string(field.key),
                        .values = values,
                        .standard = said,
                        .says = comma(with, std::string(field.says)),
                        .is_within = is_within});
    }
};

struct BlockCollector {
    std::vector<SchemaRow>& rows;

    template <typename Part>
    void operator()(std::string_view name, const std::vector<Part>& /*parts*/) const {
        const Part part;
        simulator::fields(part, RowCollector{rows, "[[" + std::string(name) + "]]"});
    }
    template <typename Part>
    void operator()(std::string_view name, const std::optional<Part>& /*part*/) const {
        (*this)(name, Part());
    }
    template <typename Part>
    void operator()(std::string_view name, const Part& part) const {
        const RowCollector collector{rows, "[" + std::string(name) + "]"};
        if constexpr (std::is_same_v<Part, SolverOptions>) {
            collector(kPreset, Preset::Balanced);
        }
        simulator::fields(part, collector);
        if constexpr (std::is_same_v<Part, simulator::Output>) {
            RowCollector{rows, collector.block, "", true}(kContactForces, false);
        }
    }
};

// "", "place" of [[body]] or [contact]: the table that has a key, which may be one around those
// of the row, as `select` and `layers` are around `first`.
std::string owner_of(const SchemaRow& row, const std::string& key) {
    const std::string path = "." + row.key.substr(0, row.key.find(' ')) + ".";
    const auto found = path.find("." + key + ".");
    if (key.empty() || found == std::string::npos) {
        return "";
    }
    return (found == 0 ? "" : "\"" + path.substr(1, found - 1) + "\" of ") + row.block;
}

// "[sleep]" for the name of a block, "" for other keys.
std::string block_of(const SchemaRow& row, const std::string& key) {
    const std::string name = row.block.substr(row.block.find_last_of('[') + 1);
    return name.substr(0, name.find(']')) == key ? row.block : "";
}

// All that these have of a key, each once: "[a] or [b]".
template <typename Owner>
std::string join_owners(const std::string& key, const Owner& owner_in) {
    std::vector<std::string> owners;
    std::string text;
    for (const SchemaRow& row : schema_rows()) {
        const std::string owner = owner_in(row, key);
        if (!owner.empty() && std::find(owners.begin(), owners.end(), owner) == owners.end()) {
            owners.push_back(owner);
            text += (text.empty() ? "" : " or ") + owner;
        }
    }
    return text;
}

}  // namespace

std::vector<SchemaRow> schema_rows() {
    std::vector<SchemaRow> rows;
    const Scene scene;
    simulator::fields(scene, RowCollector{rows, "[scene]"});
    simulator::blocks(scene, BlockCollector{rows});
    return rows;
}

std::string owners_text(const std::string& key) {
    const std::string owners = join_owners(key, owner_of);
    if (!owners.empty()) {
        return "\"" + key + "\" belongs to " + owners;
    }
    const std::string block = join_owners(key, block_of);
    return block.empty() ? "" : "\"" + key + "\" is a block of its own, " + block;
}

std::string schema_text() {
    std::string text;
    std::string block;
    for (const SchemaRow& row : schema_rows()) {
        if (row.is_within) {
            continue;
        }
        if (row.block != block) {
            text += (block.empty() ? "**" : "\n**") + row.block
                    + "**\n\n| key | value | default | |\n| --- | --- | --- | --- |\n";
            block = row.block;
        }
        text += "| " + in_code(row.key) + " | " + row.values + " | " + row.standard + " | "
                + row.says + " |\n";
    }
    return text;
}

}  // namespace pent::runs
