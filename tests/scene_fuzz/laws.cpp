#include "laws.h"

#include "child.h"
#include "folders.h"
#include "meshes.h"
#include "off_law.h"
#include "physics_laws.h"
#include "written_law.h"

#include <pent/error.h>
#include <pent/runs/explain.h>
#include <pent/runs/run.h>
#include <pent/runs/scene_file.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <functional>

namespace pent::scene_fuzz {

namespace {

namespace fs = std::filesystem;
using simulator::Scene;

// One scene, its folder, and how to run it.
class Trial {
public:
    Trial(const Json& document, const fs::path& folder, int seconds)
        : document_(document), folder_(folder), seconds_(seconds) {
        write_meshes(document, folder);
        std::ofstream(scene_path()) << toml_text(document);
    }

    [[nodiscard]] const Json& document() const { return document_; }
    [[nodiscard]] fs::path scene_path() const { return folder_ / "scene.toml"; }
    [[nodiscard]] fs::path run_path(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] const Summary& summary() const { return summary_; }
    [[nodiscard]] int steps() const {
        const Json frames = value_at(document_, "scene.frames");
        return (frames.is_null() ? simulator::Scene().frames : frames.get<int>())
               * steps_per_frame();
    }
    [[nodiscard]] int steps_per_frame() const {
        const Json steps = value_at(document_, "scene.steps_per_frame");
        return steps.is_null() ? simulator::Scene().steps_per_frame : steps.get<int>();
    }

    ChildResult in_child(const std::string& name, const std::function<void()>& work) const {
        return run_in_child(work, folder_ / (name + ".log"), seconds_);
    }

    // The run that all others are compared with, and the only one if it is refused.
    void run_first() {
        first_ = in_child("first", [this] { run_whole("first", scene_path(), 1); });
        summary_.is_refused = first_.ended == Ended::Refused;
        if (first_.ended == Ended::Well) {
            sum_up(read_report(run_path("first")));
        }
    }
    [[nodiscard]] const ChildResult& first() const { return first_; }

    void run_whole(const std::string& name, const fs::path& scene, int threads) const {
        static_cast<void>(
            runs::run(runs::read_scene(scene), {.folder = run_path(name), .threads = threads}));
    }

    // Takes up to `steps` steps of a run, a new one or one that goes on; says whether it came to
    // its end.
    bool run_part(const std::string& name, int threads, int steps, bool is_new) const {
        int left = steps;
        const runs::RunReport report =
            runs::run(runs::read_scene(scene_path()),
                      {.folder = run_path(name), .resume = !is_new, .threads = threads},
                      {.should_stop = [&left] { return left-- == 0; }, .on_frame = {}});
        return report.verdict != runs::RunVerdict::Stopped;
    }

    // Empty if another run went well and is the same as the first.
    [[nodiscard]] std::string compare(const std::string& name,
                                      const ChildResult& result,
                                      Apart apart) const {
        if (result.ended != Ended::Well) {
            return name + ": " + result.text;
        }
        return first_difference(run_path("first"), run_path(name), apart);
    }

private:
    void sum_up(const Json& report) {
        summary_.has_diverged = report["verdict"] == "diverged";
        for (const Json& step : report["steps"]) {
            const Json& contact = step["contact"];
            summary_.has_touched |=
                contact["point_facet"] > 0 || contact["mixed"] > 0 || contact["obstacle"] > 0;
            summary_.has_slept |= step["asleep"] > 0;
            summary_.was_cut |= step["substeps"] > 1;
        }
    }

