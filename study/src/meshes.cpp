#include "meshes.h"

#include "axes.h"
#include "child_process.h"

#include <pent/error.h>
#include <pent/pent_file.h>

#include <algorithm>
#include <sstream>

namespace pent::study {

namespace fs = std::filesystem;

std::vector<std::string> mesh_arguments(const std::string& recipe, const Settings& settings) {
    std::istringstream text(recipe);
    std::vector<std::string> words;
    std::string word;
    while (text >> word) {
        words.push_back(word);
    }
    for (const Setting& setting : settings) {
        if (!is_mesh_axis(setting.axis)) {
            continue;
        }
        const std::string option = "--" + setting.axis;
        const auto place = std::ranges::find(words, option);
        if (place != words.end() && place + 1 != words.end()) {
            *(place + 1) = setting.value;
        } else {
            words.insert(words.end(), {option, setting.value});
        }
    }
    return words;
}

namespace {

Settings mesh_settings(const Settings& settings) {
    Settings chosen;
    std::ranges::copy_if(settings, std::back_inserter(chosen),
                         [](const Setting& setting) { return is_mesh_axis(setting.axis); });
    return chosen;
}

void make_mesh(const simulator::Body& body,
               const Settings& settings,
               const fs::path& path,
               const StudyOptions& options,
               const std::function<bool()>& should_stop) {
    std::vector<std::string> arguments = mesh_arguments(body.recipe, settings);
    arguments.insert(arguments.end(), {"-o", path.string(), "--quiet"});
    const ChildOutcome outcome = run_child(options.programs / "pent-mesh", arguments,
                                           fs::absolute(options.scene).parent_path(), should_stop);
    if (outcome.exit_code != 0) {
        throw Error(options.scene.string() + ": the recipe of \"" + body.name
                    + "\" does not make a mesh (" + outcome.error + ")");
    }
}

}  // namespace

simulator::Scene with_meshes(const simulator::Scene& scene,
                             const Settings& settings,
                             const StudyOptions& options,
                             OutputFolder& folder,
                             const std::function<bool()>& should_stop) {
    const Settings level = mesh_settings(settings);
    simulator::Scene result = scene;
    bool is_known = level.empty();
    for (simulator::Body& body : result.bodies) {
        const bool is_there = fs::exists(body.mesh);
        if (body.recipe.empty() && !is_there) {
            throw Error(body.mesh + ": is not there, and the scene has no recipe to make it from");
        }
        if (!body.recipe.empty() && !(is_there && level.empty())) {
            is_known = true;
            const fs::path path =
                folder.claim("meshes/" + body.name + "." + file_name(level) + ".pent");
            if (!fs::exists(path)) {
                make_mesh(body, level, fs::absolute(path), options, should_stop);
            }
            body.mesh = path.string();
        }
        body.mesh = fs::absolute(body.mesh).lexically_normal().string();
        body.recipe.clear();  // the mesh is what counts from here on
    }
    if (!is_known) {
        throw Error("--vary " + level.front().axis
                    + ": no body of the scene says how its mesh was made; give it a recipe, as in"
                      " recipe = \"ball.obj --thickness 1 --layers 4\"");
    }
    return result;
}

std::uint32_t mesh_checksum(const simulator::Scene& scene) {
    std::uint32_t sum = 0;
    for (const simulator::Body& body : scene.bodies) {
        sum = 31 * sum + read_info(body.mesh).crc32c;
    }
    return sum;
}

}  // namespace pent::study
