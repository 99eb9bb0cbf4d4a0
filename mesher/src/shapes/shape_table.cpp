#include "shape_table.h"

#include <pent/error.h>
#include <pent/nearest_name.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace pent::mesher {

namespace {

std::string at(const std::string& file, const toml::source_position& position) {
    return file + ":" + std::to_string(position.line) + ":" + std::to_string(position.column)
           + ": ";
}

std::string quoted(std::string_view word) {
    return "\"" + std::string(word) + "\"";
}

// A message may quote what it found, and that may be the end of a line.
std::string one_line(std::string_view text) {
    std::string line(text);
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < ' '; }, ' ');
    return line;
}

std::string described(const toml::node& node) {
    if (const auto* text = node.as_string()) {
        return "the text " + quoted(one_line(text->get()));
    }
    if (const std::optional<double> number = node.value<double>(); number && node.is_number()) {
        std::ostringstream text;
        text << *number;
        return text.str();
    }
    return node.is_table()     ? "a table"
           : node.is_array()   ? "a list"
           : node.is_boolean() ? (node.as_boolean()->get() ? "true" : "false")
                               : "a date or time";
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
    const std::string best = nearest_name(word, candidates);
    return best.empty() ? "" : "; did you mean " + quoted(best) + "?";
}

bool is_finite_number(const toml::node& node) {
    const std::optional<double> value = node.value<double>();
    return node.is_number() && value && std::isfinite(*value);
}

}  // namespace

toml::table parse_shapes(std::string_view text, const std::string& file) {
    try {
        toml::parse_result result = toml::parse(text);
        if (!result) {
            throw Error(at(file, result.error().source().begin)
                        + one_line(result.error().description()));
        }
        return std::move(result).table();
    } catch (const BrokenToml&) {
        throw Error(file
                    + ": is not TOML; expected lines of the form key = value and [[shape]] lines");
    }
}

ShapeTable::ShapeTable(const toml::table& table, std::string name, std::string file)
    : table_(&table), name_(std::move(name)), file_(std::move(file)) {}

const toml::node* ShapeTable::find(std::string_view key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
        known_.emplace_back(key);
    }
    return table_->get(key);
}

const toml::node& ShapeTable::need(std::string_view key, std::string_view type) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        std::string unknown;
        for (const auto& [present, value] : *table_) {
            const bool is_known =
                std::find(known_.begin(), known_.end(), present.str()) != known_.end();
            unknown = unknown.empty() && !is_known ? std::string(present.str()) : unknown;
        }
        fail("", quoted(name_) + " needs " + quoted(key) + " (" + std::string(type) + ")"
                     + (unknown.empty() ? "" : "; found the unknown key " + quoted(unknown)));
    }
    return *node;
}

bool ShapeTable::has(std::string_view key) {
    return find(key) != nullptr;
}

double ShapeTable::number(std::string_view key, std::optional<double> fallback) {
    if (fallback && !has(key)) {
        return *fallback;
    }
    const toml::node& node = need(key, "a number");
    if (!is_finite_number(node)) {
        fail(key, quoted(key) + " is " + described(node) + "; expected a number");
    }
    return *node.value<double>();
}

int ShapeTable::integer(std::string_view key) {
    const toml::node& node = need(key, "a whole number");
    const std::optional<std::int64_t> value = node.value<std::int64_t>();
    if (!node.is_integer() || !value || std::abs(*value) > std::numeric_limits<int>::max()) {
        fail(key, quoted(key) + " is " + described(node) + "; expected a whole number");
    }
    return static_cast<int>(*value);
}

std::string ShapeTable::text(std::string_view key) {
    const toml::node& node = need(key, "text");
    if (!node.is_string()) {
        fail(key, quoted(key) + " is " + described(node) + "; expected text in quotes");
    }
    return node.as_string()->get();
}

Eigen::VectorXd ShapeTable::vector(std::string_view key, int length) {
    const std::string expected = std::to_string(length) + " numbers in brackets";
    const toml::node& node = need(key, expected);
    const toml::array* array = node.as_array();
    if (array == nullptr) {
        fail(key, quoted(key) + " is " + described(node) + "; expected " + expected);
    }
    if (array->size() != static_cast<std::size_t>(length)) {
        fail(key, quoted(key) + " has " + std::to_string(array->size()) + " entries; expected "
                      + expected);
    }
    Eigen::VectorXd vector(length);
    for (int i = 0; i < length; ++i) {
        const toml::node& entry = *array->get(static_cast<std::size_t>(i));
        if (!is_finite_number(entry)) {
            fail(key,
                 quoted(key) + " has the entry " + described(entry) + "; expected " + expected);
        }
        vector[i] = *entry.value<double>();
    }
    return vector;
}

std::string ShapeTable::choice(std::string_view key, const std::vector<std::string>& names) {
    if (!has(key)) {
        return names.front();
    }
    std::string value = text(key);
    if (std::find(names.begin(), names.end(), value) == names.end()) {
        std::string list;
        for (const std::string& name : names) {
            list += (list.empty() ? "" : ", ") + quoted(name);
        }
        fail(key, quoted(key) + " is " + quoted(one_line(value)) + "; expected one of " + list
                      + did_you_mean(value, names));
    }
    return value;
}

ShapeTable ShapeTable::table(std::string_view key) {
    const toml::node& node = need(key, "a table");
    if (!node.is_table()) {
        fail(key, quoted(key) + " is " + described(node) + "; expected a table, { ... }");
    }
    return {*node.as_table(), std::string(key), file_};
}

std::vector<ShapeTable> ShapeTable::tables(std::string_view key) {
    std::vector<ShapeTable> result;
    if (!has(key)) {
        return result;
    }
    const toml::node& node = *find(key);
    if (!node.is_array()) {
        fail(key, quoted(key) + " is " + described(node) + "; expected a list of tables");
    }
    for (const toml::node& entry : *node.as_array()) {
        if (!entry.is_table()) {
            fail(key, quoted(key) + " has the entry " + described(entry) + "; expected a table");
        }
        result.emplace_back(*entry.as_table(), std::string(key), file_);
    }
    return result;
}

std::string ShapeTable::one_of(const std::vector<std::string>& kinds) {
    std::string found;
    std::string list;
    int count = 0;
    for (const std::string& kind : kinds) {
        list += (list.empty() ? "" : ", ") + kind;
        if (has(kind)) {
            found = kind;
            ++count;
        }
    }
    if (count != 1) {
        finish();  // a misspelled kind is the better thing to name
        fail("",
             quoted(name_) + " has " + std::to_string(count) + " of " + list + "; expected one");
    }
    return found;
}

void ShapeTable::finish() const {
    for (const auto& [key, node] : *table_) {
        if (std::find(known_.begin(), known_.end(), key.str()) == known_.end()) {
            throw Error(at(file_, key.source().begin) + "unknown key " + quoted(one_line(key.str()))
                        + " in " + quoted(name_) + did_you_mean(key.str(), known_));
        }
    }
}

void ShapeTable::fail(std::string_view key, const std::string& message) const {
    const toml::node* node = table_->get(key);
    throw Error(at(file_, node != nullptr ? node->source().begin : table_->source().begin)
                + message);
}

}  // namespace pent::mesher
