#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace pent::apps {

/// Says on stdout what is being done and for how long whenever nothing has been said for two
/// seconds: in one line that renews itself on a terminal, in plain lines when piped.
class Heartbeat {
public:
    explicit Heartbeat(bool quiet, std::chrono::milliseconds between = std::chrono::seconds(2));
    ~Heartbeat();
    Heartbeat(const Heartbeat&) = delete;
    Heartbeat& operator=(const Heartbeat&) = delete;
    Heartbeat(Heartbeat&&) = delete;
    Heartbeat& operator=(Heartbeat&&) = delete;

    /// @param stage  A few words, as in "fill".
    void begin(const std::string& stage);

    /// Somebody else has just said something: nothing is to be said for a while.
    void spoken();

private:
    using Clock = std::chrono::steady_clock;

    void beat();
    void say_so_far();
    void clear_line();

    // No allocation and no stream on the thread: the mesher forks meanwhile, and a child would
    // inherit their locks.
    static constexpr std::size_t kLongestStage = 64;
    std::array<char, kLongestStage> stage_{};
    Clock::time_point start_;  // of the stage
    Clock::time_point last_;   // when something was said
    std::chrono::milliseconds between_;
    bool is_terminal_;
    bool has_line_ = false;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool is_beating_ = false;
    bool is_over_ = false;
    std::thread thread_;  // not started where nothing is to be said
};

}  // namespace pent::apps
