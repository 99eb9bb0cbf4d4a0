#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <type_traits>
#include <vector>

/// What we use of oneTBB, by plain threads: for the preset `tsan` alone.
///
/// The thread sanitizer must see every fork and join, and Debian's library is not built with it. Here all
/// of that is std::thread, which the sanitizer knows. Pieces are as small as the grain allows and
/// dealt out like cards: two neighbors never run on the same thread, and nothing orders the threads
/// between the fork and the join. So what two pieces may not do at the same time is seen whatever the
/// timing, on a single core too. Nothing is reused and nothing is fast.
namespace tbb {

namespace detail {

inline constexpr int kLeastThreads = 4;

/// Threads that a loop may use on this thread.
inline thread_local int threads_here = kLeastThreads;

/// Loops within loops get no threads of their own below this depth.
inline thread_local int depth_here = 0;
inline constexpr int kMostDepth = 2;

/// Whoever asks for two threads may as well have more; whoever asks for one means it.
inline int at_least(int threads) {
    return threads > 1 ? std::max(threads, kLeastThreads) : 1;
}

/// Calls work(0), work(1), ... each on a thread of its own, the first on this one; an exception of
/// theirs reaches the caller when all have ended.
template <typename Work>
void on_threads(int count, const Work& work) {
    std::vector<std::exception_ptr> errors(static_cast<std::size_t>(count));
    const auto guarded = [&, threads = threads_here, depth = depth_here](int i) {
        threads_here = threads;
        depth_here = depth + 1;
        try {
            work(i);
        } catch (...) {
            errors[static_cast<std::size_t>(i)] = std::current_exception();
        }
        depth_here = depth;
    };
    std::vector<std::thread> others;
    for (int i = 1; i < count; ++i) {
        others.emplace_back(guarded, i);
    }
    guarded(0);
    for (std::thread& other : others) {
        other.join();
    }
    for (const std::exception_ptr& error : errors) {
        if (error != nullptr) {
            std::rethrow_exception(error);
        }
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
    if (range.end() <= range.begin()) {
        return;
    }
    const Index pieces = (range.end() - range.begin() + grain - 1) / grain;
    const Index most = detail::depth_here < detail::kMostDepth ? detail::threads_here : 1;
    const Index threads = std::min(pieces, most);
    detail::on_threads(static_cast<int>(threads), [&](int thread) {
        for (Index i = thread; i < pieces; i += threads) {
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
    explicit task_arena(int threads) : threads_(detail::at_least(threads)) {}

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
        detail::threads_here = detail::at_least(static_cast<int>(threads));
    }
    ~global_control() { detail::threads_here = before_; }
    global_control(const global_control&) = delete;
    global_control& operator=(const global_control&) = delete;

private:
    int before_ = detail::threads_here;
};

}  // namespace tbb
