#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace pent::apps {

/// Progress with rate and time left, on stdout: one line that renews itself on a terminal; plain
/// lines, at most one every two seconds, when piped.
class Progress {
public:
    /// @param label  What is done, as in "frames".
    /// @param total  How many there will be.
    Progress(std::string label, std::int64_t total, bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    Progress(Progress&&) = delete;
    Progress& operator=(Progress&&) = delete;

    /// @param done  How many are done, not decreasing.
    /// @param note  A few words more, as in "12 iterations".
    /// @return      Whether something was printed.
    bool update(std::int64_t done, const std::string& note = {});

    /// Ends the line; called by the destructor.
    void finish();

private:
    using Clock = std::chrono::steady_clock;

    std::string label_;
    std::int64_t total_;
    std::int64_t first_ =
        -1;  // what was done before the first update, so that a resume has a true rate
    bool quiet_;
    bool terminal_;
    bool open_line_ = false;
    Clock::time_point start_;
    Clock::time_point last_;
};

/// "0.8 s", "12 s", "3 min 05 s" or "2 h 07 min".
[[nodiscard]] std::string readable_time(double seconds);

/// "0.0213", "2.5" or "11712": three digits or, from 1000 on, all of the whole number.
[[nodiscard]] std::string readable_rate(double per_second);

}  // namespace pent::apps
