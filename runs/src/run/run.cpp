#include "explain/doubts.h"
#include "record/checkpoint_file.h"
#include "record/journal.h"
#include "record/run_report.h"
#include "run/balance_table.h"
#include "run/contact_table.h"
#include "run/earlier_run.h"
#include "run/frames.h"
#include "run/resume.h"
#include "run/resumption.h"
#include "run/run_meshes.h"
#include "run/run_ranks.h"
#include "run/simulation_options.h"

#include <pent/error.h>
#include <pent/obstacles_file.h>
#include <pent/output_file.h>
#include <pent/output_folder.h>
#include <pent/pent_file.h>
#include <pent/run_files.h>
#include <pent/runs/relocated.h>
#include <pent/runs/run.h>
#include <pent/runs/scene_file.h>
#include <pent/simulator/crossing_error.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace pent::runs {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_from(Clock::time_point start, Clock::time_point end) {
    return std::chrono::duration<double>(end - start).count();
}

template <int Dim>
class Run {
public:
    // @param before  Of the run that is to be resumed.
    Run(const Scene& scene,
        const RunOptions& options,
        const RunCallbacks& callbacks,
        Journal before)
        : scene_(scene),
          options_(options),
          callbacks_(callbacks),
          before_(std::move(before)),
          ranks_(options.ranks.get()),
          folder_(options.folder, kRunFolder),
          meshes_(scene, ranks_),
          simulation_(meshes_.simulate(simulation_options(options))) {
        report_.size = simulation_.size();
        report_.thinnest = least_thickness(simulation_);
        report_.warnings = meshes_.warnings();
        for (const auto& lines : {simulation_.warnings(), doubts_of_units(scene, simulation_),
                                  overlaps_at_start(scene, simulation_)}) {
            report_.warnings.insert(report_.warnings.end(), lines.begin(), lines.end());
        }
        for (const Body& body : scene.bodies) {
            std::vector<std::string> regions;
            for (const Region& region : body.regions) {
                regions.push_back(region.name);
            }
            report_.bodies.push_back({.name = body.name, .regions = std::move(regions)});
        }
    }

    RunReport operator()();

private:
    [[nodiscard]] fs::path path(const std::string& name) const { return options_.folder / name; }
    [[nodiscard]] double seconds() const { return seconds_from(start_, Clock::now()); }
    [[nodiscard]] const std::string& name_of(int body) const {
        return scene_.bodies[static_cast<std::size_t>(body)].name;
    }
    void start_folder();
    [[nodiscard]] bool do_obstacles_move() const;
    void write_scene();
    void begin_part(int frame);
    void write_meshes();
    [[nodiscard]] int resume_folder();
    void take_over(Resumption<Dim> found);
    void tell_resume(const Resumption<Dim>& found) const;
    void write_frame_files(int frame);
    void begin_frame(int frame);
    void write_frame_of(int body, int frame);
    void end_frame(int frame);
    bool step_to_frame(int frame);
    void write_report();

    const Scene& scene_;
    const RunOptions& options_;
    const RunCallbacks& callbacks_;
    Journal before_;  // until it is resumed
    RunRanks ranks_;
    OutputFolder folder_;
    RunMeshes<Dim> meshes_;
    Simulation<Dim> simulation_;
    std::vector<std::uint32_t> mesh_crcs_;
    std::string lines_;  // of the journal, to be written with the next frame
    RunReport report_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_report_ = start_;  // when it was done
    double report_pause_ = 0;                 // from then to the next, s
};

template <int Dim>
void Run<Dim>::start_folder() {
    folder_.refuse_foreign();
    if (!folder_.has_list()) {
        return;
    }
    if (!options_.force) {
        throw Error(options_.folder.string()
                    + ": holds a run; use another folder, --resume to go on with that run, or"
                      " --force to replace it");
    }
    std::vector<fs::path> inputs;
    if (!options_.scene_file.empty()) {
        inputs.push_back(options_.scene_file);
    }
    for (const Body& body : scene_.bodies) {
        inputs.emplace_back(body.mesh);
    }
    folder_.clear(inputs);
}

