#include "meshes.h"

#include "axes.h"
#include "child_process.h"
#include "record.h"

#include <pent/error.h>
#include <pent/output_file.h>
#include <pent/pent_file.h>
#include <pent/runs/recipe.h>

#include <algorithm>

namespace pent::study {

namespace fs = std::filesystem;

std::vector<std::string> mesh_arguments(const std::string& recipe, const Settings& settings) {
    std::vector<std::string> words;
    for (const runs::RecipeWord& word : runs::words_of_recipe(recipe)) {
        words.push_back(word.text);
    }
    for (const Setting& setting : settings) {
        if (!is_mesh_axis(setting.axis)) {
            continue;
        }
        const std::string option = "--" + setting.axis;
        const auto joined = std::ranges::find_if(
            words, [&](const std::string& one) { return one.starts_with(option + "="); });
        const auto place = std::ranges::find(words, option);
        if (joined != words.end()) {
            *joined = option + "=" + setting.value;
        } else if (place != words.end() && place + 1 != words.end()) {
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

// What a mesh is made from: the arguments of pent-mesh, and the content of the files they name.
std::string origin_of(const std::vector<std::string>& arguments, const fs::path& where) {
    std::string text;
    for (const std::string& argument : arguments) {
        text += argument;
        const fs::path path = where / argument.substr(runs::value_in(argument));
        if (fs::is_regular_file(path)) {
            text += " " + fingerprint(path);
        }
        text += "\n";
    }
    return text;
}

// Makes the mesh of a recipe, unless it is there and what it was made from is as it was.
void make_mesh(const simulator::Body& body,
               const Settings& settings,
               const std::string& name,
               const StudyOptions& options,
               OutputFolder& folder,
               const std::function<bool()>& should_stop) {
    const fs::path where = fs::absolute(options.scene).parent_path();
    const fs::path path = fs::absolute(folder.claim(name + ".pent"));
    const fs::path note = folder.claim(name + ".txt");
    std::vector<std::string> arguments = mesh_arguments(body.recipe, settings);
    const std::string origin = origin_of(arguments, where);
    if (fs::exists(path) && read_text(note) == origin) {
        return;
    }
    fs::remove(note);  // a kill from here on leaves a mesh of which nothing is known
    arguments.insert(arguments.end(), {"-o", path.string(), "--quiet"});
    const ChildOutcome outcome =
        run_child(options.programs / "pent-mesh", arguments, where, should_stop);
    if (outcome.exit_code != 0) {
        throw Error(options.scene.string() + ": the recipe of \"" + body.name
                    + "\" does not make a mesh (" + outcome.error + ")");
    }
    write_text(note, origin);
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
            const std::string name = "meshes/" + body.name + "." + file_name(level);
            make_mesh(body, level, name, options, folder, should_stop);
            body.mesh = (folder.path() / (name + ".pent")).string();
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
