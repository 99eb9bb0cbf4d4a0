#pragma once

#include "same_file.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pent::apps {

/// How a program ended. Exit codes: 0 finished, 1 refused, 3 stopped or diverged (2: wrong usage).
enum class Verdict { Finished, Stopped, Refused, Diverged };

/// The options every program has.
struct CommonOptions {
    int threads = 0;     ///< At least 1; the number of cores unless asked.
    bool quiet = false;  ///< Nothing on stdout.
    std::string json;    ///< File for the machine-readable report; empty for none.
};

/// The frame of a program: common options, one line for an error, exit codes, the JSON report.
///
///     Program program("pent-slice", "Cuts 4D frames by hyperplanes", "pent-slice RUN/ -o OUT/");
///     program.options().add_option("input", input, "...")->required();
///     return program.run(argc, argv, [&] { ...; return Verdict::Finished; });
class Program {
public:
    /// @param example  A command line that works, shown at the end of --help.
    Program(std::string name, const std::string& description, const std::string& example);

    /// Where a program adds its own options before run().
    [[nodiscard]] CLI::App& options() { return cli_; }

    [[nodiscard]] const CommonOptions& common() const { return common_; }

    [[nodiscard]] const std::string& name() const { return name_; }

    /// What run() ended with, or would have said; empty if nothing went wrong.
    [[nodiscard]] const std::string& error() const { return error_; }

    /// "pent-slice 0.1.0", for created_by.
    [[nodiscard]] std::string name_and_version() const;

    /// What goes into the --json report beside program, version, verdict and seconds.
    [[nodiscard]] nlohmann::ordered_json& report() { return report_; }

    /// Says and writes nothing from here on, whatever comes: for a process beside one that does.
    void silence() {
        is_silent_ = true;
        common_.quiet = true;
    }
    [[nodiscard]] bool is_silent() const { return is_silent_; }

    /// One line for the user on stdout, unless --quiet.
    void say(const std::string& line) const;

    /// As the free function, with the --json report among the outputs; where it is the one that
    /// would do harm, no report is written. For the start of the body.
    void require_apart(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

    /// Parses, runs the body with --threads workers, reports, and returns the exit code.
    ///
    /// An Error (or any other exception) that leaves the body becomes one line on stderr and
    /// exit code 1. SIGINT and SIGTERM set stop_requested() once; a second one ends the program.
    [[nodiscard]] int run(int argc, const char* const* argv, const std::function<Verdict()>& body);

    /// Ends the program at once with the line on stderr, the report and the exit code that run()
    /// would give for it. For another thread, while the body is stuck in a library: nothing else
    /// may use the program meanwhile.
    [[noreturn]] void abandon(Verdict verdict, const std::string& error);

private:
    int fail(const std::string& message);
    int end(int code);  // this, but not 0 if what was printed has not arrived
    void write_report(Verdict verdict, const std::string& error);

    std::string name_;
    CLI::App cli_;
    CommonOptions common_;
    bool is_silent_ = false;
    std::string error_;
    std::chrono::steady_clock::time_point start_;
    nlohmann::ordered_json report_ = nlohmann::ordered_json::object();
};

/// Makes the folder of a file that is going to be written, as every program does for every file.
/// Throws an Error as make_folder() does.
void make_folder_for(const std::filesystem::path& file);

/// Whether the user asked the program to stop (SIGINT or SIGTERM).
[[nodiscard]] bool stop_requested();

}  // namespace pent::apps
