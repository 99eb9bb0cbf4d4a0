#include "common/heartbeat.h"
#include "common/program.h"
#include "common/progress.h"
#include "common/scene_argument.h"
#include "common/values.h"

#include <pent/counted.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/output_file.h>
#include <pent/runs/scene_file.h>
#include <pent/study/study.h>
#include <pent/study/units.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using pent::counted;
using pent::apps::positive_number;
using pent::apps::Program;
using pent::apps::Verdict;
using pent::apps::whole_number;
using pent::simulator::word_of;
using pent::study::Result;
using pent::study::StudyReport;
using pent::study::StudyState;
using pent::study::UnitState;
using pent::study::UnitVerdict;

struct Arguments {
    pent::study::StudyOptions study;
    bool prepare = false;
    bool list_runs = false;
    int run = 0;  // the number of a unit; 0: not given
    bool collect = false;
    std::optional<double> budget;         // s, of the whole scene
    std::optional<double> error_percent;  // of the position error
    std::string write_scene;
};

std::string number(double value) {
    return pent::formatted("%.3g", value);
}

void say_reference(const Program& program, const StudyReport& report) {
    const pent::study::ReferenceReport& reference = report.reference;
    program.say("reference  dt = " + number(reference.dt.back()) + " s, "
                + number(reference.cost.seconds_per_frame)
                + " s per frame: " + (reference.is_converged ? "converged" : "NOT converged")
                + ", observed order " + number(reference.order) + ", error bar "
                + number(100 * reference.error_bar) + "%");
    program.say("compared   positions up to t = " + number(reference.window) + " s"
                + (reference.has_contact
                       ? ", 0.2 s after the first contact; from there on means and centers"
                       : ", the end"));
}

void say_results(const Program& program, const StudyReport& report) {
    for (const Result& result : report.results) {
        std::string line = "run        " + settings_text(result.settings) + ": ";
        if (result.verdict == UnitVerdict::Finished) {
            line += number(result.cost.seconds_per_frame) + " s per frame, "
                    + number(1e-6 * result.cost.peak_bytes) + " MB, error "
                    + number(100 * result.errors.position) + "%";
        } else {
            line += std::string(word_of(result.verdict)) + ": " + result.message;
        }
        program.say(line);
    }
    for (const std::string& sentence : report.sentences) {
        program.say(sentence);
    }
}

// What --budget or --error pick; null without them.
const Result* chosen_by(const Arguments& arguments, const StudyReport& report) {
    const Result* chosen = nullptr;
    std::string wish;
    if (arguments.error_percent) {
        wish = "an error of at most " + number(*arguments.error_percent) + "%";
        chosen = best_within_error(report, 0.01 * *arguments.error_percent);
    } else if (arguments.budget) {
        wish = "at most " + number(*arguments.budget) + " s for the scene";
        chosen = best_within_budget(report, *arguments.budget);
    } else {
        return nullptr;
    }
    if (chosen == nullptr) {
        throw pent::Error("none of the settings has " + wish + "; vary more, or ask for less");
    }
    return chosen;
}

// Throws an Error if an option says to write what the study reads, or among what it writes, or
// where nothing can be written.
//
// @param text  What says which meshes it reads: the scene or what was prepared of it.
void check_outputs(Program& program,
                   const Arguments& arguments,
                   const fs::path& scene,
                   const fs::path& text) {
    std::vector<pent::apps::NamedFile> inputs = {
        {"the scene", scene},
        {.what = "the study", .path = arguments.study.folder, .has_content = true}};
    program.require_apart(inputs, {});
    for (const pent::simulator::Body& body : pent::runs::read_scene(text).bodies) {
        inputs.push_back({"the mesh of \"" + body.name + "\"", body.mesh});
    }
    program.require_apart(inputs, {{"--write-scene", arguments.write_scene}});
    if (!arguments.write_scene.empty()) {
        pent::apps::make_folder_for(arguments.write_scene);
        const pent::OutputFile attempt(arguments.write_scene);  // before all the work
    }
}

// Says on the way which run is on.
class Watch {
public:
    explicit Watch(bool quiet) : quiet_(quiet), heartbeat_(quiet) {
        heartbeat_.begin("looking at what is there");
    }

    [[nodiscard]] pent::study::StudyCallbacks callbacks() {
        return {.should_stop = pent::apps::stop_requested,
                .on_run = [this](int done, int total, const std::string& next) {
                    if (!progress_) {
                        progress_.emplace("run", total, quiet_);
                    }
                    if (progress_->update(done + 1, next)) {
                        heartbeat_.spoken();
                    }
                    heartbeat_.begin(next);
                }};
    }

private:
    bool quiet_;
    std::optional<pent::apps::Progress> progress_;
    pent::apps::Heartbeat heartbeat_;
};

Verdict stopped(const Program& program) {
    program.say("stopped: run the same command again to go on");
    return Verdict::Stopped;
}

