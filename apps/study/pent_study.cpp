#include "common/heartbeat.h"
#include "common/program.h"
#include "common/progress.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/output_file.h>
#include <pent/runs/scene_file.h>
#include <pent/study/study.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using pent::apps::Program;
using pent::apps::Verdict;
using pent::study::Result;
using pent::study::StudyReport;

struct Arguments {
    pent::study::StudyOptions study;
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
                + (reference.has_contact ? ", 0.2 s behind the first contact; statistics beyond"
                                         : ", the end"));
}

void say_results(const Program& program, const StudyReport& report) {
    for (const Result& result : report.results) {
        std::string line = "run        " + settings_text(result.settings) + ": ";
        if (result.verdict == "finished") {
            line += number(result.cost.seconds_per_frame) + " s per frame, "
                    + number(1e-6 * result.cost.peak_bytes) + " MB, error "
                    + number(100 * result.errors.position) + "%";
        } else {
            line += result.verdict + ": " + result.message;
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

// Throws an Error if an option says to write what the study reads.
void require_apart(Program& program, const Arguments& arguments) {
    const fs::path& scene = arguments.study.scene;
    std::vector<pent::apps::NamedFile> inputs = {{"the scene", scene}};
    program.require_apart(inputs, {});
    for (const pent::simulator::Body& body : pent::runs::read_scene(scene).bodies) {
        inputs.push_back({"the mesh of \"" + body.name + "\"", body.mesh});
    }
    program.require_apart(inputs, {{"--write-scene", arguments.write_scene}});
}

Verdict study(Program& program, Arguments& arguments) {
    require_apart(program, arguments);
    arguments.study.threads = program.common().threads;
    arguments.study.created_by = program.name_and_version();
    arguments.study.programs = fs::read_symlink("/proc/self/exe").parent_path();
    pent::study::StudyCallbacks callbacks;
    callbacks.should_stop = pent::apps::stop_requested;
    std::optional<pent::apps::Progress> progress;
    std::optional<pent::apps::Heartbeat> heartbeat(program.common().quiet);
    heartbeat->begin("looking at what is there");
    callbacks.on_run = [&](int done, int total, const std::string& next) {
        if (!progress) {
            progress.emplace("run", total, program.common().quiet);
        }
        if (progress->update(done + 1, next)) {
            heartbeat->spoken();
        }
        heartbeat->begin(next);
    };
    const StudyReport report = run_study(arguments.study, callbacks);
    heartbeat.reset();
    progress.reset();
    if (report.is_stopped) {
        program.say("stopped: run the same command again to go on");
        return Verdict::Stopped;
    }
    say_reference(program, report);
    say_results(program, report);
    program.report()["runs"] = report.results.size();
    program.report()["reference_order"] = report.reference.order;
    program.report()["reference_error_bar"] = report.reference.error_bar;
    program.report()["sentences"] = report.sentences;
    if (const Result* chosen = chosen_by(arguments, report)) {
        program.say("chosen     " + settings_text(chosen->settings));
        program.report()["chosen"] = settings_text(chosen->settings);
        if (!arguments.write_scene.empty()) {
            const fs::path path = arguments.write_scene;
            pent::write_text(
                path, scene_with(arguments.study, *chosen, fs::absolute(path).parent_path()));
            program.say("written    " + path.string());
        }
    }
    program.say("finished: " + (arguments.study.folder / "frontier.png").string()
                + ", frontier.svg, study.csv and study.json beside it");
    return Verdict::Finished;
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
    options.add_option("scene", arguments.study.scene, "Scene file (TOML)")->required();
    options.add_option("-o,--output", arguments.study.folder, "Folder for everything")->required();
    options
        .add_option(
            "--vary", arguments.study.vary,
            "NAME=VALUE,VALUE,...: dt (s), preset, contact (its model), layers or subdivide (of the"
            " mesh, where the scene has its recipe), or a key of [solver]")
        ->allow_extra_args(false)
        ->required();
    options
        .add_option("--repeat", arguments.study.repeats, "Timed runs of each; the median counts")
        ->check(CLI::Range(1, 100));
    options.add_option("--frames", arguments.study.frames, "Study only so many frames")
        ->check(CLI::Range(1, 999'999));
    options
        .add_option("--reference-halvings", arguments.study.reference_halvings,
                    "How often the reference halves the smallest dt")
        ->check(CLI::Range(2, 8));
    options.add_option("--reference-integrator", arguments.study.reference_integrator,
                       "Of the reference; linear_euler where Newton's method does not get through");
    options.add_flag("--keep-runs", arguments.study.keep_runs, "Keep the frames of all runs");
    options.add_flag("--force", arguments.study.force,
                     "Throw away the study that is in the folder");
    CLI::Option* error = options
                             .add_option("--error", arguments.error_percent,
                                         "Choose the fastest settings within this error (percent)")
                             ->check(CLI::PositiveNumber);
    options
        .add_option("--budget", arguments.budget,
                    "Choose the most accurate settings that run the whole scene within this (s)")
        ->check(CLI::PositiveNumber)
        ->excludes(error);
    options.add_option("--write-scene", arguments.write_scene,
                       "Write the scene with the chosen settings to this file");
    return program.run(argc, argv, [&] { return study(program, arguments); });
}
