#include "contact_table.h"
#include "rest_file.h"
#include "resume.h"
#include "rigid_fit.h"
#include "run_report.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/output_file.h>
#include <pent/pent_file.h>
#include <pent/simulator/crossing_error.h>
#include <pent/simulator/run.h>
#include <pent/simulator/scene_file.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <optional>

namespace pent::simulator {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Between two writings of report.json while a run goes on.
constexpr double kReportSeconds = 10;

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

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
    Run(const Scene& scene, const RunOptions& options, const RunCallbacks& callbacks)
        : scene_(scene),
          options_(options),
          callbacks_(callbacks),
          scene_text_(scene_text(relocated(scene, options.folder))),
          simulation_(scene, read_meshes(), {.threads = options.threads, .isa = options.isa}) {
        report_.size = simulation_.size();
        report_.isa = simulation_.isa();
        report_.warnings = simulation_.warnings();
        for (const Body& body : scene.bodies) {
            report_.bodies.push_back(body.name);
        }
    }

    RunReport operator()();

private:
    [[nodiscard]] std::vector<SimplexMesh<Dim>> read_meshes() const;
    [[nodiscard]] fs::path mesh_path(const std::string& body) const {
        return options_.folder / "meshes" / (body + ".pent");
    }
    [[nodiscard]] fs::path frame_path(const std::string& body, int frame) const {
        return numbered("frames", body, frame);
    }
    [[nodiscard]] fs::path checkpoint_path(const std::string& body, int frame) const {
        return numbered("checkpoint", body, frame);
    }
    [[nodiscard]] std::uint64_t step_of(int frame) const {
        return static_cast<std::uint64_t>(frame)
               * static_cast<std::uint64_t>(scene_.steps_per_frame);
    }
    [[nodiscard]] fs::path numbered(const char* part, const std::string& body, int frame) const;
    void start_folder();
    void write_meshes();
    int resume_folder();
    [[nodiscard]] std::optional<std::vector<Frame<Dim>>> read_frames(int frame) const;
    void write_frame_files(int frame);
    [[nodiscard]] fs::path rest_path(int frame) const;
    void write_checkpoint(int frame);
    void remove_checkpoint(int frame);
    void resume_history(int frame);
    [[nodiscard]] Frame<Dim> frame_file(int body, int frame) const;
    [[nodiscard]] FrameReport measure(int frame) const;
    bool step_to_frame(int frame);
    void write_report(std::string_view verdict);

    const Scene& scene_;
    const RunOptions& options_;
    const RunCallbacks& callbacks_;
    std::string scene_text_;
    Simulation<Dim> simulation_;
    std::vector<std::uint32_t> mesh_crcs_;
    RunReport report_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_report_ = start_;
};

template <int Dim>
std::vector<SimplexMesh<Dim>> Run<Dim>::read_meshes() const {
    std::vector<SimplexMesh<Dim>> meshes;
    for (const Body& body : scene_.bodies) {
        meshes.push_back(read_mesh<Dim>(body.mesh).mesh);
    }
    return meshes;
}

template <int Dim>
fs::path Run<Dim>::numbered(const char* part, const std::string& body, int frame) const {
    return options_.folder / part / frame_file_name(body, frame);
}

template <int Dim>
void Run<Dim>::start_folder() {
    const fs::path& folder = options_.folder;
    std::error_code ignored;
    if (fs::exists(folder, ignored) && !fs::is_empty(folder, ignored)) {
        if (!options_.force) {
            throw Error(folder.string()
                        + ": is not empty; use another folder, --resume to go on with the run in"
                          " it, or --force to replace it");
        }
        for (const char* part :
             {"frames", "meshes", "contacts", "checkpoint", "report.json", "scene.toml"}) {
            fs::remove_all(folder / part, ignored);
        }
    }
    make_folder(folder / "frames");
    make_folder(folder / "meshes");
    write_text(folder / "scene.toml", scene_text_);
}

template <int Dim>
void Run<Dim>::write_meshes() {
    for (int body = 0; body < simulation_.body_count(); ++body) {
        const std::string& name = report_.bodies[static_cast<std::size_t>(body)];
        mesh_crcs_.push_back(write_mesh(mesh_path(name), simulation_.mesh(body),
                                        {.created_by = options_.created_by}));
    }
}