Verdict say_study(Program& program, const Arguments& arguments, const StudyReport& report) {
    say_reference(program, report);
    say_results(program, report);
    program.report()["runs"] = report.results.size();
    program.report()["reference_order"] = report.reference.order;
    program.report()["reference_error_bar"] = report.reference.error_bar;
    program.report()["sentences"] = report.sentences;
    program.report()["warnings"] = report.warnings;
    for (const std::string& warning : report.warnings) {
        program.say("warning: " + warning);
    }
    if (const Result* chosen = chosen_by(arguments, report)) {
        program.say("chosen     " + settings_text(chosen->settings));
        program.report()["chosen"] = settings_text(chosen->settings);
        if (!arguments.write_scene.empty()) {
            const fs::path path = arguments.write_scene;
            const fs::path where = fs::absolute(path).parent_path();
            pent::write_text(path, scene_with(arguments.study.folder, *chosen, where));
            program.say("written    " + path.string());
        }
    }
    program.say("finished: " + (arguments.study.folder / "frontier.png").string()
                + ", frontier.svg, study.csv and study.json beside it");
    return Verdict::Finished;
}

// In one go.
Verdict study(Program& program, const Arguments& arguments) {
    check_outputs(program, arguments, arguments.study.scene, arguments.study.scene);
    std::optional<Watch> watch(program.common().quiet);
    const StudyReport report = run_study(arguments.study, watch->callbacks());
    watch.reset();
    return report.is_stopped ? stopped(program) : say_study(program, arguments, report);
}

void report_units(Program& program, const StudyState& state) {
    nlohmann::ordered_json units = nlohmann::ordered_json::array();
    for (const UnitState& unit : state.units) {
        units.push_back({{"number", units.size() + 1},
                         {"kind", kind_name(unit.kind)},
                         {"name", unit.name},
                         {"is_done", unit.is_done}});
    }
    program.report()["threads_of_runs"] = state.threads;
    program.report()["units"] = units;
}

Verdict prepare(Program& program, const Arguments& arguments) {
    check_outputs(program, arguments, arguments.study.scene, arguments.study.scene);
    std::optional<Watch> watch(program.common().quiet);
    const std::optional<StudyState> state = prepare_study(arguments.study, watch->callbacks());
    watch.reset();
    if (!state) {
        return stopped(program);
    }
    report_units(program, *state);
    const std::string folder = arguments.study.folder.string();
    const auto levels =
        std::ranges::count(state->units, pent::study::UnitKind::Reference, &UnitState::kind);
    const auto done = std::ranges::count(state->units, true, &UnitState::is_done);
    program.say("prepared: " + counted(state->units.size(), "unit", "units") + ", of which "
                + std::to_string(levels) + " are the reference and " + std::to_string(done)
                + " done; run each by pent-study -o " + folder + " --run N, then pent-study -o "
                + folder + " --collect");
    return Verdict::Finished;
}

// A line a unit: number, kind, name, and whether it is done.
Verdict list_runs(Program& program, const Arguments& arguments) {
    const StudyState state = pent::study::state_of_study(arguments.study.folder);
    report_units(program, state);
    int number = 0;
    for (const UnitState& unit : state.units) {
        program.say(std::to_string(++number) + " " + std::string(kind_name(unit.kind)) + " "
                    + unit.name + (unit.is_done ? " done" : " open"));
    }
    return Verdict::Finished;
}

Verdict run_one(Program& program, const Arguments& arguments) {
    std::optional<Watch> watch(program.common().quiet);
    const pent::study::UnitOutcome outcome = run_unit(arguments.study.folder, arguments.run,
                                                      arguments.study.programs, watch->callbacks());
    watch.reset();
    const std::string unit = "unit " + std::to_string(arguments.run);
    program.report()["run"] = arguments.run;
    program.report()["outcome"] = word_of(outcome.verdict);
    if (outcome.verdict == UnitVerdict::Stopped) {
        return stopped(program);
    }
    if (outcome.has_failed) {
        throw pent::Error(unit + " was refused: " + outcome.message);
    }
    // That settings diverge is what a study is to find out.
    program.say(unit + ": " + std::string(word_of(outcome.verdict))
                + (outcome.message.empty() ? "" : ": " + outcome.message));
    return Verdict::Finished;
}

Verdict collect(Program& program, const Arguments& arguments) {
    const fs::path& folder = arguments.study.folder;
    const fs::path scene = pent::study::state_of_study(folder).scene;
    check_outputs(program, arguments, scene, folder / "scene.toml");
    return say_study(program, arguments,
                     pent::study::collect_study(folder, arguments.study.created_by));
}

Verdict body(Program& program, Arguments& arguments) {
    arguments.study.threads = program.common().threads;
    arguments.study.created_by = program.name_and_version();
    arguments.study.programs = fs::read_symlink("/proc/self/exe").parent_path();
    pent::apps::refuse_folder(arguments.study.scene);
    const bool is_part = arguments.list_runs || arguments.run > 0 || arguments.collect;
    if (is_part) {
        program.require_apart(
            {{.what = "the study", .path = arguments.study.folder, .has_content = true}}, {});
    }
    if (is_part && !arguments.study.scene.empty()) {
        pent::study::require_scene(arguments.study.folder, arguments.study.scene);
    }
    return arguments.prepare     ? prepare(program, arguments)
           : arguments.list_runs ? list_runs(program, arguments)
           : arguments.run > 0   ? run_one(program, arguments)
           : arguments.collect   ? collect(program, arguments)
                                 : study(program, arguments);
}

