#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace pent::scene_fuzz {

/// How work ended that ran in a process of its own.
enum class Ended {
    Well,     ///< It returned.
    Refused,  ///< It threw a pent::Error.
    Broken,   ///< Anything else: a signal, a sanitizer, another exception, too much time.
    Killed,   ///< By SIGKILL, as a stage that tests this does to itself.
};

struct ChildResult {
    Ended ended = Ended::Well;
    std::string
        text;  ///< The message of the Error, or what is known of the end and what was printed.
};

/// Runs work in a fork, so that whatever it does ends nothing but itself. What it prints goes to
/// `log`. The calling process must have no threads.
///
/// @param seconds  Of processor time; many times as much of the clock, for what waits forever.
[[nodiscard]] ChildResult run_in_child(const std::function<void()>& work,
                                       const std::filesystem::path& log,
                                       int seconds);

/// The text of a file, or nothing.
[[nodiscard]] std::string text_of_file(const std::filesystem::path& path);

}  // namespace pent::scene_fuzz
