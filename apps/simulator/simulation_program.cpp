#include "simulation_program.h"

#include "common/heartbeat.h"
#include "common/program.h"
#include "common/progress.h"
#include "common/scene_argument.h"

#include <pent/counted.h>
#include <pent/crc32c.h>
#include <pent/formatted.h>
#include <pent/printable.h>
#include <pent/runs/explain.h>
#include <pent/runs/run.h>
#include <pent/runs/scene_file.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pent::apps {

namespace {

using pent::runs::FrameReport;
using pent::runs::RunReport;
using pent::runs::RunVerdict;
using pent::simulator::StepReport;

struct Arguments {
    std::string scene;
    std::string output;
    std::string isa;
    bool force = false;
    bool resume = false;
    bool explain = false;
    std::shared_ptr<const simulator::Ranks> ranks;
};

Verdict verdict_of(RunVerdict verdict) {
    return verdict == RunVerdict::Finished  ? Verdict::Finished
           : verdict == RunVerdict::Stopped ? Verdict::Stopped
                                            : Verdict::Diverged;
}

std::string percent(double fraction) {
    return formatted("%.1f%%", 100 * fraction);
}

std::int64_t count_refused(const RunReport& report) {
    std::int64_t refused = 0;
    for (const StepReport& step : report.steps) {
        refused += step.refused;
    }
    return refused;
}

// What touched in a run, and its share of the time; says nothing of a scene without contact.
void summarize_contact(Program& program, const RunReport& report) {
    double seconds = 0;
    double contact_seconds = 0;
    double deepest = 0;
    std::int64_t most = 0;
    for (const StepReport& step : report.steps) {
        seconds += step.seconds;
        contact_seconds += step.contact.seconds;
        deepest = std::max(deepest, step.contact.deepest);
        most =
            std::max(most, step.contact.point_facet + step.contact.mixed + step.contact.obstacle);
    }
    if (contact_seconds == 0) {
        return;
    }
    const double share = contact_seconds / seconds;
    const std::string found =
        most > 0 ? "at most " + counted(most, "pair", "pairs") + ", deepest penetration "
                       + formatted("%.3g m", deepest)
        : count_refused(report) == 0
            ? "nothing touches at the end of a step"
            : "nothing touches at the end of a step, but steps were cut: there it may have acted";
    program.say("contact: " + percent(share) + " of the time; " + found);
    program.report()["contact"] = {{"share_of_time", share},
                                   {"seconds", contact_seconds},
                                   {"most_pairs", most},
                                   {"deepest", deepest}};
}

// Elements that no force of theirs brings back, or that are inside out, at the end and on the way
// there. Gives what to say beside the verdict.
std::string summarize_defects(Program& program, const RunReport& report) {
    const StepReport last = report.steps.empty() ? StepReport() : report.steps.back();
    std::int64_t inverted_steps = 0;
    for (const StepReport& step : report.steps) {
        inverted_steps += step.inverted > 0 ? 1 : 0;
    }
    program.report()["collapsed"] = last.collapsed;
    program.report()["inverted"] = last.inverted;
    program.report()["inverted_steps"] = inverted_steps;
    if (last.collapsed > 0) {
        const std::string elements = "of " + std::to_string(report.size.elements) + " elements ";
        program.say(counted(last.collapsed, elements + "has", elements + "have")
                    + " collapsed, to where the stable neo-Hookean energy holds them"
                      " (docs/simulator.md, Limits)");
    }
    if (inverted_steps > 0) {
        const std::string steps =
            counted(inverted_steps, "step", "steps") + " of " + std::to_string(report.steps.size());
        const std::string cells = "of " + std::to_string(report.size.cells) + " cells ";
        program.say(last.inverted > 0
                        ? counted(last.inverted, cells + "is", cells + "are")
                              + " inside out at the end, and some were after " + steps
                              + ": pressed or turned too hard; smaller steps or less force may help"
                        : "no cell is inside out at the end, but some were after " + steps);
    }
    return last.collapsed > 0  ? " with collapsed elements"
           : last.inverted > 0 ? " with inverted cells"
                               : "";
}

// "40 steps"; a run of version 0.1.0 that was killed has lost the statistics of some.
std::string steps_text(const RunReport& report) {
    const std::uint64_t steps = report.steps.empty() ? 0 : report.steps.back().step;
    const std::uint64_t lost = steps - report.steps.size();
    return counted(steps, "step", "steps")
           + (lost > 0 ? " (nothing is known of " + std::to_string(lost) + ")" : "");
}

// " in 3 parts, of which 1 died"; nothing for a run in one go.
std::string parts_text(const RunReport& report) {
    if (report.parts.size() < 2) {
        return "";
    }
    const auto died = std::ranges::count(report.parts, RunVerdict::Died, &runs::RunPart::verdict);
    return " in " + std::to_string(report.parts.size()) + " parts"
           + (died > 0 ? ", of which " + std::to_string(died) + " died" : "");
}

void summarize(Program& program, const RunReport& report, const std::string& folder) {
    nlohmann::ordered_json bodies = nlohmann::ordered_json::array();
    for (const runs::BodyReport& body : report.bodies) {
        program.say(body.name + ": differs from a rigid motion by up to "
                    + percent(body.non_rigid_max) + " of its size");
        bodies.push_back({{"name", body.name}, {"non_rigid_max", body.non_rigid_max}});
    }
    std::int64_t iterations = 0;
    const std::int64_t refused = count_refused(report);
    std::string failure;
    for (const StepReport& step : report.steps) {
        iterations += step.iterations;
        failure = step.refused > 0 ? step.failure : failure;
    }
    if (refused > 0) {
        program.say(counted(refused, "attempt at a step was", "attempts at steps were")
                    + " cut in two, the last because " + failure);
    }
    program.report()["parts"] = report.parts.size();
    program.report()["frames"] = report.frames.size();
    program.report()["steps"] = report.steps.size();
    program.report()["iterations"] = iterations;
    program.report()["refused"] = refused;
    program.report()["failure"] = failure;
    program.report()["vertices"] = report.size.vertices;
    program.report()["cells"] = report.size.cells;
    program.report()["bodies"] = bodies;
    summarize_contact(program, report);
    std::string defects = summarize_defects(program, report);
    if (!report.penetration.empty()) {
        program.say(report.penetration);
        program.report()["penetration"] = report.penetration;
        defects += defects.empty() ? " with deep penetration" : " and deep penetration";
    }
    program.say(std::string(verdict_name(report.verdict)) + defects + ": "
                + counted(report.frames.size(), "frame", "frames") + " in " + folder + ", "
                + steps_text(report) + ", " + readable_time(report.seconds) + parts_text(report));
}

Verdict explain_scene(Program& program, const Arguments& arguments, const simulator::Scene& scene) {
    runs::Explanation explanation;
    {
        Heartbeat heartbeat(program.common().quiet);
        heartbeat.begin("one step in memory");
        explanation = runs::explain(scene, program.common().threads, arguments.ranks);
    }
    program.say(explanation_text(explanation));
    nlohmann::ordered_json terms = nlohmann::ordered_json::array();
    for (const runs::Term& term : explanation.terms) {
        terms.push_back({{"name", term.name},
                         {"is_on", term.is_on},
                         {"why", term.why},
                         {"unknowns", term.unknowns},
                         {"bytes", term.bytes},
                         {"seconds", term.seconds}});
    }
    program.report()["terms"] = terms;
    program.report()["advice"] = explanation.advice;
    program.report()["bytes"] = explanation.bytes;
    program.report()["seconds_per_step"] = explanation.seconds_per_step;
    return Verdict::Finished;
}

// Throws an Error if the --json report would replace the scene, one of its meshes or a part of the
// run, the scene and the run first: a report says why the scene could not be read.
simulator::Scene read_inputs(Program& program, const Arguments& arguments) {
    std::vector<NamedFile> inputs;
    if (!arguments.output.empty()) {
        inputs = parts_of_run(arguments.output, "a part of the run");
    }
    inputs.push_back({"the scene", arguments.scene});
    program.require_apart(inputs, {});
    refuse_folder(arguments.scene);
    simulator::Scene scene;
    simulator::agree(arguments.ranks.get(), [&] { scene = runs::read_scene(arguments.scene); });
    const std::string text = runs::scene_text(scene);
    simulator::refuse_others(arguments.ranks.get(), crc32c(text.data(), text.size()),
                             "another scene", "let all of them read the same file");
    for (const simulator::Body& body : scene.bodies) {
        inputs.push_back({"the mesh of \"" + body.name + "\"", body.mesh});
    }
    program.require_apart(inputs, {});
    return scene;
}

RunReport run_scene(Program& program, const Arguments& arguments, const simulator::Scene& scene) {
    Progress progress("frame", scene.frames, program.common().quiet);
    Heartbeat heartbeat(program.common().quiet);
    heartbeat.begin("setting up");
    runs::RunCallbacks callbacks;
    callbacks.should_stop = stop_requested;
    callbacks.on_frame = [&](const FrameReport& frame, const StepReport& step) {
        if (frame.frame > 0) {
            progress.update(frame.frame, counted(step.iterations, "iteration", "iterations"));
        }
        heartbeat.begin("frame " + std::to_string(frame.frame + 1));
        heartbeat.spoken();  // where frames are quick their progress is enough
    };
    const auto say = [&](const std::string& line) {
        program.say(line);
        heartbeat.spoken();
    };
    callbacks.on_warning = [&](const std::string& line) { say("warning: " + line); };
    callbacks.on_resume = say;
    return runs::run(scene,
                     {.folder = arguments.output,
                      .force = arguments.force,
                      .scene_file = arguments.scene,
                      .resume = arguments.resume,
                      .threads = program.common().threads,
                      .isa = arguments.isa,
                      .created_by = program.name_and_version(),
                      .ranks = arguments.ranks},
                     callbacks);
}

Verdict simulate(Program& program, const Arguments& arguments) {
    const simulator::Scene scene = read_inputs(program, arguments);
    if (arguments.explain) {
        return explain_scene(program, arguments, scene);
    }
    const RunReport report = run_scene(program, arguments, scene);
    if (program.is_silent()) {
        return verdict_of(report.verdict);
    }
    summarize(program, report, arguments.output);
    if (!report.message.empty()) {
        std::fprintf(stderr, "%s: diverged at %s\n", program.name().c_str(),
                     printable(report.message).c_str());
        program.report()["message"] = report.message;
    }
    return verdict_of(report.verdict);
}

}  // namespace

