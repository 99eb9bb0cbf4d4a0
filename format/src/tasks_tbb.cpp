#include "pent/parallel.h"

#include <algorithm>
#include <memory>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

namespace pent {

TaskSystem own_task_system(int threads) {
    // What is beyond the machine's cores, oneTBB does not start but warns of.
    const std::size_t allowed =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    const int workers = static_cast<int>(std::min(static_cast<std::size_t>(threads), allowed));
    const auto arena = std::make_shared<tbb::task_arena>(workers);
    const auto run = [arena](std::size_t count, const std::function<void(std::size_t)>& task) {
        arena->execute([&] {
            if (count == 1) {
                task(0);
                return;
            }
            tbb::parallel_for(
                tbb::blocked_range<std::size_t>(0, count, 1),
                [&](const tbb::blocked_range<std::size_t>& range) {
                    for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        task(i);
                    }
                },
                tbb::simple_partitioner());
        });
    };
    return {.workers = workers, .run = run, .can_nest = true};
}

}  // namespace pent