    const Json& document_;
    fs::path folder_;
    int seconds_;
    ChildResult first_;
    Summary summary_;
};

// ---------------------------------------------------------------------------------------- the laws

std::string ends_well(const Trial& trial) {
    return trial.first().ended == Ended::Broken ? trial.first().text : "";
}

// A refusal is one line that says where, and is the same for any number of threads.
std::string refuses_clearly(const Trial& trial) {
    if (trial.first().ended != Ended::Refused) {
        return "";
    }
    const std::string& text = trial.first().text;
    if (text.empty() || text.find('\n') != std::string::npos) {
        return "a refusal is not one line: " + text;
    }
    ChildResult again =
        trial.in_child("refused", [&] { trial.run_whole("refused", trial.scene_path(), 3); });
    const std::string name = trial.run_path("refused").string();
    if (const std::size_t at = again.text.find(name); at != std::string::npos) {
        again.text.replace(at, name.size(), trial.run_path("first").string());
    }
    return again.ended == Ended::Refused && again.text == text
               ? ""
               : "refused with \"" + text + "\", with three threads: " + again.text;
}

// Libraries never print.
std::string is_silent(const Trial& trial) {
    return trial.first().text.empty() ? "" : "printed: " + trial.first().text;
}

// No number of the report is missing, which is how JSON has those that are not finite; frames with
// such numbers cannot be written.
std::string is_finite(const Trial& trial) {
    std::string found;
    const std::function<void(const Json&, const std::string&)> look = [&](const Json& value,
                                                                          const std::string& path) {
        if (value.is_null() && !path.ends_with(".smallest_distance")) {
            found = "report.json" + path + " is not finite";
        }
        if (value.is_structured()) {
            for (const auto& [key, entry] : value.items()) {
                look(entry, path + "." + key);
            }
        }
    };
    look(read_report(trial.run_path("first")), "");
    return found;
}

std::string is_off(const Trial& trial) {
    return work_of_what_is_off(parse_document(text_of_file(trial.run_path("first") / "scene.toml")),
                               trial.run_path("first"));
}

std::string is_written_back(const Trial& trial) {
    const fs::path written = trial.run_path("first") / "scene.toml";
    const std::string lost = what_is_lost(trial.document(), parse_document(text_of_file(written)));
    if (!lost.empty()) {
        return lost;
    }
    const ChildResult again =
        trial.in_child("written", [&] { trial.run_whole("written", written, 1); });
    return trial.compare("written", again, Apart::Times);
}

std::string has_no_say_in_threads(const Trial& trial) {
    const ChildResult again =
        trial.in_child("threads", [&] { trial.run_whole("threads", trial.scene_path(), 3); });
    return trial.compare("threads", again, Apart::Times);
}

// Stopped in every frame, behind its first step where it has more than one.
std::string goes_on_after_stops(const Trial& trial) {
    const int each = trial.steps_per_frame() + (trial.steps_per_frame() > 1 ? 1 : 0);
    const ChildResult result = trial.in_child("stops", [&] {
        bool is_done = trial.run_part("stops", 1, each, true);
        for (int piece = 0; !is_done && piece < trial.steps(); ++piece) {
            is_done = trial.run_part("stops", 2, each, false);
        }
    });
    return trial.compare("stops", result, Apart::TimesAndWork);
}

std::string goes_on_after_one_stop(const Trial& trial) {
    const ChildResult result = trial.in_child("stop", [&] {
        if (!trial.run_part("stop", 1, trial.steps() / 2, true)) {
            static_cast<void>(trial.run_part("stop", 1, -1, false));
        }
    });
    return trial.compare("stop", result, Apart::TimesAndWork);
}

// Killed behind half of the steps, among the files of the last frame.
std::string goes_on_after_a_kill(const Trial& trial) {
    int left = (trial.steps() + 1) / 2;
    const fs::path run = trial.run_path("kill");
    const ChildResult killed = trial.in_child("killed", [&] {
        static_cast<void>(runs::run(runs::read_scene(trial.scene_path()), {.folder = run},
                                    {.should_stop =
                                         [&left] {
                                             if (left-- == 0) {
                                                 raise(SIGKILL);
                                             }
                                             return false;
                                         },
                                     .on_frame = {}}));
    });
    if (killed.ended == Ended::Well) {
        return "";  // it diverged before
    }
    if (killed.ended != Ended::Killed) {
        return "before the kill: " + killed.text;
    }
    std::vector<std::string> frames;
    for (const auto& entry : fs::directory_iterator(run / "frames")) {
        frames.push_back(entry.path().filename().string());
    }
    const std::size_t bodies = trial.document().at("body").size();
    const std::string last = trial.document().at("body").at(bodies - 1).at("name");
    std::erase_if(frames, [&](const std::string& name) { return !name.starts_with(last + "_"); });
    std::sort(frames.begin(), frames.end());
    if (frames.size() > 1) {
        fs::remove(run / "frames" / frames.back());
    }
    const ChildResult resumed =
        trial.in_child("kill", [&] { static_cast<void>(trial.run_part("kill", 3, -1, false)); });
    return trial.compare("kill", resumed, Apart::TimesAndWork);
}

std::string is_explained(const Trial& trial) {
    const ChildResult result = trial.in_child("explain", [&] {
        const std::string text =
            runs::explanation_text(runs::explain(runs::read_scene(trial.scene_path()), 1));
        for (const char* word : {" nan", "-nan", " inf", "-inf"}) {
            if (text.find(word) != std::string::npos) {
                throw BrokenLaw("the explanation has a number that is none:\n" + text);
            }
        }
    });
    return result.ended == Ended::Well ? "" : result.text;
}

template <void (*law)(const Scene&)>
std::string physics(const Trial& trial) {
    const ChildResult result =
        trial.in_child("physics", [&] { law(runs::read_scene(trial.scene_path())); });
    return result.ended == Ended::Well ? "" : result.text;
}

struct Law {
    const char* name;
    std::string (*find)(const Trial&);
    bool is_of_refused = false;  ///< Whether it says something of scenes that are refused.
};

// clang-format off
constexpr Law kLaws[] = {
    {"ends-well", ends_well, true},
    {"refusal",   refuses_clearly, true},
    {"silent",    is_silent},
    {"finite",    is_finite},
    {"off",       is_off},
    {"written",   is_written_back},
    {"threads",   has_no_say_in_threads},
    {"stops",     goes_on_after_stops},
    {"stop",      goes_on_after_one_stop},
    {"kill",      goes_on_after_a_kill},
    {"explain",   is_explained},
    {"momentum",  physics<check_momentum>},
    {"reaction",  physics<check_reaction>},
    {"frame",     physics<check_frame>},
    {"crossing",  physics<check_crossings>},
    {"sleep",     physics<check_sleep>},
    {"host",      physics<check_host>},
};
// clang-format on

}  // namespace

std::vector<std::string> law_names() {
    std::vector<std::string> names;
    for (const Law& law : kLaws) {
        names.emplace_back(law.name);
    }
    return names;
}

Checked check(const Json& scene, const fs::path& folder, const CheckOptions& options) {
    Trial trial(scene, folder, options.seconds);
    trial.run_first();
    Checked checked;
    checked.summary = trial.summary();
    for (const Law& law : kLaws) {
        const bool is_wanted = options.only.empty() || options.only == law.name;
        if (!is_wanted || (trial.first().ended != Ended::Well && !law.is_of_refused)) {
            continue;
        }
        const std::string what = law.find(trial);
        if (what.empty()) {
            continue;
        }
        checked.finding = Finding{law.name, what};
        break;
    }
    return checked;
}

}  // namespace pent::scene_fuzz
