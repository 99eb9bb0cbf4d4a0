#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

namespace pent::apps {

/// Ends the program when it takes too long or is asked to stop, while a library is at work that
/// cannot be interrupted. Says so in one line on stderr; exits with 1, or 3 when asked to stop.
///
/// Let it live only while nothing is written: the process ends at once.
class Watchdog {
public:
    /// @param seconds  Limit, above 0.
    explicit Watchdog(double seconds);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;
    Watchdog(Watchdog&&) = delete;
    Watchdog& operator=(Watchdog&&) = delete;

private:
    void watch(double seconds);

    std::mutex mutex_;
    std::condition_variable released_;
    bool is_released_ = false;
    std::thread thread_;
};

/// Bounds this process's memory: beyond it, allocations fail as "out of memory".
///
/// @param mebibytes  Above 0; 0 for as much as the machine has.
void limit_memory(double mebibytes);

}  // namespace pent::apps
