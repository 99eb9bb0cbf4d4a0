#include "checkpoint_file.h"
#include "contact_table.h"
#include "doubts.h"
#include "earlier_run.h"
#include "journal.h"
#include "model/rigid_fit.h"
#include "resume.h"
#include "run_files.h"
#include "run_report.h"
#include "scene_meshes.h"

#include <pent/error.h>
#include <pent/obstacles_file.h>
#include <pent/output_file.h>
#include <pent/output_folder.h>
#include <pent/pent_file.h>
#include <pent/simulator/crossing_error.h>
#include <pent/simulator/run.h>
#include <pent/simulator/scene_file.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

namespace pent::simulator {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Between two writings of report.json while a run goes on.
constexpr double kReportSeconds = 10;

// The scene as written in the run folder: mesh paths relative to that folder.
Scene relocated(const Scene& scene, const fs::path& folder) {
    Scene moved = scene;
    for (Body& body : moved.bodies) {
        body.mesh = fs::proximate(fs::absolute(body.mesh), fs::absolute(folder)).string();
    }
    return moved;
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
          folder_(options.folder, kRunFolder),
          meshes_(read_meshes<Dim>(scene)),
          simulation_(
              scene, std::move(meshes_.meshes), {.threads = options.threads, .isa = options.isa}) {
        report_.size = simulation_.size();
        report_.thinnest = thinnest_side(simulation_);
        report_.isa = simulation_.isa();
        report_.warnings = std::move(meshes_.warnings);
        for (const auto& lines : {simulation_.warnings(), doubts_of_units(scene, simulation_),
                                  overlaps_at_start(scene, simulation_)}) {
            report_.warnings.insert(report_.warnings.end(), lines.begin(), lines.end());
        }
        report_.bodies = names_of_bodies(scene);
    }

    RunReport operator()();

private:
    using Bodies = std::vector<Frame<Dim>>;

    [[nodiscard]] fs::path path(const std::string& name) const { return options_.folder / name; }
    [[nodiscard]] std::uint64_t step_of(int frame) const {
        return static_cast<std::uint64_t>(frame)
               * static_cast<std::uint64_t>(scene_.steps_per_frame);
    }
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(Clock::now() - start_).count();
    }
    void start_folder();
    void write_scene();
    void begin_part(int frame);
    void write_meshes();
    void adopt_old_run(int last_frame);
    [[nodiscard]] int resume_folder();
    [[nodiscard]] int last_known_frame() const;
    [[nodiscard]] std::optional<Bodies> read_frames(int frame) const;
    [[nodiscard]] StateBlocks carried_state_at(int frame) const;
    [[nodiscard]] Snapshot<Dim> snapshot_of(const Bodies& frames, const StateBlocks& carried) const;
    void complete_history(int last_frame);
    void tell_resume(int frame) const;
    void write_frame_files(int frame);
    [[nodiscard]] Frame<Dim> frame_header(int body, int frame) const;
    [[nodiscard]] FrameReport measure(int frame) const;
    bool step_to_frame(int frame);
    void write_report();

