#pragma once

#include <pent/child_process.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace pent::mesher {

/// How a process ended and what it wrote to stderr.
struct ProcessResult {
    int exit_code = 0;  ///< Valid if signal is 0.
    int signal = 0;     ///< What ended it, or 0.
    std::string log;    ///< The last part of what it printed, at most 4 KiB.
};

/// Runs a program to its end with stdin from one file and stdout into another. Files, not pipes:
/// neither side can wait for the other.
[[nodiscard]] ProcessResult run_process(const std::filesystem::path& program,
                                        const std::vector<std::string>& arguments,
                                        std::FILE* input,
                                        std::FILE* output);

/// Looks for a helper program beside the running one, then in ../libexec/pent beside its folder.
/// Throws an Error that says where it looked.
[[nodiscard]] std::filesystem::path find_helper(const std::string& name);

}  // namespace pent::mesher
