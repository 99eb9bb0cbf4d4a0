#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pent::scene_fuzz {

/// A scene as a tree of keys and values, in the order of the file. Drawing, shrinking and comparing
/// scenes work on it, and so know nothing of single keys.
using Json = nlohmann::ordered_json;

/// The scene as TOML: tables and lists of tables at the top have headers, all below is inline.
[[nodiscard]] std::string toml_text(const Json& scene);

/// A value as TOML has it within a line.
[[nodiscard]] std::string inline_text(const Json& value);

/// The tree of a TOML file. Throws pent::Error where the text is none.
[[nodiscard]] Json parse_document(const std::string& text);

/// All paths of keys that hold values, such as "body.place.rotate.plane"; lists add nothing to a
/// path, and empty ones have none. In order, each once.
[[nodiscard]] std::vector<std::string> key_paths(const Json& scene);

}  // namespace pent::scene_fuzz
