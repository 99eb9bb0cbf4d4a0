#pragma once

#include <pent/parallel.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace pent::test {

/// A host's task system: as many threads as asked for, whatever the machine has, anew for each
/// loop.
inline TaskSystem host_tasks(int workers) {
    const auto run = [workers](std::size_t count, const std::function<void(std::size_t)>& task) {
        std::atomic<std::size_t> next = 0;
        const auto work = [&] {
            for (std::size_t i = next++; i < count; i = next++) {
                task(i);
            }
        };
        std::vector<std::thread> others;
        for (std::size_t k = 1; k < std::min(count, static_cast<std::size_t>(workers)); ++k) {
            others.emplace_back(work);
        }
        work();
        for (std::thread& other : others) {
            other.join();
        }
    };
    return {.workers = workers, .run = run};
}

}  // namespace pent::test
