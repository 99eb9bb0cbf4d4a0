#include "prepare.h"

#include "axes.h"
#include "meshes.h"
#include "record.h"

#include <pent/error.h>
#include <pent/output_file.h>
#include <pent/runs/scene_file.h>
#include <pent/simulator/words.h>

#include <algorithm>
#include <cstdlib>

namespace pent::study {

namespace {

namespace fs = std::filesystem;
using simulator::Scene;

constexpr const char* kStatics = "quasistatic";  // as an integrator of scenes

// The settings of the mesh with the largest numbers, which the reference has.
Settings finest_mesh(const std::vector<Axis>& axes) {
    Settings settings;
    for (const Axis& axis : axes) {
        if (is_mesh_axis(axis.name)) {
            const auto number = [](const std::string& a, const std::string& b) {
                return std::strtod(a.c_str(), nullptr) < std::strtod(b.c_str(), nullptr);
            };
            settings.push_back({axis.name, *std::ranges::max_element(axis.values, number)});
        }
    }
    return settings;
}

// As accurate as the program can be at a given dt. What Newton's method leaves of the momentum of a
// step may add up over all of them, so it is little. Of several kinds of elements it has those that
// lock least, and so of presets.
simulator::SolverOptions reference_solver(const Scene& scene, const std::vector<Axis>& axes) {
    simulator::SolverOptions exact = scene.solver;
    const auto elements = std::ranges::find(axes, "elements", &Axis::name);
    for (const auto kind : {simulator::ElementKind::Smoothed, simulator::ElementKind::Quadratic}) {
        const auto name = simulator::word_of(kind);
        if (elements != axes.end() && std::ranges::count(elements->values, name) > 0) {
            exact.elements = kind;
        }
    }
    const auto presets = std::ranges::find(axes, "preset", &Axis::name);
    if (elements == axes.end() && presets != axes.end()) {
        for (const std::string& value : presets->values) {
            const auto kind = with_settings(scene, {{presets->name, value}}).solver.elements;
            exact.elements = kind == simulator::ElementKind::Quadratic ? kind : exact.elements;
        }
    }
    exact.precision = simulator::Precision::Double;
    exact.tolerance = 1e-8;
    exact.newton_tolerance = 1e-7;
    exact.max_iterations = std::max(exact.max_iterations, 20'000);
    return exact;
}

std::vector<Axis> axes_of(const StudyOptions& options) {
    std::vector<Axis> axes;
    for (const std::string& text : options.vary) {
        axes.push_back(parse_axis(text));
        if (std::ranges::count(axes, axes.back().name, &Axis::name) > 1) {
            throw Error("--vary " + text + ": " + axes.back().name + " is varied twice");
        }
    }
    return axes;
}

// Whether the combinations are motions; equilibria otherwise. Throws an Error for some of either.
bool has_time(const Scene& scene, const std::vector<Axis>& axes) {
    std::string motion;
    std::string equilibrium;
    for (const Settings& settings : combinations(axes)) {
        try {
            const auto integrator = with_settings(scene, settings).solver.integrator;
            (integrator == simulator::Integrator::Quasistatic ? equilibrium : motion) =
                settings_text(settings);
        } catch (const Error&) {  // a combination that is refused is neither
        }
    }
    if (!motion.empty() && !equilibrium.empty()) {
        throw Error("--vary: some settings seek equilibria (" + equilibrium + "), others motions ("
                    + motion + "), which have no reference in common; make two studies of them");
    }
    return equilibrium.empty();
}

void check(const StudyOptions& options) {
    if (options.repeats < 1 || options.reference_halvings < 2 || options.reference_halvings > 8
        || options.frames < 0 || options.threads < 1) {
        throw Error(
            "a study needs at least 1 repetition, 2 to 8 halvings of the reference, and"
            " at least 1 thread");
    }
}

class Preparation {
public:
    Preparation(const StudyOptions& options, OutputFolder& folder, const StudyCallbacks& callbacks)
        : options_(options), callbacks_(callbacks), folder_(folder) {
        check(options);
        const Scene scene = runs::read_scene(options.scene);
        scene_ = shortened(scene, options.frames);
        axes_ = axes_of(options);
        for (const Axis& axis : axes_) {
            for (const std::string& value : axis.values) {
                check_setting(scene_, {axis.name, value});  // all mistakes before any work
            }
        }
        has_time_ = has_time(scene_, axes_);
        const std::string reference = has_time_ ? options.reference_integrator : kStatics;
        check_setting(scene_, {"integrator", reference});
        if (has_time_ && reference == kStatics) {
            throw Error("--reference-integrator " + reference
                        + ": has no motion to compare those of the study with; expected bdf2 or"
                          " another integrator that has");
        }
        plan_ = {.scene = fs::absolute(options.scene).lexically_normal().string(),
                 .frames = scene_.frames,
                 .scene_frames = scene.frames,
                 .repeats = options.repeats,
                 .threads = options.threads,
                 .keep_runs = options.keep_runs,
                 .reference_integrator = reference};
    }

    Plan operator()() {
        open_folder();
        add_levels();
        add_combinations();
        for (const char* name : {"study.json", "study.csv", "frontier.svg", "frontier.png"}) {
            static_cast<void>(folder_.claim(name));
        }
        write_plan(folder_.claim(kPlanFile), plan_);
        return plan_;
    }

private:
    void open_folder();
    void claim(const char* file, const std::string& text, const char* other);
    [[nodiscard]] Scene meshed(const Settings& settings);
    void add_levels();
    void add_combinations();
    std::string add(Unit unit, Scene scene);

    const StudyOptions& options_;
    const StudyCallbacks& callbacks_;
    OutputFolder& folder_;
    Scene scene_;
    std::vector<Axis> axes_;
    bool has_time_ = true;  // its runs are motions, not equilibria
    Plan plan_;
};

// The folder is of this scene, by this program, or new.
void Preparation::open_folder() {
    folder_.refuse_foreign();
    if (options_.force) {
        std::vector<fs::path> inputs = {options_.scene};
        for (const simulator::Body& body : scene_.bodies) {
            inputs.emplace_back(body.mesh);
        }
        folder_.clear(inputs);
    }
    folder_.remove_temporaries();
    claim(kSceneFile, identity_of(scene_), "of another scene");
    claim(kProgramFile, fingerprint(options_.programs / "pent-sim") + "\n", "by another pent-sim");
}

// Says in a file of the folder what it is of, unless it is of something else.
void Preparation::claim(const char* file, const std::string& text, const char* other) {
    const fs::path path = folder_.claim(file);
    if (fs::exists(path) && read_text(path) != text) {
        throw Error(options_.folder.string() + ": holds a study " + other
                    + "; use another folder or --force");
    }
    write_text(path, text);
}

Scene Preparation::meshed(const Settings& settings) {
    const auto is_stopping = [&] { return callbacks_.should_stop && callbacks_.should_stop(); };
    try {
        Scene scene = with_meshes(scene_, settings, options_, folder_, callbacks_.should_stop);
        if (!is_stopping()) {
            return scene;
        }
    } catch (const Error&) {
        if (!is_stopping()) {
            throw;
        }
    }
    throw Stopped{};
}

void Preparation::add_levels() {
    Scene base =
        with_settings(meshed(finest_mesh(axes_)), {{"integrator", plan_.reference_integrator}});
    base.solver = reference_solver(base, axes_);
    for (const Axis& axis : axes_) {
        for (const std::string& value : axis.values) {
            if (axis.name == "dt") {
                const Scene fine = with_settings(base, {{axis.name, value}});
                base.steps_per_frame = std::max(base.steps_per_frame, fine.steps_per_frame);
            }
        }
    }
    for (int level = 0; level <= options_.reference_halvings; ++level) {
        Scene scene = base;
        scene.steps_per_frame = base.steps_per_frame << level;
        const std::string name = "references/steps-" + std::to_string(scene.steps_per_frame);
        const std::string text = add({.kind = UnitKind::Reference, .name = name}, scene);
        plan_.reference = text + "# meshes " + std::to_string(plan_.units.back().meshes) + "\n";
    }
}

void Preparation::add_combinations() {
    for (const Settings& settings : combinations(axes_)) {
        Unit unit{.name = "runs/" + file_name(settings), .settings = settings};
        Scene scene = meshed(settings);
        try {
            scene = with_settings(scene, settings);
        } catch (const Error& error) {  // each of them is right; together they are not
            unit.refusal = error.what();
        }
        if (unit.refusal.empty()) {
            add(unit, scene);
        } else {
            plan_.units.push_back(unit);
        }
    }
}

// Writes the scene of a unit and lists what it will write; the text of the scene.
std::string Preparation::add(Unit unit, Scene scene) {
    unit.meshes = mesh_checksum(scene);
    const fs::path folder = fs::absolute(folder_.path()).lexically_normal() / "";
    for (simulator::Body& body : scene.bodies) {
        // Other machines may see the folder under another name.
        const fs::path inside = fs::path(body.mesh).lexically_relative(folder);
        if (!inside.empty() && *inside.begin() != "..") {
            body.mesh = (".." / inside).string();
        }
    }
    const std::string text = runs::scene_text(scene);
    const fs::path path = folder_.claim(unit.name + ".toml");
    if (read_text(path) != text) {  // or it stays: it is what a unit that runs is locked by
        write_text(path, text);
    }
    static_cast<void>(folder_.claim(unit.name + "/"));
    static_cast<void>(folder_.claim(unit.name + ".json"));
    unit.scene = fingerprint(path);
    plan_.units.push_back(std::move(unit));
    return text;
}

}  // namespace

simulator::Scene shortened(simulator::Scene scene, int frames) {
    if (frames > 0) {
        scene.frames = std::min(scene.frames, frames);
    }
    return scene;
}

std::string identity_of(simulator::Scene scene) {
    for (simulator::Body& body : scene.bodies) {
        body.mesh = fs::absolute(body.mesh).lexically_normal().string();
    }
    return runs::scene_text(scene);
}

Plan prepare(const StudyOptions& options, OutputFolder& folder, const StudyCallbacks& callbacks) {
    return Preparation(options, folder, callbacks)();
}

}  // namespace pent::study
