#pragma once

#include <pent/simulator/scene.h>
#include <pent/simulator/simulation.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace pent::simulator {

/// Runs of whole scenes into a folder:
///
///     RUN/scene.toml                the scene as run, defaults filled in
///     RUN/meshes/BODY.pent          the mesh as placed
///     RUN/frames/BODY_000123.pent   positions and velocities; frame 0 is the start
///     RUN/contacts/000123.csv       every pair in contact, if the scene asks for them
///     RUN/checkpoint/               what bdf2 needs beside the last frame to go on
///     RUN/report.json               verdict and statistics of every step and frame

struct RunOptions {
    std::filesystem::path folder = {};
    bool force = false;                   ///< Replace a run that is in the folder.
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

struct RunReport {
    RunVerdict verdict = RunVerdict::Finished;
    std::string message;                ///< Why a run diverged and what to try; empty otherwise.
    std::vector<std::string> warnings;  ///< Those of the simulation.
    SimulationSize size;
    std::string isa;
    std::vector<std::string> bodies;  ///< Names, in the order of the scene.
    std::vector<FrameReport> frames;  ///< Every frame in the folder, frame 0 included.
    std::vector<StepReport> steps;    ///< Every step behind them.
    double seconds = 0;               ///< Spent in this call.
};

struct RunCallbacks {
    /// Asked before every step; true ends the run with verdict Stopped.
    std::function<bool()> should_stop;
    /// Told of every frame written and the step before it (a default StepReport for frame 0).
    std::function<void(const FrameReport&, const StepReport&)> on_frame;
    /// Told, before the first step, each of Simulation::warnings().
    std::function<void(const std::string&)> on_warning = {};
};

/// Reads the meshes, simulates, and writes the folder as it goes.
///
/// Throws an Error for meshes that cannot be read or do not fit the scene, a folder that is in use
/// (without force or resume) or holds another scene (with resume), for files that cannot be written,
/// and for a start that crosses where [contact] is a barrier: FOLDER-crossings.pent then has the
/// cells in each other's way, a region for each body. What was written before stays: whole frames
/// and a report that says so.
[[nodiscard]] RunReport run(const Scene& scene,
                            const RunOptions& options,
                            const RunCallbacks& callbacks = {});

/// "finished", "stopped" or "diverged".
[[nodiscard]] std::string_view verdict_name(RunVerdict verdict);

}  // namespace pent::simulator