// All bodies at one frame, if every file is there and whole.
template <int Dim>
std::optional<std::vector<Frame<Dim>>> Run<Dim>::read_frames(int frame) const {
    std::vector<Frame<Dim>> frames;
    for (const std::string& name : report_.bodies) {
        if (!fs::exists(frame_path(name, frame))) {
            return std::nullopt;
        }
        frames.push_back(read_own_frame<Dim>(frame_path(name, frame), mesh_crcs_[frames.size()],
                                             static_cast<std::uint64_t>(frame), step_of(frame)));
    }
    return frames;
}

// Puts the simulation at the last whole frame of the folder, and gives its number.
template <int Dim>
int Run<Dim>::resume_folder() {
    const fs::path scene_path = options_.folder / "scene.toml";
    if (!fs::exists(scene_path)) {
        throw Error(options_.folder.string() + ": holds no run to resume (no scene.toml)");
    }
    check_same_scene(scene_path, scene_text_);
    for (int body = 0; body < simulation_.body_count(); ++body) {
        const std::string& name = report_.bodies[static_cast<std::size_t>(body)];
        mesh_crcs_.push_back(check_same_mesh<Dim>(mesh_path(name), simulation_.mesh(body)));
    }
    int frame = scene_.frames;
    std::optional<std::vector<Frame<Dim>>> frames = read_frames(frame);
    while (!frames && frame > 0) {
        frames = read_frames(--frame);
    }
    if (!frames) {
        throw Error(options_.folder.string()
                    + ": holds no whole frame to resume from; use --force to start again");
    }
    for (int body = 0; body < simulation_.body_count(); ++body) {
        const Frame<Dim>& state = (*frames)[static_cast<std::size_t>(body)];
        simulation_.set_state(body, state.positions, state.velocities);
    }
    const std::uint64_t step = frames->front().step;
    simulation_.set_step_count(step);
    resume_history(frame);
    if (scene_.sleep) {
        simulation_.set_rest(read_rest(rest_path(frame), report_.bodies));
    }
    const fs::path report_path = options_.folder / "report.json";
    if (fs::exists(report_path)) {
        ReportHistory history = parse_history(read_text(report_path), report_path.string(),
                                              report_.bodies, frame, step);
        report_.frames = std::move(history.frames);
        report_.steps = std::move(history.steps);
    }
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
Frame<Dim> Run<Dim>::frame_file(int body, int frame) const {
    Frame<Dim> file;
    file.mesh_name = report_.bodies[static_cast<std::size_t>(body)] + ".pent";
    file.mesh_crc = mesh_crcs_[static_cast<std::size_t>(body)];
    file.frame = static_cast<std::uint64_t>(frame);
    file.step = simulation_.step_count();
    file.time = simulation_.time();
    return file;
}

// What a frame does not hold: who sleeps, and for BDF2 the state one step before.
template <int Dim>
void Run<Dim>::write_checkpoint(int frame) {
    if (scene_.sleep || simulation_.has_history()) {
        make_folder(options_.folder / "checkpoint");
    }
    if (scene_.sleep) {
        write_rest(rest_path(frame), report_.bodies, simulation_.rest());
    }
    if (!simulation_.has_history()) {
        return;
    }
    for (int body = 0; body < simulation_.body_count(); ++body) {
        Frame<Dim> file = frame_file(body, frame);
        file.positions = simulation_.previous_positions(body);
        file.velocities = simulation_.previous_velocities(body);
        write_frame(checkpoint_path(report_.bodies[static_cast<std::size_t>(body)], frame), file,
                    {.created_by = options_.created_by});
    }
}

template <int Dim>
fs::path Run<Dim>::rest_path(int frame) const {
    return fs::path(numbered("checkpoint", "rest", frame)).replace_extension(".json");
}

template <int Dim>
void Run<Dim>::remove_checkpoint(int frame) {
    std::error_code ignored;
    fs::remove(rest_path(frame), ignored);
    for (const std::string& body : report_.bodies) {
        fs::remove(checkpoint_path(body, frame), ignored);
    }
}

template <int Dim>
void Run<Dim>::resume_history(int frame) {
    for (int body = 0; body < simulation_.body_count(); ++body) {
        const auto i = static_cast<std::size_t>(body);
        const fs::path path = checkpoint_path(report_.bodies[i], frame);
        if (!fs::exists(path)) {
            if (fs::exists(checkpoint_path(report_.bodies[i], frame + 2))) {
                throw Error(path.string() + ": is not kept so far back; put the later frames back, or"
                                            " use --force to start again");
            }
            return;  // there was none: the step before was the first, or cut in two
        }
        const Frame<Dim> before = read_own_frame<Dim>(
            path, mesh_crcs_[i], static_cast<std::uint64_t>(frame), step_of(frame));
        simulation_.set_history(body, before.positions, before.velocities);
    }
}

// Two checkpoints are kept: should the last frame be damaged, the one before is there to resume from.
template <int Dim>
void Run<Dim>::write_frame_files(int frame) {
    write_checkpoint(frame);
    for (int body = 0; body < simulation_.body_count(); ++body) {
        Frame<Dim> file = frame_file(body, frame);
        file.positions = simulation_.positions(body);
        file.velocities = simulation_.velocities(body);
        if (scene_.output.contact_forces) {
            file.contact_forces = simulation_.contact_forces(body);
        }
        write_frame(frame_path(report_.bodies[static_cast<std::size_t>(body)], frame), file,
                    {.created_by = options_.created_by});
    }
    if (scene_.output.contact_pairs) {
        make_folder(options_.folder / "contacts");
        write_text(options_.folder / "contacts" / formatted("%06d.csv", frame),
                   contact_table(simulation_, report_.bodies));
    }
    remove_checkpoint(frame - 2);
    report_.frames.push_back(measure(frame));
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
                              + std::to_string(scene_.solver.max_halvings)
                              + " times; try more steps_per_frame, stiffer or slower motion, or"
                                " solver.max_iterations";
            return false;
        }
        report_.steps.push_back(step);
    }
    return true;
}

