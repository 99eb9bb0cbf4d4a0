// Draws small scenes at random, runs each in every way that a law is about, and shrinks those that
// break one; docs/testing.md has the laws. scripts/scene_fuzz.sh builds it with the sanitizers and
// runs it.

#include "child.h"
#include "draw.h"
#include "laws.h"
#include "meshes.h"
#include "shrink.h"
#include "support/temp_folder.h"

#include <pent/error.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>
#include <sys/wait.h>
#include <unistd.h>

namespace pent::scene_fuzz {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kUsage =
    "scene_fuzz [--seconds S] [--count N] [--seed FIRST] [--jobs N] [--found FOLDER] [--law NAME]\n"
    "scene_fuzz --scene FILE [--law NAME]     checks one scene\n"
    "scene_fuzz --print SEED                  prints the scene of a seed\n";

struct Options {
    double seconds = 0;       // 0: as long as it takes
    std::uint64_t count = 0;  // 0: as many as there is time for
    std::uint64_t seed = 1;
    std::uint64_t jobs = 1;
    fs::path found = "build/scene_fuzz/found";
    fs::path scene;
    std::string law;
    bool is_print = false;
};

std::uint64_t whole(const std::string& text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
        throw Error("expected a whole number, not \"" + text + "\"");
    }
    return value;
}

Options parse(const std::vector<std::string>& arguments) {
    Options options;
    for (std::size_t i = 0; i + 1 < arguments.size(); i += 2) {
        const std::string& key = arguments[i];
        const std::string& value = arguments[i + 1];
        if (key == "--seconds") {
            options.seconds = static_cast<double>(whole(value));
        } else if (key == "--count") {
            options.count = whole(value);
        } else if (key == "--seed" || key == "--print") {
            options.seed = whole(value);
            options.is_print = key == "--print";
        } else if (key == "--jobs") {
            options.jobs = std::max<std::uint64_t>(1, whole(value));
        } else if (key == "--found") {
            options.found = value;
        } else if (key == "--scene") {
            options.scene = value;
        } else if (key == "--law") {
            options.law = value;
        } else {
            throw Error("unknown option " + key + "\n" + kUsage);
        }
    }
    if (arguments.size() % 2 != 0) {
        throw Error(kUsage);
    }
    return options;
}

// A folder in memory, if there is one.
test::TempFolder work_folder() {
    return test::TempFolder(fs::exists("/dev/shm") ? fs::path("/dev/shm")
                                                   : fs::temp_directory_path());
}

Checked check_in_memory(const Json& scene, const std::string& law) {
    const test::TempFolder folder = work_folder();
    return check(scene, folder.path(), {.only = law});
}

// ---------------------------------------------------------------------------------- what was found

std::string report_text(const std::string& from, const Finding& finding) {
    return from + "\nlaw: " + finding.law + "\n" + finding.what
           + "\n\nTo see it again: scene_fuzz --scene scene.toml --law " + finding.law
           + "\nThe meshes beside it are for pent-sim.\n";
}

void keep(const fs::path& folder,
          const std::string& from,
          const Json& scene,
          const Finding& finding) {
    fs::create_directories(folder);
    std::ofstream(folder / "scene.toml") << toml_text(scene);
    std::ofstream(folder / "README") << report_text(from, finding);
    write_meshes(scene, folder);
}

// Shrinks a scene that breaks a law, and writes what is left.
void keep_shrunk(const Options& options,
                 std::uint64_t seed,
                 const Json& scene,
                 const Finding& finding) {
    constexpr int kTries = 300;
    constexpr std::chrono::minutes kLongest{3};
    const auto start = Clock::now();
    Finding last = finding;
    const Json least = shrink(
        scene,
        [&](const Json& simpler) {
            if (Clock::now() - start > kLongest) {
                return false;
            }
            const Checked checked = check_in_memory(simpler, finding.law);
            const bool is_same = checked.finding && checked.finding->law == finding.law;
            if (is_same) {
                last = *checked.finding;
            }
            return is_same;
        },
        kTries);
    const fs::path folder = options.found / (finding.law + "-" + std::to_string(seed));
    keep(folder, "scene_fuzz --seed " + std::to_string(seed) + " --count 1", least, last);
    std::printf("scene_fuzz: seed %llu breaks the law \"%s\": %s\n  shrunk to %s\n",
                static_cast<unsigned long long>(seed), last.law.c_str(),
                last.what.substr(0, last.what.find('\n')).c_str(), folder.c_str());
    std::fflush(stdout);
}