    const Scene& scene_;
    const RunOptions& options_;
    const RunCallbacks& callbacks_;
    Journal before_;
    OutputFolder folder_;
    SceneMeshes<Dim> meshes_;  // empty once the simulation has them
    Simulation<Dim> simulation_;
    std::vector<std::uint32_t> mesh_crcs_;
    std::string lines_;  // of the journal, to be written with the next frame
    RunReport report_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_report_ = start_;
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

// The scene that is being run stays as its author wrote it, wherever it is.
template <int Dim>
void Run<Dim>::write_scene() {
    const fs::path file = folder_.claim(kSceneFile);
    std::error_code ignored;
    if (!fs::equivalent(options_.scene_file, file, ignored)) {
        write_text(file, scene_text(relocated(scene_, options_.folder)));
    }
    std::vector<pent::Obstacle<Dim>> obstacles;
    for (const Obstacle& obstacle : scene_.obstacles) {
        obstacles.push_back(fixed_size<Dim>(obstacle.shape));
    }
    if (!obstacles.empty()) {
        write_obstacles(folder_.claim(kObstaclesFile), obstacles);
    }
}

template <int Dim>
void Run<Dim>::begin_part(int frame) {
    report_.parts.push_back({.created_by = options_.created_by,
                             .threads = options_.threads,
                             .isa = report_.isa,
                             .first_frame = frame,
                             .last_frame = frame});
    append_text(folder_.claim(kJournalFile), part_line(report_.parts.back()));
}

template <int Dim>
void Run<Dim>::write_meshes() {
    for (int body = 0; body < simulation_.body_count(); ++body) {
        const std::string& name = report_.bodies[static_cast<std::size_t>(body)];
        mesh_crcs_.push_back(write_mesh(folder_.claim(mesh_file(name)), simulation_.mesh(body),
                                        {.created_by = options_.created_by}));
    }
}

// All bodies at one frame, if every file is there and whole.
template <int Dim>
std::optional<std::vector<Frame<Dim>>> Run<Dim>::read_frames(int frame) const {
    Bodies frames;
    for (const std::string& name : report_.bodies) {
        const fs::path file = path(frame_file(name, frame));
        if (!fs::exists(file)) {
            return std::nullopt;
        }
        frames.push_back(read_own_frame<Dim>(file, mesh_crcs_[frames.size()],
                                             static_cast<std::uint64_t>(frame), step_of(frame)));
    }
    return frames;
}

// Version 0.1.0 kept no list of its files: what has their names in a folder of this scene and these
// meshes is one of them.
template <int Dim>
void Run<Dim>::adopt_old_run(int last_frame) {
    std::vector<std::string> names = {kSceneFile, kReportFile};
    for (const std::string& body : report_.bodies) {
        names.push_back(mesh_file(body));
        for (int frame = 0; frame <= last_frame; ++frame) {
            names.push_back(frame_file(body, frame));
            names.push_back("checkpoint/" + frame_file_name(body, frame));
        }
    }
    for (int frame = 0; frame <= last_frame; ++frame) {
        names.push_back(contacts_file(frame));
        names.push_back(formatted("checkpoint/rest_%06d.json", frame));
    }
    for (const std::string& name : names) {
        if (fs::exists(path(name))) {
            folder_.adopt(name);
        }
    }
}

// Nothing behind it can be whole: a frame is in the journal before its files are written.
template <int Dim>
int Run<Dim>::last_known_frame() const {
    const int known = !before_.frames.empty() ? before_.frames.back().frame : 0;
    return folder_.has_list() ? known : std::max(known, scene_.frames);
}

template <int Dim>
StateBlocks Run<Dim>::carried_state_at(int frame) const {
    if (!folder_.has_list()) {
        return carried_state_of_old_run<Dim>(options_.folder, report_.bodies, mesh_crcs_, scene_,
                                             frame);
    }
    const auto& frames = before_.frames;
    const auto found = std::find_if(frames.begin(), frames.end(), [&](const FrameReport& report) {
        return report.frame == frame;
    });
    const auto place = static_cast<std::size_t>(found - frames.begin());
    return found != frames.end() && before_.has_checkpoint[place] ? read_checkpoint(
               path(checkpoint_file(frame)), static_cast<std::uint64_t>(frame), step_of(frame))
                                                                  : StateBlocks();
}

// Measures frames that the journal does not have: a run of version 0.1.0 that was killed lost the
// statistics of its last seconds.
template <int Dim>
void Run<Dim>::complete_history(int last_frame) {
    before_.cut(last_frame);
    for (int frame = 0; frame <= last_frame; ++frame) {
        const auto place = static_cast<std::size_t>(frame);
        if (place < before_.frames.size() && before_.frames[place].frame == frame) {
            continue;
        }
        const std::optional<Bodies> files = read_frames(frame);
        if (!files) {
            throw Error(path(frame_file(report_.bodies[0], frame)).string()
                        + ": is missing, and the run has no statistics of it; put it back, or use"
                          " --force to start again");
        }
        FrameReport report{
            .frame = frame, .step = step_of(frame), .time = files->front().time, .non_rigid = {}};
        for (int body = 0; body < simulation_.body_count(); ++body) {
            report.non_rigid.push_back(non_rigid<Dim>(
                simulation_.mesh(body).positions,
                (*files)[static_cast<std::size_t>(body)].positions, simulation_.masses(body)));
        }
        before_.frames.insert(before_.frames.begin() + frame, std::move(report));
        before_.has_checkpoint.insert(before_.has_checkpoint.begin() + frame, false);
    }
}

template <int Dim>
void Run<Dim>::tell_resume(int frame) const {
    if (!callbacks_.on_resume || before_.parts.empty()) {
        return;
    }
    const RunPart& last = before_.parts.back();
    const std::string where = "frame " + std::to_string(frame);
    callbacks_.on_resume(last.verdict == "died"
                             ? "the run had died (it was killed or crashed) behind " + where
                                   + "; it goes on from there"
                             : "the run had " + last.verdict + "; it goes on from " + where);
}

template <int Dim>
Snapshot<Dim> Run<Dim>::snapshot_of(const Bodies& frames, const StateBlocks& carried) const {
    Snapshot<Dim> snapshot = simulation_.save();
    for (int body = 0; body < simulation_.body_count(); ++body) {
        const Frame<Dim>& state = frames[static_cast<std::size_t>(body)];
        const Eigen::Index first = simulation_.first_vertex(body);
        const Eigen::Index count = state.positions.cols();
        snapshot.positions.middleCols(first, count) = state.positions;
        snapshot.velocities.middleCols(first, count) = state.velocities;
    }
    snapshot.steps = frames.front().step;
    read_carried_state(carried, report_.bodies, simulation_, snapshot);
    return snapshot;
}

// Puts the simulation at the last whole frame of the folder, and gives its number.
template <int Dim>
int Run<Dim>::resume_folder() {
    for (int body = 0; body < simulation_.body_count(); ++body) {
        const std::string& name = report_.bodies[static_cast<std::size_t>(body)];
        mesh_crcs_.push_back(check_same_mesh<Dim>(path(mesh_file(name)), simulation_.mesh(body)));
    }
    int frame = last_known_frame();
    std::optional<Bodies> frames = read_frames(frame);
    while (!frames && frame > 0) {
        frames = read_frames(--frame);
    }
    if (!frames) {
        throw Error(options_.folder.string()
                    + ": holds no whole frame to resume from; use --force to start again");
    }
    const StateBlocks carried = carried_state_at(frame);
    simulation_.restore(snapshot_of(*frames, carried));
    complete_history(frame);
    tell_resume(frame);
    if (!folder_.has_list()) {
        adopt_old_run(frame);
    }
    folder_.remove_temporaries();
    if (!carried.is_empty()) {  // that of an old run is in other files
        write_checkpoint(folder_.claim(checkpoint_file(frame)), static_cast<std::uint64_t>(frame),
                         step_of(frame), carried);
        before_.has_checkpoint.back() = true;
    }
    write_text(folder_.claim(kJournalFile), journal_text(before_, report_.bodies));
    report_.parts = std::move(before_.parts);
    report_.frames = std::move(before_.frames);
    report_.steps = std::move(before_.steps);
    return frame;
}

template <int Dim>
FrameReport Run<Dim>::measure(int frame) const {
    FrameReport report;
    report.frame = frame;
    report.step = simulation_.step_count();
    report.time = simulation_.time();
    for (int body = 0; body < simulation_.body_count(); ++body) {
        report.non_rigid.push_back(non_rigid<Dim>(simulation_.mesh(body).positions,
                                                  simulation_.positions(body),
                                                  simulation_.masses(body)));
    }
    return report;
}

template <int Dim>
Frame<Dim> Run<Dim>::frame_header(int body, int frame) const {
    Frame<Dim> file;
    file.mesh_name = report_.bodies[static_cast<std::size_t>(body)] + ".pent";
    file.mesh_crc = mesh_crcs_[static_cast<std::size_t>(body)];
    file.frame = static_cast<std::uint64_t>(frame);
    file.step = simulation_.step_count();
    file.time = simulation_.time();
    return file;
}

// Two checkpoints are kept: should the last frame be damaged, the one before is there to resume
// from.
template <int Dim>
void Run<Dim>::write_frame_files(int frame) {
    const StateBlocks carried = carried_state(simulation_, report_.bodies);
    report_.frames.push_back(measure(frame));
    report_.parts.back().last_frame = frame;
    lines_ += frame_line(report_.frames.back(), report_.bodies, !carried.is_empty(), seconds());
    append_text(path(kJournalFile), std::exchange(lines_, ""));
    if (!carried.is_empty()) {
        write_checkpoint(folder_.claim(checkpoint_file(frame)), static_cast<std::uint64_t>(frame),
                         simulation_.step_count(), carried);
    }
    for (int body = 0; body < simulation_.body_count(); ++body) {
        Frame<Dim> file = frame_header(body, frame);
        file.positions = simulation_.positions(body);
        file.velocities = simulation_.velocities(body);
        if (scene_.output.contact_forces) {
            file.contact_forces = simulation_.contact_forces(body);
        }
        const std::string& name = report_.bodies[static_cast<std::size_t>(body)];
        write_frame(folder_.claim(frame_file(name, frame)), file,
                    {.created_by = options_.created_by});
    }
    if (scene_.output.contact_pairs) {
        write_text(folder_.claim(contacts_file(frame)), contact_table(simulation_, report_.bodies));
    }
    folder_.remove(checkpoint_file(frame - 2));
    if (callbacks_.on_frame) {
        callbacks_.on_frame(report_.frames.back(),
                            report_.steps.empty() ? StepReport{} : report_.steps.back());
    }
}

// Takes the steps of one frame; false if the run ends within.
template <int Dim>
bool Run<Dim>::step_to_frame(int frame) {
    while (simulation_.step_count() < step_of(frame)) {
        if (callbacks_.should_stop && callbacks_.should_stop()) {
            report_.verdict = RunVerdict::Stopped;
            return false;
        }
        const StepReport step = simulation_.step();
        if (!step.is_accepted) {
            report_.verdict = RunVerdict::Diverged;
            report_.message = "step " + std::to_string(simulation_.step_count() + 1) + ": "
                              + step.failure + ", also in steps cut "
                              + std::to_string(scene_.solver.max_halvings) + " times; "
                              + remedy(step.failure, doubts_of_units(scene_, simulation_));
            return false;
        }
        report_.steps.push_back(step);
        lines_ += step_line(step);
    }
    return true;
}

template <int Dim>
void Run<Dim>::write_report() {
    last_report_ = Clock::now();
    report_.parts.back().seconds = seconds();
    report_.seconds = 0;
    for (const RunPart& part : report_.parts) {
        report_.seconds += part.seconds;
    }
    write_text(folder_.claim(kReportFile), report_text(report_));
}

template <int Dim>
RunReport Run<Dim>::operator()() {
    if (callbacks_.on_warning) {
        std::for_each(report_.warnings.begin(), report_.warnings.end(), callbacks_.on_warning);
    }
    int frame = 0;
    if (options_.resume) {
        frame = resume_folder();
        begin_part(frame);
        write_scene();
    } else {
        start_folder();
        begin_part(0);
        write_scene();
        write_meshes();
        write_frame_files(0);
    }
    write_report();
    while (frame < scene_.frames && step_to_frame(frame + 1)) {
        write_frame_files(++frame);
        if (std::chrono::duration<double>(Clock::now() - last_report_).count() > kReportSeconds) {
            write_report();  // GCOVR_EXCL_LINE: of runs longer than a test may be
        }
    }
    report_.parts.back().verdict = verdict_name(report_.verdict);
    report_.penetration = deep_penetration(scene_, report_);
    write_report();
    append_text(path(kJournalFile), end_line(report_.parts.back()));
    return std::move(report_);
}

// A scene that its barrier refuses leaves the cells that are in each other's way beside the folder.
template <int Dim>
RunReport run_in(const Scene& scene, const RunOptions& options, const RunCallbacks& callbacks) {
    RunOptions chosen = options;
    Journal before;
    if (options.resume) {
        before = read_earlier_parts(scene, options.folder);
    }
    if (options.isa.empty() && !before.parts.empty()) {
        chosen.isa = before.parts.back().isa;  // frames agree to the bit on one only
    }
    try {
        return Run<Dim>(scene, chosen, callbacks, std::move(before))();
    } catch (const CrossingError<Dim>& error) {
        const std::string created_by = options.created_by + ", cells that cross";
        const std::string path = crossings_path(options.folder, created_by).string();
        write_mesh<Dim>(path, error.offenders(), {.created_by = created_by});
        throw Error(std::string(error.what()) + "; " + path + " has the cells");
    }
}

}  // namespace

RunReport run(const Scene& scene, const RunOptions& options, const RunCallbacks& callbacks) {
    check(scene);
    return scene.dimension == 3 ? run_in<3>(scene, options, callbacks)
                                : run_in<4>(scene, options, callbacks);
}

std::string_view verdict_name(RunVerdict verdict) {
    switch (verdict) {
        case RunVerdict::Finished:
            return "finished";
        case RunVerdict::Stopped:
            return "stopped";
        case RunVerdict::Diverged:
            break;
    }
    return "diverged";
}

}  // namespace pent::simulator
