#include "document.h"

#include <pent/real_text.h>
#include <pent/toml_table.h>

#include <cstdint>
#include <set>
#include <sstream>

namespace pent::scene_fuzz {

namespace {

// Shortest text that reads back as the same number, with what makes it a float to TOML.
std::string number(double value) {
    char digits[32];
    const auto [end, error] = real_to_chars(digits, digits + sizeof digits, value);
    std::string text(digits, end);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string table_text(const std::string& header, const Json& table) {
    std::string text = header + "\n";
    for (const auto& [key, value] : table.items()) {
        text += key + " = " + inline_text(value) + "\n";
    }
    return text + "\n";
}

Json tree_of(const toml::node& node) {
    if (const toml::table* table = node.as_table()) {
        Json object = Json::object();
        for (const auto& [key, value] : *table) {
            object[std::string(key.str())] = tree_of(value);
        }
        return object;
    }
    if (const toml::array* array = node.as_array()) {
        Json list = Json::array();
        for (const toml::node& entry : *array) {
            list.push_back(tree_of(entry));
        }
        return list;
    }
    if (node.is_integer()) {
        return *node.value<std::int64_t>();
    }
    if (node.is_floating_point()) {
        return *node.value<double>();
    }
    if (node.is_boolean()) {
        return *node.value<bool>();
    }
    return node.value<std::string>().value_or("");
}

void collect_paths(const Json& value, const std::string& path, std::set<std::string>& paths) {
    if (value.is_object()) {
        for (const auto& [key, entry] : value.items()) {
            collect_paths(entry, path.empty() ? key : path + "." + key, paths);
        }
        return;
    }
    if (value.is_array() && (value.empty() || value.front().is_structured())) {
        for (const Json& entry : value) {
            collect_paths(entry, path, paths);
        }
        return;
    }
    paths.insert(path);
}

}  // namespace

std::string inline_text(const Json& value) {
    if (value.is_number_float()) {
        return number(value.get<double>());
    }
    std::string text;
    if (value.is_array()) {
        for (const Json& entry : value) {
            text += (text.empty() ? "" : ", ") + inline_text(entry);
        }
        return "[" + text + "]";
    }
    if (value.is_object()) {
        for (const auto& [key, entry] : value.items()) {
            text += (text.empty() ? " " : ", ") + key + " = " + inline_text(entry);
        }
        return "{" + text + " }";
    }
    return value.dump();  // texts (JSON escapes as TOML does), integers, true and false
}

std::string toml_text(const Json& scene) {
    std::string text;
    for (const auto& [name, block] : scene.items()) {
        if (block.is_array()) {
            for (const Json& table : block) {
                text += table_text("[[" + name + "]]", table);
            }
        } else {
            text += table_text("[" + name + "]", block);
        }
    }
    return text;
}

Json parse_document(const std::string& text) {
    return tree_of(parse_toml(text, "scene"));
}

std::vector<std::string> key_paths(const Json& scene) {
    std::set<std::string> paths;
    collect_paths(scene, "", paths);
    return {paths.begin(), paths.end()};
}

}  // namespace pent::scene_fuzz