template <int Dim>
bool Run<Dim>::do_obstacles_move() const {
    return std::any_of(scene_.obstacles.begin(), scene_.obstacles.end(),
                       [](const Obstacle& obstacle) { return !obstacle.motion.empty(); });
}

// The scene that is being run stays as its author wrote it, wherever it is.
template <int Dim>
void Run<Dim>::write_scene() {
    const fs::path file = folder_.claim(kSceneFile);
    std::error_code ignored;
    if (!fs::equivalent(options_.scene_file, file, ignored)) {
        const fs::path origin = options_.scene_file.parent_path();
        write_text(file, scene_text(relocated(scene_, origin, options_.folder)));
    }
    if (!scene_.obstacles.empty() && !do_obstacles_move()) {
        write_obstacles(folder_.claim(kObstaclesFile), simulation_.obstacles());
    }
}

template <int Dim>
void Run<Dim>::begin_part(int frame) {
    report_.parts.push_back({.created_by = options_.created_by,
                             .threads = options_.threads,
                             .ranks = ranks_.count(),
                             .isa = simulation_.isa(),
                             .first_frame = frame,
                             .last_frame = frame});
    append_text(folder_.claim(kJournalFile), part_line(report_.parts.back()));
}

template <int Dim>
void Run<Dim>::write_meshes() {
    for (int body = 0; body < simulation_.body_count(); ++body) {
        const std::string file = mesh_file(name_of(body));
        ranks_.write([&] { static_cast<void>(folder_.claim(file)); });
        mesh_crcs_.push_back(meshes_.write(path(file), simulation_, body, options_.created_by));
    }
}

template <int Dim>
void Run<Dim>::tell_resume(const Resumption<Dim>& found) const {
    if (!callbacks_.on_resume || found.history.parts.empty()) {
        return;
    }
    const RunPart& last = found.history.parts.back();
    const std::string where = "frame " + std::to_string(found.frame);
    callbacks_.on_resume(last.verdict == RunVerdict::Died
                             ? "the run had died (it was killed or crashed) after " + where
                                   + "; it goes on from there"
                             : "the run had " + std::string(verdict_name(last.verdict))
                                   + "; it goes on from " + where);
    if (last.ranks != ranks_.count()) {
        callbacks_.on_resume(ranks_.change_text(last.ranks));
    }
}

// Puts the simulation at the last whole frame of the folder, and gives its number.
template <int Dim>
int Run<Dim>::resume_folder() {
    ranks_.agree([&] {
        for (int body = 0; body < simulation_.body_count(); ++body) {
            const bool has_died_early = folder_.has_list() && before_.frames.empty();
            if (has_died_early && !fs::exists(path(mesh_file(name_of(body))))) {
                throw nothing_to_resume(options_.folder);
            }
        }
    });
    for (int body = 0; body < simulation_.body_count(); ++body) {
        mesh_crcs_.push_back(meshes_.compare(path(mesh_file(name_of(body))), simulation_, body));
    }
    Resumption<Dim> found;
    ranks_.agree([&] {
        found = find_resumption<Dim>({.scene = scene_,
                                      .folder = options_.folder,
                                      .has_list = folder_.has_list(),
                                      .mesh_crcs = mesh_crcs_},
                                     simulation_, std::move(before_));
    });
    const int frame = found.frame;
    simulation_.restore(found.snapshot);
    ranks_.write([&] { take_over(std::move(found)); });
    return frame;
}