int run_simulation_program(Program& program,
                           std::shared_ptr<const simulator::Ranks> ranks,
                           int argc,
                           char** argv) {
    Arguments arguments;
    arguments.ranks = std::move(ranks);
    CLI::App& options = program.options();
    options.add_option("scene", arguments.scene, "Scene file (TOML)")
        ->required()
        ->type_name("FILE");
    CLI::Option* output =
        options.add_option("-o,--output", arguments.output, "Folder for the run")->type_name("OUT");
    options
        .add_flag("--explain", arguments.explain,
                  "Say what will be modeled and at what cost, and run nothing")
        ->excludes(output);
    CLI::Option* force =
        options.add_flag("--force", arguments.force, "Replace a run that is in the folder");
    options
        .add_flag("--resume", arguments.resume,
                  "Go on with the run in the folder after its last whole frame")
        ->excludes(force);
    options
        .add_option("--isa", arguments.isa,
                    "Instruction set: scalar, baseline, avx2 or avx512; default: the widest")
        ->type_name("NAME");
    options
        .add_flag_callback(
            "--schema",
            [&] {
                if (!program.is_silent()) {
                    std::fputs((runs::schema_text() + "\n" + runs::report_schema_text()).c_str(),
                               stdout);
                }
                throw CLI::Success();
            },
            "Print every key of scene files and of report.json, and end")
        ->trigger_on_parse()
        ->configurable(false);
    options.callback([&] {
        if (!arguments.explain && arguments.output.empty()) {
            throw CLI::RequiredError("--output");
        }
    });
    return program.run(argc, argv, [&] { return simulate(program, arguments); });
}

}  // namespace pent::apps
