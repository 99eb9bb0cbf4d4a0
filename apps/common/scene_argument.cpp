#include "scene_argument.h"

#include <pent/error.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <system_error>
#include <vector>

namespace pent::apps {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> scenes_in(const fs::path& folder) {
    std::vector<std::string> scenes;
    std::error_code ignored;  // of a folder that nobody may read nothing is known
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
        if (entry.path().extension() == ".toml" && entry.is_regular_file(ignored)) {
            scenes.push_back((folder / entry.path().filename()).string());
        }
    }
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

}  // namespace

void refuse_folder(const fs::path& scene) {
    std::error_code ignored;
    if (!fs::is_directory(scene, ignored)) {
        return;
    }
    const std::vector<std::string> scenes = scenes_in(scene);
    if (scenes.empty()) {
        throw Error(scene.string() + ": is a folder, with no scene file (.toml) in it");
    }
    constexpr std::size_t kShown = 5;
    std::string list = scenes[0];
    for (std::size_t i = 1; i < std::min(scenes.size(), kShown); ++i) {
        list += ", " + scenes[i];
    }
    if (scenes.size() > kShown) {
        list += " and " + std::to_string(scenes.size() - kShown) + " more";
    }
    throw Error(scene.string() + ": is a folder; give "
                + (scenes.size() == 1 ? "the scene" : "one of the scenes") + " in it: " + list);
}

}  // namespace pent::apps