template <int Dim>
void Run<Dim>::take_over(Resumption<Dim> found) {
    const int frame = found.frame;
    tell_resume(found);
    if (!folder_.has_list()) {
        for (const std::string& name : files_of_old_run(names_of_bodies(scene_), frame)) {
            if (fs::exists(path(name))) {
                folder_.adopt(name);
            }
        }
    }
    folder_.remove_temporaries();
    folder_.remove(checkpoint_file(frame - 2));  // a run may have died before it did that
    if (!found.carried.is_empty()) {             // that of an old run is in other files
        write_checkpoint(folder_.claim(checkpoint_file(frame)), static_cast<std::uint64_t>(frame),
                         step_of(scene_, frame), found.carried);
        found.history.has_checkpoint.back() = true;
    }
    write_text(folder_.claim(kJournalFile), journal_text(found.history));
    report_.parts = std::move(found.history.parts);
    report_.frames = std::move(found.history.frames);
    report_.steps = std::move(found.history.steps);
}

template <int Dim>
void Run<Dim>::write_frame_files(int frame) {
    ranks_.write([&] { begin_frame(frame); });
    for (int body = 0; body < simulation_.body_count(); ++body) {
        write_frame_of(body, frame);
    }
    ranks_.write([&] { end_frame(frame); });
}

// A frame is in the journal before it has files, and has all others before those of bodies: where
// these are, a run that is resumed finds the frame whole.
template <int Dim>
void Run<Dim>::begin_frame(int frame) {
    const StateBlocks carried = carried_state(simulation_, names_of_bodies(scene_));
    report_.frames.push_back(frame_report(simulation_, names_of_bodies(scene_), frame));
    report_.parts.back().last_frame = frame;
    lines_ += frame_line(report_.frames.back(), !carried.is_empty(), seconds());
    append_text(path(kJournalFile), std::exchange(lines_, ""));
    if (!carried.is_empty()) {
        write_checkpoint(folder_.claim(checkpoint_file(frame)), static_cast<std::uint64_t>(frame),
                         simulation_.step_count(), carried);
    }
    if (do_obstacles_move()) {
        write_obstacles(folder_.claim(obstacles_file(frame)), simulation_.obstacles());
    }
    if (scene_.output.contact_pairs) {
        write_text(folder_.claim(contacts_file(frame)),
                   contact_table(simulation_, names_of_bodies(scene_)));
    }
    for (int body = 0; body < simulation_.body_count(); ++body) {
        static_cast<void>(folder_.claim(frame_file(name_of(body), frame)));
    }
}

// Each rank copies and writes the vertices of its slab alone.
template <int Dim>
void Run<Dim>::write_frame_of(int body, int frame) {
    const auto [first, last] = ranks_.slab_of(simulation_.positions(body).cols());
    Frame<Dim> slab = frame_slab(simulation_, scene_.output.vertex, body, first, last);
    slab.mesh_name = name_of(body) + ".pent";
    slab.mesh_crc = mesh_crcs_[static_cast<std::size_t>(body)];
    slab.frame = static_cast<std::uint64_t>(frame);
    write_frame(path(frame_file(name_of(body), frame)), slab,
                {.created_by = options_.created_by, .writers = ranks_.writers()});
}

// Two checkpoints are kept: if the last frame is damaged, a run goes on from the one before.
template <int Dim>
void Run<Dim>::end_frame(int frame) {
    folder_.remove(checkpoint_file(frame - 2));
    if (callbacks_.on_frame) {
        callbacks_.on_frame(report_.frames.back(),
                            report_.steps.empty() ? StepReport{} : report_.steps.back());
    }
}

// Takes the steps of one frame; false if the run ends within.
template <int Dim>
bool Run<Dim>::step_to_frame(int frame) {
    while (simulation_.step_count() < step_of(scene_, frame)) {
        if (ranks_.any(callbacks_.should_stop && callbacks_.should_stop())) {
            report_.verdict = RunVerdict::Stopped;
            return false;
        }
        const StepReport step = simulation_.step();
        if (!step.is_accepted) {
            report_.verdict = RunVerdict::Diverged;
            report_.message = "step " + std::to_string(simulation_.step_count() + 1) + ": "
                              + step.failure + ", also in steps cut "
                              + std::to_string(scene_.solver.max_halvings) + " times; "
                              + remedy(scene_, step.failure, doubts_of_units(scene_, simulation_));
            return false;
        }
        report_.steps.push_back(step);
        lines_ += step_line(step);
    }
    return true;
}

