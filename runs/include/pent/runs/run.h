#pragma once

#include <pent/runs/report.h>
#include <pent/simulator/ranks.h>
#include <pent/simulator/scene.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pent::runs {

/// Runs of whole scenes into a folder:
///
///     RUN/scene.toml                the scene as run, defaults filled in
///     RUN/obstacles.json            the shapes of its obstacles, if there are any
///     RUN/obstacles/000123.json     in its place, at a frame, if any moves
///     RUN/meshes/BODY.pent          the mesh as placed
///     RUN/frames/BODY_000123.pent   positions and velocities; frame 0 is the start
///     RUN/contacts/000123.csv       every pair in contact, if the scene asks for them
///     RUN/checkpoint/000123.state   what it takes beside the last frames to go on behind them
///     RUN/journal.txt               what was done, frame by frame: where report.json comes from
///     RUN/report.json               verdict and statistics of every step and frame
///     RUN/balance.csv               momenta and energies of every step, if the scene asks for them
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
    /// Processes that run the scene together, each of which calls run(); null for one alone. All
    /// read the same files, rank 0 alone writes any and is the one whose callbacks are told of
    /// frames, warnings and so on; all are asked whether to stop.
    std::shared_ptr<const simulator::Ranks> ranks = {};
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

}  // namespace pent::runs
