#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace pent::study {

struct ChildOutcome {
    int exit_code = -1;  ///< -1 if a signal ended it.
    double wall_seconds = 0;
    double cpu_seconds = 0;  ///< User and system, all threads.
    double peak_bytes = 0;   ///< Most memory in use at a time, looked up every few milliseconds.
    std::string error;       ///< Last line on stderr.
};

/// Runs a program and waits for it. Its stdout is dropped.
///
/// @param folder       Its working folder; empty for ours.
/// @param should_stop  Asked now and then; once true, the program gets SIGTERM. May be empty.
/// Throws an Error if the program cannot be started.
[[nodiscard]] ChildOutcome run_child(const std::filesystem::path& program,
                                     const std::vector<std::string>& arguments,
                                     const std::filesystem::path& folder,
                                     const std::function<bool()>& should_stop);

}  // namespace pent::study
