#pragma once

#include <pent/error.h>
#include <pent/runs/scene_file.h>

#include <string>
#include <string_view>

// Scenes as text, for tests of what is read and what is refused.

namespace pent::runs::test {

inline simulator::Scene parse(std::string_view text) {
    return parse_scene(text, "scene.toml", "/data");
}

inline std::string error_of(std::string_view text) {
    try {
        static_cast<void>(parse(text));
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

// A whole scene around one line or block that is under test; the block starts in line 5.
inline std::string with(const std::string& block) {
    return "[[body]]\nname = \"a\"\nmesh = \"a.pent\"\n\n" + block;
}

}  // namespace pent::runs::test
