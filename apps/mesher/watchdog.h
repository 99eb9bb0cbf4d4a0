#pragma once

#include "common/program.h"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace pent::apps {

/// Ends the program when it takes too long or is asked to stop, while work is done that cannot be
/// interrupted: by Program::abandon(), as refused or as stopped.
///
/// Let it live only while nothing is written, and the program is not used: the process ends at
/// once.
class Watchdog {
public:
    /// @param seconds  Limit, above 0.
    Watchdog(Program& program, double seconds);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;
    Watchdog(Watchdog&&) = delete;
    Watchdog& operator=(Watchdog&&) = delete;

private:
    void watch(double seconds);

    Program& program_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool is_watching_ = false;
    bool is_released_ = false;
    std::thread thread_;
};

/// Bounds this process's memory: beyond it, allocations fail as "out of memory".
///
/// @param mebibytes  Above 0; 0 for as much as the machine has.
void limit_memory(double mebibytes);

}  // namespace pent::apps
