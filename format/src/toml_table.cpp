#include "pent/toml_table.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/nearest_name.h>

#include <algorithm>
#include <cmath>

namespace pent {

namespace {

std::string at(const std::string& file, const toml::source_position& position) {
    const auto number = [](auto value) { return ":" + std::to_string(value); };
    return file.empty() ? "" : file + number(position.line) + number(position.column);
}

// A message may quote what it found, and that may be the end of a line.
std::string one_line(std::string_view text) {
    std::string line(text);
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < ' '; }, ' ');
    return line;
}

std::string in_quotes(std::string_view word) {
    return "\"" + one_line(word) + "\"";
}

std::string joined(const std::vector<std::string>& words) {
    std::string list;
    for (const std::string& word : words) {
        list += (list.empty() ? "" : ", ") + word;
    }
    return list;
}

std::string type_of(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "the text " + in_quotes(node.as_string()->get());
        case toml::node_type::integer:
            return std::to_string(node.as_integer()->get());
        case toml::node_type::floating_point:
            return readable(node.as_floating_point()->get());
        case toml::node_type::boolean:
            return node.as_boolean()->get() ? "true" : "false";
        default:
            return "a date or time";
    }
}

}  // namespace

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
    const std::string best = nearest_name(word, candidates);
    return best.empty() ? "" : "; did you mean " + in_quotes(best) + "?";
}

toml::table parse_toml(std::string_view text, const std::string& file) {
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& error) {
        throw Error(at(file, error.source().begin) + ": " + one_line(error.description()));
    } catch (const BrokenToml&) {
        throw Error(file
                    + ": is not TOML; expected lines of the form key = value and [table] lines");
    }
}

TableReader::TableReader(const toml::table& table, std::string name, std::string file)
    : table_(&table), name_(std::move(name)), file_(std::move(file)) {}

const toml::node* TableReader::find(std::string_view key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
        known_.emplace_back(key);
    }
    return table_->get(key);
}

bool TableReader::has(std::string_view key) {
    return find(key) != nullptr;
}

std::string TableReader::place(std::string_view key) const {
    const toml::node* node = table_->get(key);
    return at(file_, node != nullptr ? node->source().begin : table_->source().begin);
}

void TableReader::fail(std::string_view key, const std::string& message) const {
    const std::string where = place(key);
    throw Error(where + (where.empty() ? "" : ": ") + message);
}

std::vector<std::string> TableReader::unknown() const {
    std::vector<std::string> keys;
    for (const auto& [key, node] : *table_) {
        if (std::find(known_.begin(), known_.end(), key.str()) == known_.end()) {
            keys.emplace_back(key.str());
        }
    }
    return keys;
}

void TableReader::fail_unknown(const std::string& key, const std::string& expected) const {
    std::string where = place(key);
    for (const auto& [present, node] : *table_) {
        where = present.str() == key ? at(file_, present.source().begin) : where;
    }
    throw Error(where + (where.empty() ? "" : ": ") + "unknown key " + in_quotes(key) + " in "
                + name_ + expected);
}

void TableReader::fail_missing(std::string_view key, std::string_view type) const {
    // Of keys that nobody has asked for yet, one that looks like it.
    const std::string typo = nearest_name(key, unknown());
    fail("", name_ + " needs " + in_quotes(key) + " (" + std::string(type) + ")"
                 + (typo.empty() ? "" : "; found the unknown key " + in_quotes(typo)));
}

double TableReader::number(std::string_view key,
                           std::optional<double> fallback,
                           const Range& range) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        if (!fallback) {
            fail_missing(key, text_of(range));
        }
        return *fallback;
    }
    const std::optional<double> value = node->value<double>();
    const std::string expected =
        node->is_number() && value ? expected_in(range, *value) : text_of(range);
    if (!expected.empty()) {
        fail(key, in_quotes(key) + " is " + type_of(*node) + "; expected " + expected);
    }
    return *value;
}

std::int64_t TableReader::integer(std::string_view key,
                                  std::optional<std::int64_t> fallback,
                                  std::int64_t low,
                                  std::int64_t high) {
    const std::string expected =
        "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
    const toml::node* node = find(key);
    if (node == nullptr) {
        if (!fallback) {
            fail_missing(key, expected);
        }
        return *fallback;
    }
    if (!node->is_integer() || node->as_integer()->get() < low
        || node->as_integer()->get() > high) {
        fail(key, in_quotes(key) + " is " + type_of(*node) + "; expected " + expected);
    }
    return node->as_integer()->get();
}

bool TableReader::flag(std::string_view key, bool fallback) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        return fallback;
    }
    if (!node->is_boolean()) {
        fail(key, in_quotes(key) + " is " + type_of(*node) + "; expected true or false");
    }
    return node->as_boolean()->get();
}

std::string TableReader::text(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        fail_missing(key, "text");
    }
    if (!node->is_string()) {
        fail(key, in_quotes(key) + " is " + type_of(*node) + "; expected text in quotes");
    }
    return node->as_string()->get();
}