template <int Dim>
void Run<Dim>::write_report(std::string_view verdict) {
    last_report_ = Clock::now();
    report_.seconds = std::chrono::duration<double>(last_report_ - start_).count();
    write_text(options_.folder / "report.json",
               report_text(report_, verdict, options_.created_by, options_.threads));
}

template <int Dim>
RunReport Run<Dim>::operator()() {
    if (callbacks_.on_warning) {
        std::for_each(report_.warnings.begin(), report_.warnings.end(), callbacks_.on_warning);
    }
    int frame = 0;
    if (options_.resume) {
        frame = resume_folder();
        remove_temporaries(options_.folder);
        write_text(options_.folder / "scene.toml", scene_text_);
    } else {
        start_folder();
        write_meshes();
        write_frame_files(0);
    }
    write_report("running");
    while (frame < scene_.frames && step_to_frame(frame + 1)) {
        write_frame_files(++frame);
        if (std::chrono::duration<double>(Clock::now() - last_report_).count() > kReportSeconds) {
            write_report("running");  // GCOVR_EXCL_LINE: of runs longer than a test may be
        }
    }
    write_report(verdict_name(report_.verdict));
    return std::move(report_);
}

// A scene that its barrier refuses leaves the cells that are in each other's way beside the folder.
template <int Dim>
RunReport run_in(const Scene& scene, const RunOptions& options, const RunCallbacks& callbacks) {
    try {
        return Run<Dim>(scene, options, callbacks)();
    } catch (const CrossingError<Dim>& error) {
        const std::string path = options.folder.string() + "-crossings.pent";
        write_mesh<Dim>(path, error.offenders(), {.created_by = options.created_by});
        throw Error(std::string(error.what()) + "; " + path + " has the cells");
    }
}

}  // namespace

RunReport run(const Scene& scene, const RunOptions& options, const RunCallbacks& callbacks) {
    check(scene);
    RunOptions chosen = options;
    if (options.resume && options.isa.empty()) {
        chosen.isa = isa_of_run(options.folder);
    }
    if (scene.dimension == 3) {
        return run_in<3>(scene, chosen, callbacks);
    }
    return run_in<4>(scene, chosen, callbacks);
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
