#include "pent/parallel.h"

#include <pent/error.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <string>

namespace pent {

namespace {

// Loops deep in a computation find its workers here, as those of oneTBB find their arena. Set for
// the time of a task or a run() alone, so nothing is left behind on a host's threads.
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
thread_local const Workers* current_workers = nullptr;
thread_local bool is_in_task = false;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

// Checked here, as implementations of own_task_system() differ in what they make of other numbers.
TaskSystem own_checked(int threads) {
    if (threads < 1) {
        throw Error(std::to_string(threads) + " threads, expected at least 1");
    }
    return own_task_system(threads);
}

TaskSystem checked(TaskSystem tasks) {
    if (tasks.workers < 1) {
        throw Error("task system: " + std::to_string(tasks.workers)
                    + " workers, expected at least 1");
    }
    if (tasks.workers > 1 && tasks.run == nullptr) {
        throw Error("task system: " + std::to_string(tasks.workers)
                    + " workers and no function that runs tasks; give `run`, or one worker");
    }
    return tasks;
}

// Keeps the exception of the lowest task that threw one. Tasks above that one are skipped, all
// below it run, so that it is the same one whatever the order.
class FirstFailure {
public:
    template <typename Work>
    void guard(std::size_t i, const Work& work) noexcept {
        if (i > lowest_.load(std::memory_order_relaxed)) {
            return;
        }
        try {
            work();
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (i < lowest_.load(std::memory_order_relaxed)) {
                lowest_.store(i, std::memory_order_relaxed);
                error_ = std::current_exception();
            }
        }
    }

    void rethrow() const {
        if (error_ != nullptr) {
            std::rethrow_exception(error_);
        }
    }

private:
    std::atomic<std::size_t> lowest_ = static_cast<std::size_t>(-1);
    std::mutex mutex_;
    std::exception_ptr error_;
};

}  // namespace

Workers::Workers(int threads) : Workers(own_checked(threads)) {}

Workers::Workers(TaskSystem tasks) : tasks_(checked(std::move(tasks))) {}

Workers::Here::Here(const Workers& workers, bool is_task)
    : workers_before_(std::exchange(current_workers, &workers)),
      is_task_before_(std::exchange(is_in_task, is_in_task || is_task)) {}

Workers::Here::~Here() {
    current_workers = workers_before_;
    is_in_task = is_task_before_;
}

bool Workers::is_parallel() const {
    return tasks_.workers > 1 && (tasks_.can_nest || !is_in_task);
}

void Workers::run_tasks(std::size_t count, const std::function<void(std::size_t)>& task) const {
    FirstFailure failure;
    const auto guarded = [&](std::size_t i) {
        failure.guard(i, [&] {
            const Here here(*this, true);
            task(i);
        });
    };
    tasks_.run(count, std::cref(guarded));
    failure.rethrow();
}

void Workers::run_here(const std::function<void()>& work) const {
    const auto here_alone = [&] {
        const Here here(*this, false);
        work();
    };
    if (tasks_.run == nullptr || !tasks_.can_nest) {
        here_alone();
        return;
    }
    FirstFailure failure;
    tasks_.run(1, [&](std::size_t i) { failure.guard(i, here_alone); });
    failure.rethrow();
}

const Workers& workers_here() {
    static const Workers one(TaskSystem{});
    return current_workers != nullptr ? *current_workers : one;
}

}  // namespace pent
