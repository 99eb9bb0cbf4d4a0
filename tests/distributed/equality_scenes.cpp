#include "equality_scenes.h"

#include "simulator/scenes.h"
#include "simulator/stress_scenes.h"
#include "support/fork.h"

#include <pent/error.h>
#include <pent/pent_file.h>
#include <pent/runs/scene_file.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <regex>
#include <sstream>

namespace pent::test {

namespace {

namespace fs = std::filesystem;
using simulator::Scene;

constexpr int kSteps = 4;
constexpr int kStressSteps = 12;  // until they touch

// The unbalanced force of a step with a barrier is small beside that at its start, which held
// vertices that run into it make large: 1e-8 of that still moves hooks by 1e-5 of their way, on
// one process as on many.
constexpr double kStressNewton = 1e-11;

// In R^4 these scenes treat z and w alike, and so do their meshes. A step in which that symmetry
// breaks has two lowest points, mirror images of each other, of which rounding takes one. Bodies
// stand so far from such places along w.
constexpr double kOffMirror = 1e-3;  // m

// As much as rounding of positions does: whoever moves farther than that by it is not to be
// compared.
constexpr double kNudge = 1e-13;  // m

std::string text_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

// A number behind an option, changed.
std::string with_option(const std::string& recipe,
                        const std::string& option,
                        const std::function<double(double)>& change) {
    std::smatch found;
    if (!std::regex_search(recipe, found, std::regex(option + " ([0-9.]+)"))) {
        return recipe;
    }
    std::ostringstream number;
    number << change(std::stod(found[1]));
    return found.prefix().str() + option + " " + number.str() + found.suffix().str();
}

// The same body of far fewer cells.
std::string coarser(std::string recipe) {
    const auto at_least = [](double least, double divisor) {
        return [=](double n) { return std::min(n, std::max(least, std::floor(n / divisor))); };
    };
    const bool has_size =
        std::regex_search(recipe, std::regex("--(surface-tri|edge-length|box|ball)"));
    recipe = has_size ? recipe : recipe + " --surface-triangles 300";
    recipe = with_option(recipe, "--surface-triangles", at_least(300, 12));
    recipe = with_option(recipe, "--edge-length", [](double length) { return 2 * length; });
    recipe = with_option(recipe, "--subdivide", at_least(2, 4));
    return with_option(recipe, "--layers", at_least(10, 4));
}

// Makes a mesh unless it is there; false where its model is not.
bool make_mesh(const Places& places, const std::string& recipe, const fs::path& mesh) {
    std::smatch model;
    const bool has_model = std::regex_search(recipe, model, std::regex("[^ ]*models/[^ ]*"));
    if (fs::exists(mesh)) {
        return true;
    }
    if (has_model && !fs::exists(places.data.parent_path() / model.str())) {
        return false;
    }
    const std::string command = "cd " + places.data.parent_path().string() + " && "
                                + (places.programs / "pent-mesh").string() + " " + coarser(recipe)
                                + " -o " + mesh.string() + " --quiet --yes </dev/null >"
                                + mesh.string() + ".log 2>&1";
    if (std::system(command.c_str()) != 0) {  // NOLINT(cert-env33-c)
        throw Error(mesh.string() + " could not be made: " + text_of(mesh.string() + ".log"));
    }
    return true;
}

QuickScene write(const Places& places, const std::string& name, Scene scene) {
    QuickScene result{name, places.work / (name + ".toml"), places.work / (name + "_nudged.toml"),
                      std::move(scene)};
    std::ofstream(result.file) << runs::scene_text(result.scene);
    Scene nudged = result.scene;
    nudged.bodies.back().place.translate[0] += kNudge;
    std::ofstream(result.nudged) << runs::scene_text(nudged);
    return result;
}

QuickScene quick(const Places& places, const std::string& name, Scene scene, int steps) {
    scene.frames = std::min(scene.frames * scene.steps_per_frame, steps);
    scene.frames_per_second *= scene.steps_per_frame;
    scene.steps_per_frame = 1;
    scene.output.balance = true;
    scene.solver.linear = simulator::LinearSolverKind::Iterative;
    scene.solver.precision = simulator::Precision::Double;
    scene.solver.tolerance = 1e-8;
    scene.solver.newton_tolerance = std::min(scene.solver.newton_tolerance, 1e-8);
    return write(places, name, std::move(scene));
}

// "# Mesh: pent-mesh OPTIONS -o NAME": the options that make a mesh of that name.
std::string recipe_in(const std::string& text, const std::string& name) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::smatch found;
        if (std::regex_match(line, found,
                             std::regex("# Mesh: pent-mesh (.*)-o " + name + "(.*)"))) {
            return found[1].str() + found[2].str();
        }
    }
    return "";
}

