#include "run/resumption.h"

#include "record/checkpoint_file.h"
#include "run/earlier_run.h"
#include "run/resume.h"

#include <pent/error.h>
#include <pent/run_files.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace pent::runs {

namespace fs = std::filesystem;

namespace {

// Finds the last whole frame of a run, and what it takes to go on behind it.
template <int Dim>
class Finder {
public:
    Finder(const RunInFolder& run, const Simulation<Dim>& simulation, Journal history)
        : run_(run),
          simulation_(simulation),
          history_(std::move(history)),
          bodies_(names_of_bodies(run.scene)) {}

    Resumption<Dim> operator()();

private:
    using Bodies = std::vector<Frame<Dim>>;

    [[nodiscard]] fs::path path(const std::string& name) const { return run_.folder / name; }
    [[nodiscard]] int last_known_frame() const;
    [[nodiscard]] std::optional<Bodies> read_frames(int frame) const;
    [[nodiscard]] StateBlocks carried_state_at(int frame) const;
    [[nodiscard]] Snapshot<Dim> snapshot_of(const Bodies& frames, const StateBlocks& carried) const;
    void complete_history(int last_frame);

    const RunInFolder& run_;
    const Simulation<Dim>& simulation_;
    Journal history_;
    std::vector<std::string> bodies_;
};

// All bodies at one frame, if every file is there and whole.
template <int Dim>
std::optional<std::vector<Frame<Dim>>> Finder<Dim>::read_frames(int frame) const {
    Bodies frames;
    for (const std::string& name : bodies_) {
        const fs::path file = path(frame_file(name, frame));
        if (!fs::exists(file)) {
            return std::nullopt;
        }
        frames.push_back(read_own_frame<Dim>(file, run_.mesh_crcs[frames.size()],
                                             static_cast<std::uint64_t>(frame),
                                             step_of(run_.scene, frame)));
    }
    return frames;
}

// Nothing behind it can be whole: a frame is in the journal before its files are written.
template <int Dim>
int Finder<Dim>::last_known_frame() const {
    const int known = !history_.frames.empty() ? history_.frames.back().frame : 0;
    return run_.has_list ? known : std::max(known, run_.scene.frames);
}

template <int Dim>
StateBlocks Finder<Dim>::carried_state_at(int frame) const {
    if (!run_.has_list) {
        return carried_state_of_old_run<Dim>(run_.folder, bodies_, run_.mesh_crcs, run_.scene,
                                             frame);
    }
    const auto& frames = history_.frames;
    const auto found = std::find_if(frames.begin(), frames.end(), [&](const FrameReport& report) {
        return report.frame == frame;
    });
    const auto place = static_cast<std::size_t>(found - frames.begin());
    return found != frames.end() && history_.has_checkpoint[place]
               ? read_checkpoint(path(checkpoint_file(frame)), static_cast<std::uint64_t>(frame),
                                 step_of(run_.scene, frame))
               : StateBlocks();
}

// Measures frames that the journal does not have: a run of version 0.1.0 that was killed lost the
// statistics of its last seconds.
template <int Dim>
void Finder<Dim>::complete_history(int last_frame) {
    history_.cut(last_frame);
    for (int frame = 0; frame <= last_frame; ++frame) {
        const auto place = static_cast<std::size_t>(frame);
        if (place < history_.frames.size() && history_.frames[place].frame == frame) {
            continue;
        }
        const std::optional<Bodies> files = read_frames(frame);
        if (!files) {
            throw Error(path(frame_file(bodies_[0], frame)).string()
                        + ": is missing, and the run has no statistics of it; put it back, or use"
                          " --force to start again");
        }
        FrameReport report{.frame = frame,
                           .step = step_of(run_.scene, frame),
                           .time = files->front().time,
                           .non_rigid = {}};
        for (int body = 0; body < simulation_.body_count(); ++body) {
            const auto of = static_cast<std::size_t>(body);
            const double value = non_rigid<Dim>(simulation_.mesh(body).positions,
                                                (*files)[of].positions, simulation_.masses(body));
            report.non_rigid.push_back({bodies_[of], value});
        }
        history_.frames.insert(history_.frames.begin() + frame, std::move(report));
        history_.has_checkpoint.insert(history_.has_checkpoint.begin() + frame, false);
    }
}

template <int Dim>
Snapshot<Dim> Finder<Dim>::snapshot_of(const Bodies& frames, const StateBlocks& carried) const {
    Snapshot<Dim> snapshot = simulation_.save();
    for (int body = 0; body < simulation_.body_count(); ++body) {
        const Frame<Dim>& state = frames[static_cast<std::size_t>(body)];
        const Eigen::Index first = simulation_.first_vertex(body);
        const Eigen::Index count = state.positions.cols();
        snapshot.positions.middleCols(first, count) = state.positions;
        snapshot.velocities.middleCols(first, count) = state.velocities;
    }
    snapshot.steps = frames.front().step;
    read_carried_state(carried, bodies_, simulation_, snapshot);
    return snapshot;
}

template <int Dim>
Resumption<Dim> Finder<Dim>::operator()() {
    int frame = last_known_frame();
    std::optional<Bodies> frames = read_frames(frame);
    while (!frames && frame > 0) {
        frames = read_frames(--frame);
    }
    if (!frames) {
        throw nothing_to_resume(run_.folder);
    }
    StateBlocks carried = carried_state_at(frame);
    Snapshot<Dim> snapshot = snapshot_of(*frames, carried);
    complete_history(frame);
    return {.frame = frame,
            .snapshot = std::move(snapshot),
            .carried = std::move(carried),
            .history = std::move(history_)};
}

}  // namespace

Error nothing_to_resume(const fs::path& folder) {
    return Error(folder.string()
                 + ": holds no whole frame to resume from; use --force to start again");
}

template <int Dim>
Resumption<Dim> find_resumption(const RunInFolder& run,
                                const Simulation<Dim>& simulation,
                                Journal history) {
    return Finder<Dim>(run, simulation, std::move(history))();
}

// Version 0.1.0 kept no list of its files: what has their names in a folder of this scene and these
// meshes is one of them.
std::vector<std::string> files_of_old_run(const std::vector<std::string>& bodies, int last_frame) {
    std::vector<std::string> names = {kSceneFile, kReportFile};
    for (const std::string& body : bodies) {
        names.push_back(mesh_file(body));
        for (int frame = 0; frame <= last_frame; ++frame) {
            names.push_back(frame_file(body, frame));
            names.push_back(old_checkpoint_file(body, frame));
        }
    }
    for (int frame = 0; frame <= last_frame; ++frame) {
        names.push_back(contacts_file(frame));
        names.push_back(old_sleep_file(frame));
    }
    return names;
}

template Resumption<3> find_resumption<3>(const RunInFolder&, const Simulation<3>&, Journal);
template Resumption<4> find_resumption<4>(const RunInFolder&, const Simulation<4>&, Journal);

}  // namespace pent::runs
