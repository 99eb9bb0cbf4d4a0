#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <type_traits>
#include <vector>

/// What we use of oneTBB, by plain threads: for the preset `tsan` alone.
///
/// The thread sanitizer must see every fork and join, and Debian's library is not built with it. Here all
/// of that is std::thread, which the sanitizer knows. Bodies run on the same pieces as with oneTBB,
/// each on whichever thread comes first; nothing is reused and nothing is fast.
namespace tbb {

namespace detail {

/// Threads that a loop may use on this thread; more than there are cores, so that they are interrupted.
inline thread_local int threads_here = 4;

/// Loops within loops get no threads of their own below this depth.
inline thread_local int depth_here = 0;
inline constexpr int kMostDepth = 2;

/// Runs work() on as many threads at the same time, this one among them.
template <typename Work>
void on_threads(int count, const Work& work) {
    std::vector<std::thread> others;
    const int threads = threads_here;
    const int depth = depth_here + 1;
    for (int i = 1; i < count && depth <= kMostDepth; ++i) {
        others.emplace_back([&work, threads, depth] {
            threads_here = threads;
            depth_here = depth;
            work();
        });
    }
    work();
    for (std::thread& other : others) {
        other.join();
    }
}

}  // namespace detail

struct simple_partitioner {};

template <typename Index>
class blocked_range {
public:
    blocked_range(Index begin, Index end, std::size_t grain = 1)
        : begin_(begin), end_(end), grain_(grain) {}
    [[nodiscard]] Index begin() const { return begin_; }
    [[nodiscard]] Index end() const { return end_; }
    [[nodiscard]] std::size_t grainsize() const { return grain_; }

private:
    Index begin_;
    Index end_;
    std::size_t grain_;
};

template <typename Index, typename Body, typename Partitioner = simple_partitioner>
void parallel_for(const blocked_range<Index>& range, const Body& body, const Partitioner& = {}) {
    const auto grain = static_cast<Index>(range.grainsize());
    const Index pieces = (range.end() - range.begin() + grain - 1) / grain;
    std::atomic<Index> next{0};
    detail::on_threads(static_cast<int>(std::min<Index>(pieces, detail::threads_here)), [&] {
        // relaxed: the pieces must not be ordered by this counter
        for (Index i = next.fetch_add(1, std::memory_order_relaxed); i < pieces;
             i = next.fetch_add(1, std::memory_order_relaxed)) {
            const Index begin = range.begin() + i * grain;
            body(blocked_range<Index>(begin, std::min(begin + grain, range.end()),
                                      range.grainsize()));
        }
    });
}

template <typename Index, typename Action, typename Partitioner = simple_partitioner>
requires std::is_integral_v<Index>
void parallel_for(Index begin, Index end, const Action& action, const Partitioner& = {}) {
    parallel_for(blocked_range<Index>(begin, end), [&](const blocked_range<Index>& range) {
        for (Index i = range.begin(); i < range.end(); ++i) {
            action(i);
        }
    });
}

template <typename First, typename Second>
void parallel_invoke(const First& first, const Second& second) {
    parallel_for(0, 2, [&](int i) {
        if (i == 0) {
            first();
        } else {
            second();
        }
    });
}

class task_arena {
public:
    explicit task_arena(int threads) : threads_(threads) {}

    template <typename Work>
    auto execute(const Work& work) {
        struct Restore {
            int threads = detail::threads_here;
            ~Restore() { detail::threads_here = threads; }
        } const restore;
        detail::threads_here = threads_;
        return work();
    }

private:
    int threads_;
};

/// Limits the loops of the thread that makes it.
class global_control {
public:
    enum parameter { max_allowed_parallelism };
    global_control(parameter, std::size_t threads) {
        detail::threads_here = static_cast<int>(threads);
    }
    ~global_control() { detail::threads_here = before_; }
    global_control(const global_control&) = delete;
    global_control& operator=(const global_control&) = delete;

private:
    int before_ = detail::threads_here;
};

}  // namespace tbb
