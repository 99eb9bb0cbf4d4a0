#pragma once

#include <memory>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#include <type_traits>
#include <utility>
#include <vector>

namespace pent::simulator {

/// The threads of one simulation. Everything about threads is in this header.
///
/// Work is cut into chunks of a fixed size, whatever the number of threads, and partial sums are
/// added in the order of the chunks: results do not depend on the number of threads.
class Workers {
public:
    /// @param threads  At least 1.
    explicit Workers(int threads)
        : threads_(threads), arena_(std::make_unique<tbb::task_arena>(threads)) {}

    [[nodiscard]] int threads() const { return threads_; }

    /// Runs `work` with the threads at its disposal: for_each within it then costs least, and
    /// parallel loops of other libraries keep to them.
    template <typename Work>
    [[nodiscard]] auto run(const Work& work) const {
        return arena_->execute(work);
    }

    /// Calls work(i) for every i in [0, count), in any order and at the same time.
    template <typename Work>
    void for_each(int count, const Work& work) const {
        if (threads_ == 1 || count <= 1) {
            for (int i = 0; i < count; ++i) {
                work(i);
            }
            return;
        }
        arena_->execute([&] {
            tbb::parallel_for(
                tbb::blocked_range<int>(0, count, 1),
                [&](const tbb::blocked_range<int>& range) {
                    for (int i = range.begin(); i < range.end(); ++i) {
                        work(i);
                    }
                },
                tbb::simple_partitioner());
        });
    }

    /// Sum of work(i) over [0, count), added in the order of i.
    template <typename Work>
    [[nodiscard]] auto sum(int count, const Work& work) const {
        using Value = std::invoke_result_t<Work, int>;
        std::vector<Value> parts(static_cast<std::size_t>(count));
        for_each(count, [&](int i) { parts[static_cast<std::size_t>(i)] = work(i); });
        Value total{};
        for (const Value& part : parts) {
            total += part;
        }
        return total;
    }

private:
    int threads_;
    std::unique_ptr<tbb::task_arena> arena_;
};

}  // namespace pent::simulator
