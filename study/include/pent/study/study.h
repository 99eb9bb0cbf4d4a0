#pragma once

#include <pent/simulator/words.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pent::study {

/// Speed against accuracy of one scene, measured: every combination of settings is run by pent-sim
/// as a user would run it, and compared with a reference that is shown to be converged.
///
///     OUT/study.csv, study.json      everything measured
///     OUT/frontier.svg, frontier.png error against time
///     OUT/runs/, OUT/references/     what was run; a study that was interrupted goes on from here

/// One setting, as in integrator = bdf2.
struct Setting {
    std::string axis;
    std::string value;

    bool operator==(const Setting&) const = default;
};

/// The settings of one run, one for each axis of the study, in their order.
using Settings = std::vector<Setting>;

/// "dt=1/60 integrator=bdf2".
[[nodiscard]] std::string settings_text(const Settings& settings);

struct StudyOptions {
    std::filesystem::path scene = {};    ///< A scene file.
    std::filesystem::path folder = {};   ///< Where everything goes.
    std::vector<std::string> vary = {};  ///< "dt=1/30,1/60", "integrator=linear_euler,bdf2", ...
    int repeats = 3;                     ///< Timed runs of each combination, >= 1; medians count.
    int frames = 0;                      ///< Study only so many frames; 0 for all of the scene.
    int reference_halvings = 2;  ///< The reference takes steps down to the smallest dt of the study
                                 ///< over 2^this; at least 2, for an observed order.
    std::string reference_integrator = "bdf2";  ///< As in a scene.
    int threads = 1;                            ///< Of each run.
    bool force = false;                         ///< Throw away the study that is in the folder.
    bool keep_runs = false;               ///< Keep the frames of runs that have been measured.
    std::filesystem::path programs = {};  ///< Folder with pent-sim and pent-mesh.
    std::string created_by = "pent-study";
};

/// What a whole run costs: medians over its repetitions.
struct Cost {
    double wall_seconds = 0;
    double cpu_seconds = 0;
    double peak_bytes = 0;
    double seconds_per_frame = 0;  ///< wall_seconds over the number of frames.
};

/// How a run differs from the reference, and what it says of itself. Fractions, but where noted.
struct Errors {
    double position = 0;  ///< Largest mass-weighted RMS distance at a common time up to the end of
                          ///< the window, over the largest RMS motion of the reference there.
    double position_m = 0;    ///< The same distance in m.
    double center = 0;        ///< Distance of the centers of mass at the end, over that motion.
    double energy = 0;        ///< Kinetic and elastic energy behind the window, its mean over time;
                              ///< relative to that of the reference. Without contact: over all.
    double contact_work = 0;  ///< Work done against contacts and obstacles, over all time; relative
                              ///< to that of the reference. 0 without contact.
    double energy_drift = 0;  ///< Total energy at the end less that at the start, J.
    std::vector<double>
        angular_momentum;               ///< In each plane (xy, xz, xw, yz, ...) about the center of
                                        ///< mass: largest difference from the reference at a common
                                        ///< time up to the end of the window, kg m^2/s.
    double angular_momentum_scale = 0;  ///< Largest norm of it in the reference, kg m^2/s.
    double smallest_J = 0;              ///< Smallest det F of any cell in any frame.
    double deepest_penetration = 0;     ///< m; 0 without contact.
    std::int64_t iterations = 0;        ///< Of the linear solver, all steps.
    std::int64_t newton_iterations = 0;
    std::int64_t refused = 0;  ///< Steps that were thrown away and cut.
};

/// How a unit of a study ended (units.h). None: it has not been run to its end.
enum class UnitVerdict { None, Finished, Diverged, Refused, Stopped };

struct Result {
    Settings settings = {};
    UnitVerdict verdict = UnitVerdict::None;  ///< Finished, Diverged or Refused.
    std::string message = {};                 ///< Why it did not finish.
    Cost cost = {};
    Errors errors = {};
};

/// How the reference converges: three or more levels of dt on the same mesh.
struct ReferenceReport {
    std::vector<double> dt;          ///< s, from coarse to fine.
    std::vector<double> difference;  ///< Each level less the next finer one, as Errors::position.
    Errors last;                     ///< Of the last level but one, against the finest.
    double order = 0;                ///< Observed from the last three levels.
    double error_bar = 0;            ///< Estimated error of the finest level, as Errors::position.
    bool is_converged = false;       ///< Differences fall, at an order of at least 0.5.
    double window = 0;  ///< s: positions are compared up to here, 0.2 s after the first
                        ///< contact, or to the end of the scene where there is none.
    bool has_contact = false;
    Cost cost;  ///< Of the finest level, run once.
};

struct StudyReport {
    std::string scene;  ///< Name of the scene file.
    int frames = 0;     ///< Studied.
    int scene_frames = 0;
    std::int64_t vertices = 0;
    std::int64_t cells = 0;
    int threads = 1;
    ReferenceReport reference;
    std::vector<Result> results;        ///< In the order of the combinations.
    std::vector<std::size_t> frontier;  ///< Results no other beats in both time and error, by time.
    std::vector<std::string> sentences;  ///< One for each error level.
    std::vector<std::string> warnings;   ///< Of times that do not compare.
    bool is_stopped = false;             ///< Asked to stop; run again to go on.
};

struct StudyCallbacks {
    std::function<bool()> should_stop = {};
    /// Told before each run: how many are done, of how many, and what comes.
    std::function<void(int done, int total, const std::string& next)> on_run = {};
};

/// Prepares the study, runs each unit that is not done, one after the other, and collects them
/// (units.h).
///
/// Throws an Error for a scene or an axis that is not understood, a folder of another study
/// (without force), one that is neither empty nor of a study (with force too), a reference that
/// cannot be run, and files that cannot be written.
[[nodiscard]] StudyReport run_study(const StudyOptions& options,
                                    const StudyCallbacks& callbacks = {});

/// The fastest result with at most this error (a fraction); null if none is that good.
[[nodiscard]] const Result* best_within_error(const StudyReport& report, double error);

/// The most accurate result whose whole scene takes at most so many seconds; null if none does.
[[nodiscard]] const Result* best_within_budget(const StudyReport& report, double seconds);

/// The scene with the settings of a result, as the text of a scene file in the folder `where`.
///
/// @param folder  Of the study.
[[nodiscard]] std::string scene_with(const std::filesystem::path& folder,
                                     const Result& result,
                                     const std::filesystem::path& where);

}  // namespace pent::study

/// As they stand in study.json, study.csv and in the records of units.
template <>
inline constexpr std::array pent::simulator::kWords<pent::study::UnitVerdict> = {
    Word<pent::study::UnitVerdict>{pent::study::UnitVerdict::None, ""},
    Word<pent::study::UnitVerdict>{pent::study::UnitVerdict::Finished, "finished"},
    Word<pent::study::UnitVerdict>{pent::study::UnitVerdict::Diverged, "diverged"},
    Word<pent::study::UnitVerdict>{pent::study::UnitVerdict::Refused, "refused"},
    Word<pent::study::UnitVerdict>{pent::study::UnitVerdict::Stopped, "stopped"},
};
