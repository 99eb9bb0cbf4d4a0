#include "axes.h"
#include "child_process.h"
#include "compare.h"
#include "drawing.h"
#include "frontier.h"
#include "meshes.h"
#include "plot.h"
#include "record.h"
#include "trajectory.h"

#include <pent/error.h>
#include <pent/output_file.h>
#include <pent/output_folder.h>
#include <pent/runs/scene_file.h>
#include <pent/study/study.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>

namespace pent::study {

namespace {

namespace fs = std::filesystem;
using simulator::Scene;

/// Thrown to leave a study that was asked to stop.
struct Stopped {};

Scene shortened(Scene scene, int frames) {
    if (frames > 0) {
        scene.frames = std::min(scene.frames, frames);
    }
    return scene;
}

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
// do not lock.
simulator::SolverOptions reference_solver(const Scene& scene, const std::vector<Axis>& axes) {
    simulator::SolverOptions exact = scene.solver;
    const auto elements = std::ranges::find(axes, "elements", &Axis::name);
    if (elements != axes.end() && std::ranges::count(elements->values, "smoothed") > 0) {
        exact.elements = simulator::ElementKind::Smoothed;
    }
    exact.precision = simulator::Precision::Double;
    exact.tolerance = 1e-8;
    exact.newton_tolerance = 1e-7;
    exact.max_iterations = std::max(exact.max_iterations, 20'000);
    return exact;
}

class Study {
public:
    Study(const StudyOptions& options, const StudyCallbacks& callbacks)
        : options_(options),
          callbacks_(callbacks),
          folder_(options.folder, kStudyFolder),
          scene_(shortened(runs::read_scene(options.scene), options.frames)) {
        for (const std::string& text : options.vary) {
            axes_.push_back(parse_axis(text));
            const bool is_twice =
                std::ranges::count(axes_, axes_.back().name, [](const Axis& a) { return a.name; })
                > 1;
            if (is_twice) {
                throw Error("--vary " + text + ": " + axes_.back().name + " is varied twice");
            }
        }
        for (const Axis& axis : axes_) {
            for (const std::string& value : axis.values) {
                check_setting(scene_, {axis.name, value});  // all mistakes before any work
            }
        }
        if (scene_.solver.integrator != simulator::Integrator::Quasistatic) {
            check_setting(scene_, {"integrator", options.reference_integrator});
        }
        combinations_ = combinations(axes_);
        report_.scene = options.scene.filename().string();
        report_.frames = scene_.frames;
        report_.scene_frames = runs::read_scene(options.scene).frames;
        report_.threads = options.threads;
    }

    StudyReport operator()();

private:
    void open_folder();
    void claim(const char* file, const std::string& text, const char* other);
    void run_reference();
    void run_level(const Scene& scene, const std::string& name);
    void run_combinations();
    void run_once(std::size_t combination);
    void measure(std::size_t combination, Record& record);
    void tell(const std::string& next);
    [[nodiscard]] bool is_stopping() const {
        return callbacks_.should_stop && callbacks_.should_stop();
    }
    [[nodiscard]] std::string run_name(std::size_t combination) const {
        return "runs/" + file_name(combinations_[combination]);
    }
    ChildOutcome simulate(const Scene& scene, const std::string& name, bool resume);
    [[nodiscard]] const Interpolation& where_in_reference(std::uint32_t meshes,
                                                          const Trajectory& run);
    void write_files();

    const StudyOptions& options_;
    const StudyCallbacks& callbacks_;
    OutputFolder folder_;
    Scene scene_;
    std::vector<Axis> axes_;
    std::vector<Settings> combinations_;
    std::vector<Scene> scenes_;  // one a combination, with their meshes
    std::vector<Record> records_;
    std::unique_ptr<Trajectory> reference_;
    std::string reference_text_;
    std::uint32_t reference_meshes_ = 0;
    Window window_;
    std::map<std::uint32_t, Interpolation> where_;  // by mesh_checksum()
    int runs_done_ = 0;
    StudyReport report_;
};

void Study::tell(const std::string& next) {
    if (is_stopping()) {
        throw Stopped{};
    }
    if (callbacks_.on_run) {
        const int total = options_.reference_halvings + 1
                          + options_.repeats * static_cast<int>(combinations_.size());
        callbacks_.on_run(runs_done_, total, next);
    }
    ++runs_done_;
}

// The folder is of this scene, by this program, or new.
void Study::open_folder() {
    folder_.refuse_foreign();
    if (options_.force) {
        std::vector<fs::path> inputs = {options_.scene};
        for (const simulator::Body& body : scene_.bodies) {
            inputs.emplace_back(body.mesh);
        }
        folder_.clear(inputs);
    }
    folder_.remove_temporaries();
    claim("scene.toml", runs::scene_text(scene_), "of another scene");
    claim("program.txt", fingerprint(options_.programs / "pent-sim") + "\n", "by another pent-sim");
}

// Says in a file of the folder what it is of, unless it is of something else.
void Study::claim(const char* file, const std::string& text, const char* other) {
    const fs::path path = folder_.claim(file);
    if (fs::exists(path) && read_text(path) != text) {
        throw Error(options_.folder.string() + ": holds a study " + other
                    + "; use another folder or --force");
    }
    write_text(path, text);
}

// Runs a scene into a folder of the study, with the scene beside it.
ChildOutcome Study::simulate(const Scene& scene, const std::string& name, bool resume) {
    const fs::path scene_path = folder_.claim(name + ".toml");
    const fs::path folder = folder_.claim(name + "/").parent_path();
    write_text(scene_path, runs::scene_text(scene));
    return run_child(options_.programs / "pent-sim",
                     {scene_path.string(), "-o", folder.string(), "--quiet", "--threads",
                      std::to_string(options_.threads), resume ? "--resume" : "--force"},
                     {}, callbacks_.should_stop);
}

// Runs a level of the reference unless it is there; goes on where an earlier call was interrupted.
void Study::run_level(const Scene& scene, const std::string& name) {
    tell("reference, dt = " + short_number(scene.dt()) + " s");
    const fs::path folder = options_.folder / name;
    const bool is_same = read_text(folder.string() + ".toml") == runs::scene_text(scene);
    const std::optional<runs::RunVerdict> before = verdict_of(folder);
    if (is_same && before == runs::RunVerdict::Finished) {
        return;
    }
    const ChildOutcome outcome = simulate(scene, name, is_same && before.has_value());
    if (is_stopping()) {
        throw Stopped{};
    }
    if (outcome.exit_code != 0 || verdict_of(folder) != runs::RunVerdict::Finished) {
        throw Error("the reference (" + options_.reference_integrator + ", dt = "
                    + short_number(scene.dt()) + " s) does not run to its end: " + outcome.error);
    }
    // Of a level that was interrupted only the last part: the reference is then said to be cheaper.
    Record record;
    record.verdict = "finished";
    record.wall_seconds = {outcome.wall_seconds};
    record.cpu_seconds = {outcome.cpu_seconds};
    record.peak_bytes = {outcome.peak_bytes};
    write_record(folder_.claim(name + ".json"), record);
}

void Study::run_reference() {
    Scene base = with_meshes(scene_, finest_mesh(axes_), options_, folder_, callbacks_.should_stop);
    if (base.solver.integrator != simulator::Integrator::Quasistatic) {
        base = with_settings(base, {{"integrator", options_.reference_integrator}});
    }
    base.solver = reference_solver(base, axes_);
    for (const Axis& axis : axes_) {
        for (const std::string& value : axis.values) {
            if (axis.name == "dt") {
                const Scene fine = with_settings(base, {{axis.name, value}});
                base.steps_per_frame = std::max(base.steps_per_frame, fine.steps_per_frame);
            }
        }
    }
    std::vector<std::unique_ptr<Trajectory>> levels;
    fs::path folder;
    for (int level = 0; level <= options_.reference_halvings; ++level) {
        Scene scene = base;
        scene.steps_per_frame = base.steps_per_frame << level;
        const std::string name = "references/steps-" + std::to_string(scene.steps_per_frame);
        folder = options_.folder / name;
        run_level(scene, name);
        levels.push_back(std::make_unique<Trajectory>(scene, folder));
        report_.reference.dt.push_back(scene.dt());
        reference_text_ = runs::scene_text(scene);
    }
    reference_meshes_ = mesh_checksum(base);
    ReferenceReport& report = report_.reference;
    window_ = window_of(*levels.back(), scene_.frames_per_second);
    for (std::size_t level = 0; level + 1 < levels.size(); ++level) {
        report.last =
            compare(*levels[level], *levels[level + 1], {}, window_, scene_.frames_per_second);
        report.difference.push_back(report.last.position);
    }
    const std::size_t last = report.difference.size() - 1;
    const Convergence convergence =
        convergence_of(report.difference[last - 1], report.difference[last]);
    report.order = convergence.order;
    report.error_bar = convergence.error_bar;
    report.is_converged = convergence.is_converged;
    report.window = window_.end;
    report.has_contact = window_.has_contact;
    const std::optional<Record> record = read_record(folder.string() + ".json");
    report.cost = record ? cost_of(*record, scene_.frames) : Cost{};
    report_.vertices = levels.back()->rest().cols();
    report_.cells = levels.back()->cell_count();
    reference_ = std::move(levels.back());
}

const Interpolation& Study::where_in_reference(std::uint32_t meshes, const Trajectory& run) {
    // A body's layers may reach a hair beyond those of a coarser one; a cell's height is another
    // mesh.
    constexpr double kMaxOutside = 0.5;
    if (const auto known = where_.find(meshes); known != where_.end()) {
        return known->second;
    }
    Interpolation where;
    if (meshes != reference_meshes_) {
        where = locate(run.rest(), reference_->rest(), reference_->cells());
        if (where.farthest > kMaxOutside) {
            throw Error(
                "the meshes of the study are of different shapes; expected layers or"
                " subdivisions of one body");
        }
    }
    return where_.emplace(meshes, std::move(where)).first->second;
}

// Compares a run that has just finished with the reference.
void Study::measure(std::size_t combination, Record& record) {
    const Trajectory run(scenes_[combination], options_.folder / run_name(combination));
    record.errors = compare(run, *reference_, where_in_reference(record.meshes, run), window_,
                            scene_.frames_per_second);
    record.reference = reference_text_;
    if (!options_.keep_runs) {
        folder_.remove(run_name(combination) + "/");
    }
}

void Study::run_once(std::size_t combination) {
    Record& record = records_[combination];
    const std::string name = run_name(combination);
    const ChildOutcome outcome = simulate(scenes_[combination], name, false);
    if (is_stopping()) {
        throw Stopped{};
    }
    const bool is_first = record.wall_seconds.empty();
    record.wall_seconds.push_back(outcome.wall_seconds);
    record.cpu_seconds.push_back(outcome.cpu_seconds);
    record.peak_bytes.push_back(outcome.peak_bytes);
    if (outcome.exit_code == 0) {
        record.verdict = "finished";
        if (is_first) {
            measure(combination, record);
        } else if (!options_.keep_runs) {
            folder_.remove(name + "/");
        }
    } else {
        record.verdict = outcome.exit_code == 3 ? "diverged" : "refused";
        record.message = outcome.exit_code < 0 ? "ended by a signal" : outcome.error;
        folder_.remove(name + "/");
    }
    write_record(folder_.claim(name + ".json"), record);
}

// Repetitions alternate between the combinations, so that a slow minute of the machine does not
// fall on one of them alone.
void Study::run_combinations() {
    for (const Settings& settings : combinations_) {
        scenes_.push_back(with_meshes(scene_, settings, options_, folder_, callbacks_.should_stop));
        Record fresh;
        try {
            scenes_.back() = with_settings(scenes_.back(), settings);
        } catch (const Error& error) {  // each of them is right; together they are not
            fresh.verdict = "refused";
            fresh.message = error.what();
        }
        fresh.scene = runs::scene_text(scenes_.back());
        fresh.meshes = mesh_checksum(scenes_.back());
        const std::optional<Record> before =
            read_record(options_.folder / "runs" / (file_name(settings) + ".json"));
        const bool is_valid =
            before && before->scene == fresh.scene && before->meshes == fresh.meshes
            && (before->verdict != "finished" || before->reference == reference_text_);
        records_.push_back(is_valid && fresh.verdict.empty() ? *before : fresh);
    }
    for (int repeat = 0; repeat < options_.repeats; ++repeat) {
        for (std::size_t i = 0; i < combinations_.size(); ++i) {
            tell(settings_text(combinations_[i]));
            const Record& record = records_[i];
            const bool has_failed = !record.verdict.empty() && record.verdict != "finished";
            if (!has_failed && static_cast<int>(record.wall_seconds.size()) <= repeat) {
                run_once(i);
            }
        }
    }
}

void Study::write_files() {
    write_text(folder_.claim("study.json"), study_json(report_, options_.created_by));
    write_text(folder_.claim("study.csv"), study_csv(report_));
    const Drawing plot = frontier_plot(report_);
    write_text(folder_.claim("frontier.svg"), svg(plot));
    viewer::write_png(folder_.claim("frontier.png"), raster(plot));
}

StudyReport Study::operator()() {
    open_folder();
    try {
        run_reference();
        run_combinations();
    } catch (const Stopped&) {
        report_.is_stopped = true;
        return std::move(report_);
    }
    for (std::size_t i = 0; i < combinations_.size(); ++i) {
        report_.results.push_back({.settings = combinations_[i],
                                   .verdict = records_[i].verdict,
                                   .message = records_[i].message,
                                   .cost = cost_of(records_[i], scene_.frames),
                                   .errors = records_[i].errors});
    }
    report_.frontier = frontier_of(report_.results, report_.reference.error_bar);
    report_.sentences = sentences_of(report_);
    write_files();
    return std::move(report_);
}

void check(const StudyOptions& options) {
    if (options.repeats < 1 || options.reference_halvings < 2 || options.reference_halvings > 8
        || options.frames < 0 || options.threads < 1) {
        throw Error(
            "a study needs at least 1 repetition, 2 to 8 halvings of the reference, and"
            " at least 1 thread");
    }
}

}  // namespace

StudyReport run_study(const StudyOptions& options, const StudyCallbacks& callbacks) {
    check(options);
    return Study(options, callbacks)();
}

std::string scene_with(const StudyOptions& options, const Result& result, const fs::path& where) {
    // Of a mesh that was made for the study the text names the file in its folder.
    OutputFolder folder(options.folder, kStudyFolder);
    const Scene base =
        with_meshes(runs::read_scene(options.scene), result.settings, options, folder, {});
    const Scene scene = with_settings(base, result.settings);
    Scene moved = scene;
    for (simulator::Body& body : moved.bodies) {
        body.mesh = fs::proximate(body.mesh, fs::absolute(where)).string();
    }
    return runs::scene_text(moved);
}

}  // namespace pent::study