// Throws what CLI does for wrong usage: what is missing, or does not go with a part of a study.
void check_usage(const CLI::App& options, const Arguments& arguments) {
    const auto refuse = [&](const std::vector<const char*>& names, const std::string& why) {
        for (const char* name : names) {
            if (options.get_option(name)->count() > 0) {
                throw CLI::ValidationError(name, why);
            }
        }
    };
    const std::string part = arguments.list_runs ? "--list-runs"
                             : arguments.run > 0 ? "--run"
                             : arguments.collect ? "--collect"
                                                 : "";
    if (part.empty()) {
        for (const char* name : {"scene", "--vary"}) {
            if (options.get_option(name)->count() == 0) {
                throw CLI::RequiredError(name);
            }
        }
    } else {
        refuse({"--vary", "--repeat", "--frames", "--reference-halvings", "--reference-integrator",
                "--keep-runs", "--threads"},
               "was fixed by --prepare; leave it out with " + part);
        refuse({"--force"}, "throws a study away; it goes with --prepare, not with " + part);
    }
    if (arguments.prepare || (!part.empty() && !arguments.collect)) {
        refuse({"--error", "--budget", "--write-scene"},
               "chooses from what a study has found; it goes with --collect, not with "
                   + (part.empty() ? "--prepare" : part));
    }
    if (!arguments.write_scene.empty() && !arguments.error_percent && !arguments.budget) {
        throw CLI::ValidationError("--write-scene",
                                   "needs --error or --budget, which say what to choose");
    }
}

}  // namespace

int main(int argc, char** argv) {
    Program program(
        "pent-study",
        "Measures speed against accuracy of a scene over settings: runs every combination,"
        " compares it with a converged reference, plots the frontier, and recommends.",
        "pent-study octopus.toml -o study/ --vary dt=1/30,1/60,1/120"
        " --vary integrator=linear_euler,newton_euler,bdf2 --error 1"
        " --write-scene chosen.toml");
    Arguments arguments;
    CLI::App& options = program.options();
    options
        .add_option("scene", arguments.study.scene,
                    "Scene file (TOML); not needed for a study that is prepared")
        ->type_name("FILE");
    options
        .add_option("-o,--output", arguments.study.folder,
                    "Folder of the study, for all that it writes")
        ->required()
        ->type_name("OUT");
    options
        .add_option(
            "--vary", arguments.study.vary,
            "NAME=VALUE,VALUE,...: dt (s), preset, contact (its model), layers or subdivide (of the"
            " mesh, where the scene has its recipe), a key of [solver], or BLOCK.KEY of every other"
            " block, as in attachment.stiffness=100,1e4")
        ->type_name("NAME=VALUES")
        ->allow_extra_args(false);
    options
        .add_option("--repeat", arguments.study.repeats,
                    "Timed runs of each combination, of which the medians count; default: 3")
        ->check(whole_number(1, 100));
    options
        .add_option("--frames", arguments.study.frames, "Study only so many frames; default: all")
        ->check(whole_number(1, 999'999));
    options
        .add_option("--reference-halvings", arguments.study.reference_halvings,
                    "How often the reference halves the smallest dt; default: 2")
        ->check(whole_number(2, 8));
    options
        .add_option(
            "--reference-integrator", arguments.study.reference_integrator,
            "What the reference is computed by: bdf2, or linear_euler where Newton's method "
            "does not get through; default: bdf2")
        ->type_name("NAME");
    options.add_flag("--keep-runs", arguments.study.keep_runs, "Keep the frames of all runs");
    options.add_flag("--force", arguments.study.force,
                     "Throw away the study that is in the folder");
    CLI::Option* error = options
                             .add_option("--error", arguments.error_percent,
                                         "Choose the fastest settings within this error (percent)")
                             ->check(positive_number());
    options
        .add_option("--budget", arguments.budget,
                    "Choose the most accurate settings that run the whole scene in this time (s)")
        ->check(positive_number())
        ->excludes(error);
    options
        .add_option("--write-scene", arguments.write_scene,
                    "Write the scene with the chosen settings to this file")
        ->type_name("FILE");
    const std::vector<CLI::Option*> parts = {
        options.add_flag("--prepare", arguments.prepare,
                         "Run nothing: make the meshes and number the units, which may be run"
                         " anywhere that sees the folder"),
        options.add_flag("--list-runs", arguments.list_runs,
                         "Print number, kind, name and state of each unit"),
        options.add_option("--run", arguments.run, "Run the unit of this number")
            ->type_name("N")
            ->check(whole_number(1, 999'999'999)),
        options.add_flag("--collect", arguments.collect,
                         "Compare, plot and recommend when all units have been run")};
    for (CLI::Option* part : parts) {
        for (CLI::Option* other : parts) {
            if (part != other) {
                part->excludes(other);
            }
        }
    }
    options.parse_complete_callback([&] { check_usage(options, arguments); });
    return program.run(argc, argv, [&] { return body(program, arguments); });
}
