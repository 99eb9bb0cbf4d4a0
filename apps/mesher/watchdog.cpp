// SPDX-License-Identifier: GPL-3.0-or-later

#include "watchdog.h"

#include <pent/formatted.h>
#include <pent/machine_memory.h>

#include <chrono>
#include <sys/resource.h>

namespace pent::apps {

Watchdog::Watchdog(Program& program, double seconds)
    : program_(program), thread_([this, seconds] { watch(seconds); }) {
    // Steps of the mesher are forks. One that is made while a thread starts may inherit a lock that
    // nobody will ever open: allocators of sanitizers have such locks.
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_watching_; });
}

Watchdog::~Watchdog() {
    {
        const std::lock_guard lock(mutex_);
        is_released_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

void Watchdog::watch(double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    std::unique_lock lock(mutex_);
    is_watching_ = true;
    changed_.notify_one();
    while (
        !changed_.wait_for(lock, std::chrono::milliseconds(100), [this] { return is_released_; })) {
        if (stop_requested()) {
            program_.abandon(Verdict::Stopped, "stopped as asked; no mesh was written");
        }
        if (std::chrono::steady_clock::now() > end) {
            program_.abandon(
                Verdict::Refused,
                formatted("not done after %g s; ask for fewer cells or a coarser surface, "
                          "or raise --time-limit",
                          seconds));
        }
    }
}

void limit_memory(double mebibytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they reserve terabytes
    const auto all = static_cast<double>(machine_memory());
    const auto bytes = static_cast<rlim_t>(mebibytes > 0 ? mebibytes * 1024 * 1024 : all);
    const rlimit limit{bytes, RLIM_INFINITY};
    ::setrlimit(RLIMIT_AS, &limit);
#else
    static_cast<void>(mebibytes);
#endif
}

}  // namespace pent::apps
