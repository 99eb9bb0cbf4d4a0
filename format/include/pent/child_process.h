#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace pent {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// A nameless temporary file, gone when closed. Throws an Error if there is no room for one, with
/// the name of what it is for, if that has one.
[[nodiscard]] File temporary_file(const std::string& owner = "");

/// What a program starts with. File descriptors stay open in the caller, too; -1 is /dev/null.
struct ChildOptions {
    int input = -1;
    int output = -1;
    int errors = -1;
    std::filesystem::path folder = {};  ///< To work in; empty for ours.
    bool has_own_group = false;         ///< So that Ctrl-C in a terminal reaches us alone.
};

/// How a program ended.
struct ChildEnd {
    int exit_code = 0;       ///< Valid if signal is 0.
    int signal = 0;          ///< What ended it, or 0.
    double cpu_seconds = 0;  ///< User and system, all threads.

    bool operator==(const ChildEnd&) const = default;
};

/// A program that runs beside this one. Whoever lets go of it waits for its end.
class ChildProcess {
public:
    /// @param program  A path, or a name without '/' to look for in PATH.
    ///
    /// Throws an Error that names the program if it cannot be started.
    ChildProcess(const std::filesystem::path& program,
                 const std::vector<std::string>& arguments,
                 const ChildOptions& options = {});
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;
    ChildProcess(ChildProcess&&) = delete;
    ChildProcess& operator=(ChildProcess&&) = delete;

    [[nodiscard]] int id() const { return id_; }

    /// How it ended; nothing while it runs.
    [[nodiscard]] std::optional<ChildEnd> poll();

    /// Waits for its end. Throws an Error if something else has waited for it.
    [[nodiscard]] ChildEnd wait();

    /// Asks it to end: SIGTERM.
    void stop() const;

    /// Lets it run on without us.
    void detach() { end_ = ChildEnd(); }

private:
    [[nodiscard]] std::optional<ChildEnd> wait(int options);

    std::string name_;
    int id_ = -1;
    std::optional<ChildEnd> end_;
};

}  // namespace pent