template <int Dim>
void Run<Dim>::write_report() {
    const Clock::time_point start = Clock::now();
    report_.parts.back().seconds = seconds();
    report_.seconds = 0;
    for (const RunPart& part : report_.parts) {
        report_.seconds += part.seconds;
    }
    for (std::size_t body = 0; body < report_.bodies.size(); ++body) {
        double& most = report_.bodies[body].non_rigid_max;
        for (const FrameReport& frame : report_.frames) {
            most = std::max(most, frame.non_rigid[body].value);
        }
    }
    write_text(folder_.claim(kReportFile), report_text(report_));
    if (scene_.output.balance) {
        write_text(folder_.claim(kBalanceFile), balance_table(report_.steps, scene_.dimension));
    }
    last_report_ = Clock::now();
    report_pause_ = report_pause(seconds_from(start, last_report_));
}

template <int Dim>
RunReport Run<Dim>::operator()() {
    if (callbacks_.on_warning && ranks_.is_writer()) {
        std::for_each(report_.warnings.begin(), report_.warnings.end(), callbacks_.on_warning);
    }
    int frame = options_.resume ? resume_folder() : 0;
    ranks_.write([&] {
        if (options_.resume) {
            begin_part(frame);
            write_scene();
        } else {
            start_folder();
            begin_part(0);
            write_scene();
        }
    });
    if (!options_.resume) {
        write_meshes();
        write_frame_files(0);
    }
    meshes_.let_go();
    ranks_.write([&] { write_report(); });
    while (frame < scene_.frames && step_to_frame(frame + 1)) {
        ++frame;
        write_frame_files(frame);
        ranks_.write([&] {
            if (seconds_from(last_report_, Clock::now()) > report_pause_) {
                write_report();  // GCOVR_EXCL_LINE: of runs longer than a test may be
            }
        });
    }
    if (report_.verdict == RunVerdict::Running) {
        report_.verdict = RunVerdict::Finished;
    }
    ranks_.write([&] {
        report_.parts.back().verdict = report_.verdict;
        report_.penetration = deep_penetration(scene_, report_);
        write_report();
        append_text(path(kJournalFile), end_line(report_.parts.back()));
    });
    return std::move(report_);
}

// A scene that its barrier refuses leaves the cells that are in each other's way beside the folder.
template <int Dim>
RunReport run_in(const Scene& scene, const RunOptions& options, const RunCallbacks& callbacks) {
    const RunRanks ranks(options.ranks.get());
    RunOptions chosen = options;
    Journal before;
    if (options.resume) {
        ranks.agree([&] { before = read_earlier_parts(scene, options.folder); });
    }
    if (options.isa.empty() && !before.parts.empty()) {
        chosen.isa = before.parts.back().isa;  // frames agree to the bit on one only
    }
    try {
        return Run<Dim>(scene, chosen, callbacks, std::move(before))();
    } catch (const CrossingError<Dim>& error) {
        const std::string created_by = options.created_by + ", cells that cross";
        const std::string path = crossings_path(options.folder, created_by).string();
        ranks.write([&] { write_mesh<Dim>(path, error.offenders(), {.created_by = created_by}); });
        throw Error(std::string(error.what()) + "; " + path + " has the cells; place them apart,"
                      " or let contact have model = \"penalty\"");
    }
}

}  // namespace

RunReport run(const Scene& scene, const RunOptions& options, const RunCallbacks& callbacks) {
    check(scene);
    return scene.dimension == 3 ? run_in<3>(scene, options, callbacks)
                                : run_in<4>(scene, options, callbacks);
}

}  // namespace pent::runs
