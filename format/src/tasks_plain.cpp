#include "pent/parallel.h"

#include <algorithm>
#include <thread>

// For the thread sanitizer, which has to see every fork and join, and cannot in the oneTBB that
// Debian ships. Threads are not reused and nothing is fast. Tasks are dealt out like cards: no two
// neighbors run on the same thread, and nothing orders the threads between the fork and the join,
// so what two tasks may not do at the same time is seen whatever the timing, on a single core too.

namespace pent {

namespace {

// Whoever asks for two threads may as well have more; whoever asks for one means it.
constexpr int kMinThreads = 4;

// Loops within loops get no threads of their own below this depth.
constexpr int kMaxDepth = 2;

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
thread_local int depth = 0;

}  // namespace

TaskSystem own_task_system(int threads) {
    const int workers = threads > 1 ? std::max(threads, kMinThreads) : 1;
    const auto run = [workers](std::size_t count, const std::function<void(std::size_t)>& task) {
        const std::size_t at_once =
            depth < kMaxDepth ? std::min(count, static_cast<std::size_t>(workers)) : 1;
        const auto deal = [&, inner = depth + (at_once > 1 ? 1 : 0)](std::size_t thread) {
            const int before = std::exchange(depth, inner);
            for (std::size_t i = thread; i < count; i += at_once) {
                task(i);
            }
            depth = before;
        };
        std::vector<std::thread> others;
        for (std::size_t thread = 1; thread < at_once; ++thread) {
            others.emplace_back(deal, thread);
        }
        deal(0);
        for (std::thread& other : others) {
            other.join();
        }
    };
    return {.workers = workers, .run = run, .can_nest = true};
}

}  // namespace pent
