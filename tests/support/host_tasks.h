#pragma once

#include <pent/parallel.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace pent::test {

/// A host's task system: as many threads as asked for, whatever the machine has, anew for each
/// loop. However late one starts, a task is left for it: what two of them may not do at once, the
/// thread sanitizer then sees.
inline TaskSystem host_tasks(int workers) {
    const auto run = [workers](std::size_t count, const std::function<void(std::size_t)>& task) {
        const std::size_t threads = std::min(count, static_cast<std::size_t>(workers));
        std::atomic<std::size_t> next = threads;
        const auto work = [&](std::size_t first) {
            for (std::size_t i = first; i < count; i = next++) {
                task(i);
            }
        };
        std::vector<std::thread> others;
        for (std::size_t k = 1; k < threads; ++k) {
            others.emplace_back(work, k);
        }
        work(0);
        for (std::thread& other : others) {
            other.join();
        }
    };
    return {.workers = workers, .run = run};
}

}  // namespace pent::test
