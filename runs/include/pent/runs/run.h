#pragma once

#include <pent/simulator/scene.h>
#include <pent/simulator/simulation.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace pent::runs {

/// Runs of whole scenes into a folder:
///
///     RUN/scene.toml                the scene as run, defaults filled in
///     RUN/obstacles.json            the shapes of its obstacles, if there are any
///     RUN/meshes/BODY.pent          the mesh as placed
///     RUN/frames/BODY_000123.pent   positions and velocities; frame 0 is the start
///     RUN/contacts/000123.csv       every pair in contact, if the scene asks for them
///     RUN/checkpoint/000123.state   what it takes beside the last frames to go on behind them
///     RUN/journal.txt               what was done, frame by frame: where report.json comes from
///     RUN/report.json               verdict and statistics of every step and frame
///     RUN/written.txt               the files of the run: see OutputFolder

struct RunOptions {
    std::filesystem::path folder = {};
    bool force = false;  ///< Replace a run that is in the folder.
    std::filesystem::path scene_file =
        {};                               ///< Where the scene was read from, which is never written
                                          ///< to; empty if it was not. Meshes are not, either.
    bool resume = false;                  ///< Go on behind the last whole frame in the folder.
    int threads = 1;                      ///< At least 1.
    std::string isa = {};                 ///< As in SimulationOptions.
    std::string created_by = "pent-sim";  ///< Goes into the files.
};

enum class RunVerdict { Finished, Stopped, Diverged };

/// What is known when a frame has been written.
struct FrameReport {
    int frame = 0;
    std::uint64_t step = 0;
    double time = 0;                ///< s.
    std::vector<double> non_rigid;  ///< One a body, in the order of the scene: RMS distance to the
                                    ///< best-fitting rigid motion of the start over its RMS radius.
};

/// One call of run(): a run that was stopped and resumed has several.
struct RunPart {
    std::string created_by;
    int threads = 1;
    std::string isa;
    int first_frame = 0;  ///< The frame it went on from; 0 at the start.
    int last_frame = 0;   ///< The last that it wrote.
    double seconds = 0;   ///< Of a part that died: up to its last frame.
    std::string verdict =
        "running";  ///< "finished", "stopped", "diverged", or "died": it was killed or
                    ///< crashed.
};

struct RunReport {
    RunVerdict verdict = RunVerdict::Finished;
    std::string message;  ///< Why a run diverged and what to try; empty otherwise.
    /// How deep bodies went into something, and the stiffness that would do; empty where that stays
    /// below a tenth of the thinnest extent of a body.
    std::string penetration;
    /// Of meshes, settings, units, and of what overlaps at the start.
    std::vector<std::string> warnings;
    simulator::SimulationSize size;
    double thinnest = 0;  ///< Shortest side of the boxes around the bodies at rest, m.
    std::string isa;
    std::vector<std::string> bodies;           ///< Names, in the order of the scene.
    std::vector<FrameReport> frames;           ///< Every frame in the folder, frame 0 included.
    std::vector<simulator::StepReport> steps;  ///< Every step behind them.
    std::vector<RunPart> parts;                ///< The last is this call.
    double seconds = 0;                        ///< Spent in all parts.
};

struct RunCallbacks {
    /// Asked before every step; true ends the run with verdict Stopped.
    std::function<bool()> should_stop;
    /// Told of every frame written and the step before it (a default StepReport for frame 0).
    std::function<void(const FrameReport&, const simulator::StepReport&)> on_frame;
    /// Told, before the first step, each of RunReport::warnings.
    std::function<void(const std::string&)> on_warning = {};
    /// Told, before the first step of a run that is resumed, how it had ended and where it goes on.
    std::function<void(const std::string&)> on_resume = {};
};

/// Reads the meshes, simulates, and writes the folder as it goes.
///
/// Throws an Error for meshes that cannot be read or do not fit the scene, a folder that is in use
/// (without force or resume), is not of a run or holds what the scene reads (with force too), or
/// holds another scene (with resume), for files that cannot be written, and for a start that
/// crosses where [contact] is a barrier: FOLDER-crossings.pent (or a numbered name like it, if
/// another file has that) then has the cells in each other's way, a region for each body. What was
/// written before stays: whole frames and a report that says so.
[[nodiscard]] RunReport run(const simulator::Scene& scene,
                            const RunOptions& options,
                            const RunCallbacks& callbacks = {});

/// "finished", "stopped" or "diverged".
[[nodiscard]] std::string_view verdict_name(RunVerdict verdict);

}  // namespace pent::runs