Eigen::VectorXd TableReader::vector(std::string_view key,
                                    int length,
                                    const std::optional<Eigen::VectorXd>& fallback) {
    const std::string expected = std::to_string(length) + " numbers in brackets";
    const toml::node* node = find(key);
    if (node == nullptr) {
        if (!fallback) {
            fail_missing(key, expected);
        }
        return *fallback;
    }
    const toml::array* array = node->as_array();
    if (array == nullptr) {
        fail(key, in_quotes(key) + " is " + type_of(*node) + "; expected " + expected);
    }
    if (array->size() != static_cast<std::size_t>(length)) {
        fail(key, in_quotes(key) + " has " + counted(array->size(), "entry", "entries")
                      + "; expected " + expected);
    }
    Eigen::VectorXd vector(length);
    for (int axis = 0; axis < length; ++axis) {
        const toml::node& entry = *array->get(static_cast<std::size_t>(axis));
        const std::optional<double> value = entry.value<double>();
        if (!entry.is_number() || !value || !std::isfinite(*value)) {
            fail(key,
                 in_quotes(key) + " has the entry " + type_of(entry) + "; expected " + expected);
        }
        if (std::abs(*value) > kLargestNumber) {  // the small ones are roundings of 0
            fail(key, in_quotes(key) + " has the entry " + type_of(entry) + "; expected "
                          + expected_in(kAnyNumber, *value));
        }
        vector[axis] = *value;
    }
    return vector;
}

std::size_t TableReader::place_of(std::string_view key,
                                  const std::string& value,
                                  const std::vector<std::string_view>& names) const {
    const auto found = std::find(names.begin(), names.end(), value);
    if (found == names.end()) {
        std::string list;
        for (const std::string_view name : names) {
            list += (list.empty() ? "" : ", ") + in_quotes(name);
        }
        fail(key, in_quotes(key) + " is " + in_quotes(value) + "; expected "
                      + (names.size() > 1 ? "one of " : "") + list
                      + did_you_mean(value, {names.begin(), names.end()}));
    }
    return static_cast<std::size_t>(found - names.begin());
}

std::size_t TableReader::choice(std::string_view key,
                                const std::vector<std::string_view>& names,
                                std::size_t fallback) {
    return has(key) ? place_of(key, text(key), names) : fallback;
}

std::vector<std::size_t> TableReader::choices(std::string_view key,
                                              const std::vector<std::string_view>& names) {
    std::vector<std::size_t> chosen;
    if (!has(key)) {
        return chosen;
    }
    const toml::array* array = find(key)->as_array();
    if (array == nullptr) {
        fail(key, in_quotes(key) + " is " + type_of(*find(key)) + "; expected a list of names");
    }
    for (const toml::node& entry : *array) {
        if (!entry.is_string()) {
            fail(key, in_quotes(key) + " has the entry " + type_of(entry) + "; expected a name");
        }
        const std::string& value = entry.as_string()->get();
        chosen.push_back(place_of(key, value, names));
        if (std::count(chosen.begin(), chosen.end(), chosen.back()) > 1) {
            fail(key, in_quotes(key) + " has " + in_quotes(value) + " twice; expected it once");
        }
    }
    return chosen;
}

TableReader TableReader::table(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) {
        fail_missing(key, "a table");
    }
    if (!node->is_table()) {
        fail(key, in_quotes(key) + " is " + type_of(*node) + "; expected a table");
    }
    return {*node->as_table(), in_quotes(key), file_};
}

std::vector<TableReader> TableReader::tables(std::string_view key) {
    std::vector<TableReader> readers;
    if (!has(key)) {
        return readers;
    }
    if (find(key)->is_table()) {
        readers.push_back(table(key));
        return readers;
    }
    const toml::array* array = find(key)->as_array();
    if (array == nullptr) {
        fail(key, in_quotes(key) + " is " + type_of(*find(key)) + "; expected a list of tables");
    }
    for (const toml::node& entry : *array) {
        if (!entry.is_table()) {
            fail(key, in_quotes(key) + " has the entry " + type_of(entry) + "; expected a table");
        }
        readers.emplace_back(*entry.as_table(), in_quotes(key), file_);
    }
    return readers;
}

std::string TableReader::one_of(const std::vector<std::string>& kinds) {
    std::string found;
    const std::string list = joined(kinds);
    int count = 0;
    for (const std::string& kind : kinds) {
        if (has(kind)) {
            found = kind;
            ++count;
        }
    }
    if (count == 1) {
        return found;
    }
    const std::vector<std::string> others = unknown();
    if (count == 0 && !others.empty()) {  // a kind that is misspelled or that there is not
        fail_unknown(others.front(),
                     "; expected one of " + list + did_you_mean(others.front(), known_));
    }
    fail("", name_ + " has " + std::to_string(count) + " of " + list + "; expected one");
}

bool TableReader::is_text(std::string_view key) {
    return has(key) && find(key)->is_string();
}

void TableReader::refuse(std::string_view key, std::string_view reason) {
    if (has(key)) {
        fail(key, in_quotes(key) + " " + std::string(reason));
    }
}

void TableReader::finish(const std::function<std::string(const std::string&)>& hint) const {
    for (const std::string& key : unknown()) {
        const std::string text = hint ? hint(key) : "";
        const std::string near = text.empty() ? did_you_mean(key, known_) : "; " + text;
        const std::string one_of = known_.size() > 1 ? "one of " : "";
        fail_unknown(key, near.empty() ? "; expected " + one_of + joined(known_) : near);
    }
}

}  // namespace pent
