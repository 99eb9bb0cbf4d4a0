#pragma once

#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/wait.h>

namespace pent::test {

struct Outcome {
    int exit_code = -1;  ///< -1 if the program was ended by a signal.
    std::string out;
    std::string err;
};

inline std::string text_of(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// Runs one of our programs by the shell.
///
/// @param command  As typed, beginning with the program's name.
/// @param before   What to put in front, as in "ulimit -v 1000000;".
[[nodiscard]] inline Outcome run_program(const std::string& command,
                                         const std::string& before = "") {
    const TempFolder folder;
    const std::string line = before + " " PENT_BIN "/" + command + " >" + (folder / "out").string()
                             + " 2>" + (folder / "err").string() + " </dev/null";
    // The shell is the point: this is what a user does.
    const int status = std::system(line.c_str());  // NOLINT(cert-env33-c)
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(folder / "out"),
            text_of(folder / "err")};
}

/// What to put before a command that writes its files by halves, by a limit or a kill: counts of
/// coverage are written into files, too, and would damage those of other runs.
inline constexpr const char* kUncounted = "env GCOV_PREFIX=/dev/null GCOV_ERROR_FILE=/dev/null ";

/// What to put before a command so that no file of over so many bytes can be written, as on a full
/// disk.
[[nodiscard]] inline std::string full_disk(int bytes) {
    return std::string(kUncounted) + "prlimit --fsize=" + std::to_string(bytes);
}

/// What to put before a command so that Ctrl-C ends it as soon as a file exists.
[[nodiscard]] inline std::string interrupt_at(const std::filesystem::path& file) {
    // Shells let what they start in the background ignore Ctrl-C.
    return "interrupt() { env --default-signal=INT \"$@\" & "
           "while [ ! -e " + file.string() + " ] && kill -0 $!; do sleep 0.01; done; "
           "kill -INT $!; wait $!; }; interrupt";
}

/// Expects one line on stderr that begins with the program's name.
inline void expect_one_error_line(const Outcome& outcome, const std::string& program) {
    EXPECT_EQ(outcome.err.rfind(program + ": ", 0), 0U) << outcome.err;
    EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
}

}  // namespace pent::test
