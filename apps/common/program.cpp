#include "program.h"

#include "build_info.h"
#include "usage_error.h"
#include "values.h"

#include <pent/error.h>
#include <pent/output_file.h>
#include <pent/parallel.h>
#include <pent/printable.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <numeric>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace pent::apps {

namespace {

// A signal handler can reach nothing but statics, and a watchdog reads this on a thread of its own.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<int> stop_signals = 0;
static_assert(std::atomic<int>::is_always_lock_free);  // nothing else is allowed in a handler

void on_stop_signal(int signal) {
    if (++stop_signals > 1) {
        std::signal(signal, SIG_DFL);  // GCOVR_EXCL_LINE: counters end with the process
        std::raise(signal);            // GCOVR_EXCL_LINE
    }
}

std::string verdict_name(Verdict verdict) {
    switch (verdict) {
        case Verdict::Finished:
            return "finished";
        case Verdict::Stopped:
            return "stopped";
        case Verdict::Refused:
            return "refused";
        case Verdict::Diverged:
            break;
    }
    return "diverged";
}

int exit_code(Verdict verdict) {
    switch (verdict) {
        case Verdict::Finished:
            return 0;
        case Verdict::Refused:
            return 1;
        case Verdict::Stopped:
        case Verdict::Diverged:
            break;
    }
    return 3;
}

int default_threads() {
    return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

std::string one_line(std::string text) {
    while (!text.empty() && text.back() == '\n') {
        text.pop_back();
    }
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

}  // namespace

void make_folder_for(const std::filesystem::path& file) {
    if (file.has_parent_path()) {
        make_folder(file.parent_path());
    }
}

namespace {

// What stands behind an option in --help, as people write it: "INT from 1 to 64 [4]" where CLI11
// has "INT:INT in [1 - 64]=4".
class PlainFormatter : public CLI::Formatter {
public:
    std::string make_option_opts(const CLI::Option* option) const override {
        std::string text;
        if (const std::string told = option->get_option_text(); !told.empty()) {
            text += " " + told;
        } else if (option->get_type_size() != 0) {
            std::string type = option->get_type_name();
            std::replace(type.begin(), type.end(), ':', ' ');
            const std::string preset = option->get_default_str();
            text += (type.empty() ? "" : " " + type) + (preset.empty() ? "" : " [" + preset + "]");
            if (option->get_expected_max() == CLI::detail::expected_max_vector_size) {
                text += " ...";
            }
            text += option->get_required() ? " REQUIRED" : "";
        }
        return text + names_of(" Needs:", option->get_needs())
               + names_of(" Excludes:", option->get_excludes());
    }

private:
    static std::string names_of(const std::string& heading, const std::set<CLI::Option*>& options) {
        std::vector<std::string> names;  // the order of the set is that of addresses
        for (const CLI::Option* option : options) {
            names.push_back(" " + option->get_name());
        }
        std::sort(names.begin(), names.end());
        return std::accumulate(names.begin(), names.end(), names.empty() ? "" : heading);
    }
};

}  // namespace

bool stop_requested() {
    return stop_signals != 0;
}

Program::Program(std::string name, const std::string& description, const std::string& example)
    : name_(std::move(name)), cli_(description, name_) {
    common_.threads = default_threads();
    cli_.set_version_flag("--version", name_and_version() + "\n" + build_info(),
                          "Print version, commit and features of this build, and exit");
    cli_.add_option("--threads", common_.threads, "Threads to use; default: the number of cores")
        ->check(whole_number(1, 1024));
    cli_.add_flag("--quiet", common_.quiet, "Print nothing but errors");
    cli_.add_option("--json", common_.json, "Write a machine-readable report to this file")
        ->type_name("FILE");
    cli_.formatter(std::make_shared<PlainFormatter>());
    cli_.footer("Example:\n  " + example);
}

std::string Program::name_and_version() const {
    return name_ + " " PENT_VERSION;
}

void Program::say(const std::string& line) const {
    if (!common_.quiet) {
        std::printf("%s\n", printable(line).c_str());
        std::fflush(stdout);
    }
}

int Program::fail(const std::string& message) {
    error_ = one_line(message);
    std::fflush(stdout);
    if (is_silent_) {
        return exit_code(Verdict::Refused);
    }
    std::fprintf(stderr, "%s: %s\n", name_.c_str(), printable(error_).c_str());
    return exit_code(Verdict::Refused);
}

int Program::end(int code) {
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) {
        return code;
    }
    const int refused =
        fail("standard output: cannot be written; free some space or print elsewhere");
    return code != 0 ? code : refused;
}

void Program::write_report(Verdict verdict, const std::string& error) {
    if (common_.json.empty() || is_silent_) {
        return;
    }
    nlohmann::ordered_json json;
    json["program"] = name_;
    json["version"] = PENT_VERSION;
    json["verdict"] = verdict_name(verdict);
    json["seconds"] =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    json["threads"] = common_.threads;
    if (!error.empty()) {
        json["error"] = error;
    }
    json.update(report_);
    // Paths may have bytes that are not UTF-8.
    const auto replace = nlohmann::ordered_json::error_handler_t::replace;
    make_folder_for(common_.json);
    write_text(common_.json, json.dump(2, ' ', false, replace) + "\n");
}

void Program::require_apart(const std::vector<NamedFile>& inputs,
                            const std::vector<NamedFile>& outputs) {
    // The report first: it would tell of the errors of the others, wherever it goes.
    std::vector<NamedFile> others = inputs;
    others.insert(others.end(), outputs.begin(), outputs.end());
    const NamedFile report{"--json", std::exchange(common_.json, std::string())};
    apps::require_apart(others, {report});
    common_.json = report.path.string();
    apps::require_apart(inputs, outputs);
}

void Program::abandon(Verdict verdict, const std::string& error) {
    fail(error);
    try {
        write_report(verdict, one_line(error));
    } catch (const Error& report_error) {
        fail(report_error.what());
    }
    std::_Exit(exit_code(verdict));
}

int Program::run(int argc, const char* const* argv, const std::function<Verdict()>& body) {
    try {
        cli_.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help and --version
        return is_silent_ ? 0 : end(cli_.exit(success));
    } catch (const CLI::ParseError& error) {
        fail(usage_error(cli_, error) + " (see " + name_ + " --help)");
        return 2;
    }
    if (const std::string wrong = swallowed_option(cli_); !wrong.empty()) {
        fail(wrong + " (see " + name_ + " --help)");
        return 2;
    }
    std::signal(SIGINT, on_stop_signal);
    std::signal(SIGTERM, on_stop_signal);
    std::signal(SIGXFSZ, SIG_IGN);  // a limit on file size then is an error of write()
    start_ = std::chrono::steady_clock::now();
    Verdict verdict = Verdict::Refused;
    std::string error;
    try {
        verdict = Workers(common_.threads).run(body);
    } catch (const std::bad_alloc&) {
        error = "out of memory";
    } catch (const std::filesystem::filesystem_error& failure) {
        error = failure.path1().string() + ": " + failure.code().message();
    } catch (const std::exception& exception) {
        error = one_line(exception.what());
    }
    try {
        write_report(verdict, error);
    } catch (const Error& report_error) {
        if (error.empty()) {
            return fail(report_error.what());
        }
    }
    return end(error.empty() ? exit_code(verdict) : fail(error));
}

}  // namespace pent::apps