template <int Dim>
QuickScene stress(const Places& places,
                  const std::string& name,
                  const simulator::test::BarrierScene<Dim>& of) {
    const std::string whole = name + "_" + std::to_string(Dim) + "d";
    Scene scene = of.scene;
    for (std::size_t body = 0; body < of.meshes.size(); ++body) {
        scene.bodies[body].mesh =
            (places.work / (whole + "_" + scene.bodies[body].name + ".pent")).string();
        static_cast<void>(write_mesh(scene.bodies[body].mesh, of.meshes[body]));
        if (Dim == 4) {
            scene.bodies[body].place.translate[Dim - 1] += static_cast<double>(body) * kOffMirror;
        }
    }
    scene.solver.newton_tolerance = kStressNewton;
    return quick(places, whole, std::move(scene), kStressSteps);
}

template <int Dim>
void add_stress(const Places& places, std::vector<QuickScene>& scenes) {
    namespace hard = simulator::test;
    scenes.push_back(stress<Dim>(places, "fast_impact", hard::fast_impact<Dim>(1)));
    scenes.push_back(stress<Dim>(places, "stacked_noodles", hard::stacked_noodles<Dim>(1)));
    scenes.push_back(stress<Dim>(places, "needle_at_gap", hard::needle_at_gap<Dim>(1)));
    scenes.push_back(stress<Dim>(places, "interlocked_hooks", hard::interlocked_hooks<Dim>(1)));
    scenes.push_back(stress<Dim>(places, "million_to_one", hard::million_to_one<Dim>(1)));
    scenes.push_back(stress<Dim>(places, "thin_sheets", hard::thin_sheets<Dim>(1)));
}

// A wave along both arms of a fork, away from the end of one of them, which is held.
template <int Dim>
QuickScene muscle(const Places& places) {
    const std::string name = "muscle_" + std::to_string(Dim) + "d";
    Scene scene = simulator::test::box_scene<Dim>();
    scene.bodies[0].mesh = (places.work / (name + ".pent")).string();
    static_cast<void>(write_mesh(scene.bodies[0].mesh, fork<Dim>()));
    simulator::BoxSelection end_of_arm{.low = Eigen::VectorXd::Constant(Dim, -1),
                                       .high = Eigen::VectorXd::Constant(Dim, 1.1)};
    end_of_arm.low[0] = 5.9;
    end_of_arm.high[0] = 7;
    scene.constraints = {simulator::test::hold(end_of_arm, simulator::test::still(Dim))};
    scene.activations = {{.body = "box",
                          .select = {simulator::EverythingSelection{}},
                          .stretch = 0.8,
                          .fibers = simulator::Fibers::Distance,
                          .away_from = {end_of_arm},
                          .preserves_volume = true,
                          .signal = simulator::Signal::Sine,
                          .frequency = 2,
                          .distance_wave = 0.1}};
    return quick(places, name, std::move(scene), kSteps);
}

}  // namespace

std::vector<QuickScene> data_scenes(const Places& places) {
    std::vector<fs::path> files;
    for (const char* folder : {"scenes", "study"}) {
        std::vector<fs::path> here;
        for (const fs::directory_entry& entry : fs::directory_iterator(places.data / folder)) {
            if (entry.path().extension() == ".toml") {
                here.push_back(entry.path());
            }
        }
        std::sort(here.begin(), here.end());
        files.insert(files.end(), here.begin(), here.end());
    }
    std::vector<QuickScene> scenes;
    for (const fs::path& file : files) {
        const std::string name =
            (file.parent_path().filename() == "study" ? "study_" : "") + file.stem().string();
        Scene scene = runs::read_scene(file);
        bool has_meshes = true;
        for (simulator::Body& body : scene.bodies) {
            const std::string mesh = fs::path(body.mesh).filename().string();
            std::string recipe = recipe_in(text_of(file), mesh);
            if (recipe.empty()) {
                recipe =
                    std::regex_replace(body.recipe, std::regex("\\.\\./models"), "data/models");
            }
            body.mesh = (places.work / (name + "_" + mesh)).string();
            has_meshes = has_meshes && make_mesh(places, recipe, body.mesh);
        }
        if (has_meshes) {
            scenes.push_back(quick(places, name, std::move(scene), kSteps));
        }
    }
    return scenes;
}

std::vector<QuickScene> muscle_scenes(const Places& places) {
    return {muscle<3>(places), muscle<4>(places)};
}

std::vector<QuickScene> stress_scenes(const Places& places) {
    std::vector<QuickScene> scenes;
    add_stress<3>(places, scenes);
    add_stress<4>(places, scenes);
    return scenes;
}

}  // namespace pent::test
