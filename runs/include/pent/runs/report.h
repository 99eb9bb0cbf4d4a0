#pragma once

#include <pent/simulator/simulation.h>
#include <pent/simulator/words.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace pent::runs {

/// How a run, or a part of it, ended. One that died was killed or crashed.
enum class RunVerdict { Running, Finished, Stopped, Diverged, Died };

/// How far a body is from a rigid motion of its start.
struct NonRigidity {
    std::string body;
    double value = 0;  ///< RMS distance to the best-fitting rigid motion over the RMS radius.
};

/// What is known when a frame has been written.
struct FrameReport {
    int frame = 0;
    std::uint64_t step = 0;
    double time = 0;                     ///< s.
    std::vector<NonRigidity> non_rigid;  ///< One a body, in the order of the scene.
};

/// One call of run(): a run that was stopped and resumed has several.
struct RunPart {
    std::string created_by;
    int threads = 1;
    int ranks = 0;  ///< Processes, of pent-sim-mpi; 0: of a program on its own.
    std::string isa;
    int first_frame = 0;  ///< The frame it went on from; 0 at the start.
    int last_frame = 0;   ///< The last that it wrote.
    double seconds = 0;   ///< Of a part that died: up to its last frame.
    RunVerdict verdict = RunVerdict::Running;
};

struct BodyReport {
    std::string name;
    double non_rigid_max = 0;  ///< The largest of all frames.
    /// Names of its regions, in the order of the scene; steps list them, body after body.
    std::vector<std::string> regions;
};

/// What report.json says of a run.
struct RunReport {
    RunVerdict verdict = RunVerdict::Running;  ///< Of the last part.
    std::string message;  ///< Why a run diverged and what to try; empty otherwise.
    /// How deep bodies went into something, and what would do; empty where that stays
    /// below a tenth of the thinnest extent of a body.
    std::string penetration;
    /// Of meshes, settings, units, and of what overlaps at the start.
    std::vector<std::string> warnings;
    simulator::SimulationSize size;
    double thinnest = 0;                       ///< Thickness of the thinnest body at rest, m.
    std::vector<BodyReport> bodies;            ///< In the order of the scene.
    std::vector<FrameReport> frames;           ///< Every frame in the folder, frame 0 included.
    std::vector<simulator::StepReport> steps;  ///< Every step behind them.
    std::vector<RunPart> parts;                ///< The last is the last call of run().
    double seconds = 0;                        ///< Spent in all parts.
};

/// Reads the report.json of a run, of version 0.1.0 too. Its verdict is Running while a run goes
/// on, and where one died and was not resumed.
///
/// Throws an Error that names the file if it cannot be read or is not such a report.
[[nodiscard]] RunReport read_report(const std::filesystem::path& path);

/// "finished", "stopped" and so on.
[[nodiscard]] std::string_view verdict_name(RunVerdict verdict);

/// What report.json says, as tables in Markdown: keys, units and a sentence. docs/simulator.md has
/// them.
[[nodiscard]] std::string report_schema_text();

}  // namespace pent::runs

template <>
inline constexpr std::array pent::simulator::kWords<pent::runs::RunVerdict> = {
    Word<pent::runs::RunVerdict>{pent::runs::RunVerdict::Running, "running"},
    Word<pent::runs::RunVerdict>{pent::runs::RunVerdict::Finished, "finished"},
    Word<pent::runs::RunVerdict>{pent::runs::RunVerdict::Stopped, "stopped"},
    Word<pent::runs::RunVerdict>{pent::runs::RunVerdict::Diverged, "diverged"},
    Word<pent::runs::RunVerdict>{pent::runs::RunVerdict::Died, "died"},
};
