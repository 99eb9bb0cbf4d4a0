#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace pent {

/// All threads of the libraries come from here. A loop is a count of tasks that does not depend on
/// the number of threads; each writes results of its own, and sums are added in the order of the
/// tasks: same in, same out, whatever runs them.

/// What runs tasks at the same time: the library's own threads, or a host program's job system.
struct TaskSystem {
    int workers = 1;  ///< How many tasks may run at the same time, at least 1.

    /// Calls task(0), ..., task(count - 1), each once, in any order and on any threads, and returns
    /// when all have ended. Tasks do not throw. May be empty where there is one worker.
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& task)> run = {};

    /// Whether `run` may be called from within a task. If not, a loop within a task stays on the
    /// thread of that task.
    bool can_nest = false;
};

/// The task system that the library was built with: oneTBB, none (one worker, whatever was asked
/// for), or plain threads for the thread sanitizer; see PENT_THREADS in CMakeLists.txt.
///
/// @param threads  At least 1; oneTBB runs no more at a time than the machine has cores.
[[nodiscard]] TaskSystem own_task_system(int threads);

/// The threads of one computation.
class Workers {
public:
    /// @param threads  At least 1, of own_task_system().
    explicit Workers(int threads);

    /// Throws an Error if there is no worker, or more than one and no `run`.
    explicit Workers(TaskSystem tasks);

    /// How many tasks may run at the same time.
    [[nodiscard]] int threads() const { return tasks_.workers; }

    /// Runs `work` with these as the workers of every loop within it, on whatever thread, and
    /// returns its result. With oneTBB, loops of other libraries keep to them as well.
    template <typename Work>
    auto run(const Work& work) const;

    /// Calls work(i) for every i in [0, count), each a task. Of exceptions that of the lowest i
    /// comes through, when all tasks have ended; those behind it may not have run.
    template <typename Index, typename Work>
    void for_each(Index count, const Work& work) const;

    /// Sum of work(i) over [0, count), each a task, added in the order of i.
    template <typename Index, typename Work>
    [[nodiscard]] auto sum(Index count, const Work& work) const;

private:
    /// Makes some workers those of this thread for as long as it lives.
    class Here {
    public:
        Here(const Workers& workers, bool is_task);
        ~Here();
        Here(const Here&) = delete;
        Here& operator=(const Here&) = delete;

    private:
        const Workers* workers_before_;
        bool is_task_before_;
    };

    [[nodiscard]] bool is_parallel() const;
    void run_tasks(std::size_t count, const std::function<void(std::size_t)>& task) const;
    void run_here(const std::function<void()>& work) const;

    TaskSystem tasks_;
};

/// The workers whose run() or task this thread is in; outside of all, one: this thread.
[[nodiscard]] const Workers& workers_here();

/// Calls work(i) for every i in [0, count), each a task of workers_here().
template <typename Index, typename Work>
void parallel_for(Index count, const Work& work) {
    workers_here().for_each(count, work);
}

/// A chunk for loops in which work(i) is some dozens of operations.
inline constexpr int kLightChunk = 4096;

/// The same with `chunk` of them, at least 1, to a task: where work(i) is little.
template <typename Index, typename Work>
void parallel_for(Index count, std::type_identity_t<Index> chunk, const Work& work) {
    const Index chunks = count / chunk + (count % chunk == 0 ? 0 : 1);
    workers_here().for_each(chunks, [&](Index c) {
        const Index begin = c * chunk;
        const Index end = count - begin < chunk ? count : begin + chunk;
        for (Index i = begin; i < end; ++i) {
            work(i);
        }
    });
}

/// Calls both, each a task of workers_here().
template <typename First, typename Second>
void parallel_invoke(const First& first, const Second& second) {
    workers_here().for_each(2, [&](int i) {
        if (i == 0) {
            first();
        } else {
            second();
        }
    });
}

template <typename Work>
auto Workers::run(const Work& work) const {
    using Result = std::invoke_result_t<const Work&>;
    if constexpr (std::is_void_v<Result>) {
        run_here(std::cref(work));
    } else {
        std::optional<Result> result;
        const auto keep = [&] { result.emplace(work()); };
        run_here(std::cref(keep));
        return *std::move(result);
    }
}

template <typename Index, typename Work>
void Workers::for_each(Index count, const Work& work) const {
    if (count <= 1 || !is_parallel()) {
        const Here here(*this, false);
        for (Index i = 0; i < count; ++i) {
            work(i);
        }
        return;
    }
    const auto task = [&](std::size_t i) { work(static_cast<Index>(i)); };
    run_tasks(static_cast<std::size_t>(count), std::cref(task));
}

template <typename Index, typename Work>
auto Workers::sum(Index count, const Work& work) const {
    using Value = std::invoke_result_t<const Work&, Index>;
    std::vector<Value> parts(static_cast<std::size_t>(count));
    for_each(count, [&](Index i) { parts[static_cast<std::size_t>(i)] = work(i); });
    Value total{};
    for (const Value& part : parts) {
        total += part;
    }
    return total;
}

}  // namespace pent