// ------------------------------------------------------------------------------------- many scenes

struct Tally {
    std::uint64_t scenes = 0;
    std::uint64_t found = 0;
    std::map<std::string, std::uint64_t> counts;
};

void count(Tally& tally, const Checked& checked) {
    ++tally.scenes;
    const Summary& summary = checked.summary;
    const std::pair<const char*, bool> kinds[] = {{"refused", summary.is_refused},
                                                  {"diverged", summary.has_diverged},
                                                  {"in contact", summary.has_touched},
                                                  {"asleep", summary.has_slept},
                                                  {"with steps cut", summary.was_cut}};
    for (const auto& [name, is_so] : kinds) {
        tally.counts[name] += is_so ? 1 : 0;
    }
}

// Seeds FIRST + job, FIRST + job + jobs, ...
Tally run_job(const Options& options, std::uint64_t job) {
    Tally tally;
    const auto start = Clock::now();
    const auto is_over = [&](std::uint64_t i) {
        const std::chrono::duration<double> spent = Clock::now() - start;
        return (options.count > 0 && i >= options.count)
               || (options.seconds > 0 && spent.count() > options.seconds);
    };
    for (std::uint64_t i = job; !is_over(i); i += options.jobs) {
        const std::uint64_t seed = options.seed + i;
        const Json scene = draw_scene(seed);
        const Checked checked = check_in_memory(scene, options.law);
        count(tally, checked);
        if (!checked.finding) {
            continue;
        }
        ++tally.found;
        keep_shrunk(options, seed, scene, *checked.finding);
    }
    return tally;
}

std::string as_text(const Tally& tally) {
    std::string text = std::to_string(tally.scenes) + "\t" + std::to_string(tally.found) + "\n";
    for (const auto& [name, number] : tally.counts) {
        text += name + "\t" + std::to_string(number) + "\n";
    }
    return text;
}

void add_text(const std::string& text, Tally& tally) {
    std::istringstream lines(text);
    std::uint64_t scenes = 0;
    std::uint64_t found = 0;
    std::string line;
    std::getline(lines, line);
    std::istringstream(line) >> scenes >> found;
    tally.scenes += scenes;
    tally.found += found;
    while (std::getline(lines, line)) {
        const std::size_t tab = line.find('\t');
        tally.counts[line.substr(0, tab)] += whole(line.substr(tab + 1));
    }
}

int fuzz(const Options& options) {
    const test::TempFolder tallies;
    std::vector<pid_t> children;
    for (std::uint64_t job = 0; job < options.jobs; ++job) {
        std::fflush(nullptr);
        const pid_t child = fork();
        if (child == 0) {
            std::ofstream(tallies / std::to_string(job)) << as_text(run_job(options, job));
            std::fflush(nullptr);
            _exit(0);
        }
        children.push_back(child);
    }
    Tally sum;
    for (std::uint64_t job = 0; job < options.jobs; ++job) {
        int status = 0;
        waitpid(children[job], &status, 0);
        if (status != 0) {
            throw Error("a process that checks scenes broke");
        }
        add_text(text_of_file(tallies / std::to_string(job)), sum);
    }
    std::printf("scene_fuzz: %llu scenes from seed %llu on, %llu break a law",
                static_cast<unsigned long long>(sum.scenes),
                static_cast<unsigned long long>(options.seed),
                static_cast<unsigned long long>(sum.found));
    for (const auto& [name, number] : sum.counts) {
        std::printf("; %llu %s", static_cast<unsigned long long>(number), name.c_str());
    }
    std::printf("\n");
    return sum.found == 0 ? 0 : 1;
}

int check_one(const Options& options) {
    const Json scene = parse_document(text_of_file(options.scene));
    const Checked checked = check_in_memory(scene, options.law);
    if (!checked.finding) {
        std::printf("scene_fuzz: %s breaks no law\n", options.scene.c_str());
        return 0;
    }
    std::printf("%s", report_text(options.scene.string(), *checked.finding).c_str());
    return 1;
}

int run(const std::vector<std::string>& arguments) {
    const Options options = parse(arguments);
    if (options.is_print) {
        std::printf("%s", toml_text(draw_scene(options.seed)).c_str());
        return 0;
    }
    return options.scene.empty() ? fuzz(options) : check_one(options);
}

}  // namespace
}  // namespace pent::scene_fuzz

int main(int argc, char** argv) {
    try {
        return pent::scene_fuzz::run({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "scene_fuzz: %s\n", error.what());
        return 2;
    }
}
