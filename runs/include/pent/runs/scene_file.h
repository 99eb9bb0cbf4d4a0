#pragma once

#include <pent/simulator/scene.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace pent::runs {

/// Scene files: TOML, every key of which is documented in docs/simulator.md.

/// Reads and checks a scene. Mesh paths come out joined to the folder of the scene file.
///
/// Throws an Error that begins with file:line:column for anything that is not understood: broken
/// TOML, an unknown key (with the nearest known one), a wrong type, a number out of range, a
/// vector of the wrong length, a missing key, a name used twice, a feature not supported.
[[nodiscard]] simulator::Scene read_scene(const std::filesystem::path& path);

/// The same from text.
///
/// @param name    Stands for the file in messages.
/// @param folder  What mesh paths are relative to.
[[nodiscard]] simulator::Scene parse_scene(std::string_view text,
                                           const std::string& name,
                                           const std::filesystem::path& folder);

/// The scene as TOML with every default filled in; parse_scene() gives back the same scene.
///
/// Numbers are written so that they are read back to the last bit.
[[nodiscard]] std::string scene_text(const simulator::Scene& scene);

/// Every key of scene files, as the tables in Markdown that docs/simulator.md has.
[[nodiscard]] std::string schema_text();

}  // namespace pent::runs
