#include <pent/error.h>
#include <pent/parallel.h>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <support/host_tasks.h>
#include <support/messages.h>
#include <thread>
#include <vector>

namespace pent {
namespace {

// A host whose job system is used from one thread at a time, last task first; it fails the test if
// it is called from within a task, which it does not take.
TaskSystem backward_host() {
    const auto is_busy = std::make_shared<bool>(false);
    const auto run = [is_busy](std::size_t count, const std::function<void(std::size_t)>& task) {
        EXPECT_FALSE(*is_busy) << "called from within a task";
        *is_busy = true;
        for (std::size_t i = count; i > 0; --i) {
            task(i - 1);
        }
        *is_busy = false;
    };
    return {.workers = 4, .run = run};
}

// A host that takes loops within loops, each on threads of its own.
TaskSystem nesting_host(int workers) {
    TaskSystem tasks = test::host_tasks(workers);
    tasks.can_nest = true;
    return tasks;
}

struct Implementation {
    std::string name;
    TaskSystem tasks;
};

std::vector<Implementation> implementations() {
    return {{"Serial", {}},
            {"OwnWithOneThread", own_task_system(1)},
            {"OwnWithTwoThreads", own_task_system(2)},
            {"OwnWithEightThreads", own_task_system(8)},
            {"BackwardHost", backward_host()},
            {"HostOfTwo", test::host_tasks(2)},
            {"HostOfEight", test::host_tasks(8)},
            {"NestingHostOfThree", nesting_host(3)}};
}

class EveryTaskSystem : public testing::TestWithParam<Implementation> {
protected:
    const Workers workers_ = Workers(GetParam().tasks);
    const Workers& outside_ = workers_here();
};

INSTANTIATE_TEST_SUITE_P(Workers,
                         EveryTaskSystem,
                         testing::ValuesIn(implementations()),
                         [](const auto& instance) { return instance.param.name; });

// How often each index was called.
using Counts = std::vector<std::atomic<int>>;

void expect_each_once(const Counts& counts) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
        EXPECT_EQ(counts[i], 1) << i;
    }
}

// Numbers whose sum depends on the order in which they are added.
double summand(int i) {
    return (i % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, i * 7 % 19) / (i + 1);
}

TEST_P(EveryTaskSystem, CallsEachIndexOnceForAnyCount) {
    for (const int count : {0, 1, 2, 3, 7, 1000}) {
        Counts counts(static_cast<std::size_t>(count));
        workers_.for_each(count, [&](int i) { ++counts[static_cast<std::size_t>(i)]; });
        expect_each_once(counts);
    }
}

TEST_P(EveryTaskSystem, CutsALoopIntoChunksThatMissNothing) {
    for (const std::size_t count : {0, 1, 9, 10, 11, 1003}) {
        for (const std::size_t chunk : {1, 5, 10, 2000}) {
            Counts counts(count);
            workers_.run([&] { parallel_for(count, chunk, [&](std::size_t i) { ++counts[i]; }); });
            expect_each_once(counts);
        }
    }
}

TEST_P(EveryTaskSystem, AddsInTheOrderOfTheTasksToTheBit) {
    constexpr int kCount = 500;
    double expected = 0;
    double backward = 0;
    for (int i = 0; i < kCount; ++i) {
        expected += summand(i);
        backward += summand(kCount - 1 - i);
    }
    ASSERT_NE(expected, backward);  // the order tells
    for (int repeat = 0; repeat < 20; ++repeat) {
        EXPECT_EQ(workers_.sum(kCount, summand), expected);
    }
    EXPECT_EQ(workers_.sum(0, summand), 0);
}

TEST_P(EveryTaskSystem, RunsLoopsWithinLoops) {
    constexpr std::size_t kCount = 12;
    Counts counts(kCount * kCount * kCount);
    workers_.run([&] {
        parallel_for(kCount, [&](std::size_t i) {
            parallel_for(kCount, [&](std::size_t j) {
                parallel_for(kCount, std::size_t{5},
                             [&](std::size_t k) { ++counts[(i * kCount + j) * kCount + k]; });
            });
        });
    });
    expect_each_once(counts);
}

// Sums a range by halves, as trees are built.
std::int64_t sum_by_halves(std::int64_t begin, std::int64_t end) {
    if (end - begin < 8) {
        return (begin + end - 1) * (end - begin) / 2;
    }
    const std::int64_t middle = begin + (end - begin) / 2;
    std::int64_t left = 0;
    std::int64_t right = 0;
    parallel_invoke([&] { left = sum_by_halves(begin, middle); },
                    [&] { right = sum_by_halves(middle, end); });
    return left + right;
}

TEST_P(EveryTaskSystem, CallsBothOfTwoDownARecursion) {
    EXPECT_EQ(workers_.run([] { return sum_by_halves(0, 500); }), 500 * 499 / 2);
}

TEST_P(EveryTaskSystem, LetsTheExceptionOfTheLowestTaskThrough) {
    for (int repeat = 0; repeat < 20; ++repeat) {
        const auto fail = [&] {
            workers_.for_each(100, [](int i) {
                if (i % 10 == 7) {
                    throw Error(std::to_string(i));
                }
            });
        };
        EXPECT_EQ(test::error_of(fail), "7");
    }
}

TEST_P(EveryTaskSystem, LetsAnExceptionThroughLoopsWithinLoopsAndGoesOn) {
    const auto fail = [&] {
        workers_.run([] {
            parallel_for(4, [](int i) {
                parallel_for(4, [i](int j) {
                    if (i >= 1 && j >= 2) {
                        throw Error(std::to_string(i) + " " + std::to_string(j));
                    }
                });
            });
        });
    };
    EXPECT_EQ(test::error_of(fail), "1 2");
    EXPECT_EQ(&workers_here(), &outside_);
    EXPECT_EQ(workers_.sum(10, [](int i) { return i; }), 45);
}

TEST_P(EveryTaskSystem, IsThatOfALoopWithinRunAndWithinTasks) {
    std::atomic<int> others = 0;
    const auto look = [&] { others += &workers_here() == &workers_ ? 0 : 1; };
    workers_.run([&] {
        look();
        parallel_for(20, [&](int) {
            look();
            parallel_for(3, [&](int) { look(); });
        });
    });
    workers_.for_each(20, [&](int) { look(); });
    workers_.for_each(1, [&](int) { look(); });
    EXPECT_EQ(others, 0);
    EXPECT_EQ(&workers_here(), &outside_);
}

TEST_P(EveryTaskSystem, GivesBackWhatTheWorkReturns) {
    const std::vector<int> made = workers_.run([] { return std::vector<int>{1, 2, 3}; });
    EXPECT_EQ(made, (std::vector<int>{1, 2, 3}));
    const auto alone = workers_.run([] { return std::make_unique<int>(4); });  // cannot be copied
    EXPECT_EQ(*alone, 4);
}

TEST_P(EveryTaskSystem, MayRunWithinTheRunOfAnother) {
    const Workers outer(2);
    Counts counts(100);
    outer.for_each(10, [&](int i) {
        const Workers inner(GetParam().name == "BackwardHost" ? backward_host() : GetParam().tasks);
        inner.run([&] {
            EXPECT_EQ(&workers_here(), &inner);
            parallel_for(10, [&](int j) { ++counts[static_cast<std::size_t>(10 * i + j)]; });
        });
    });
    expect_each_once(counts);
}

// Two tasks that wait for each other end if they run at the same time; else one of them gives up.
bool run_at_the_same_time(const Workers& workers) {
    std::atomic<int> here = 0;
    std::atomic<bool> have_met = true;
    workers.for_each(2, [&](int) {
        ++here;
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (here < 2) {
            if (std::chrono::steady_clock::now() > end) {
                have_met = false;
                return;
            }
            std::this_thread::yield();
        }
    });
    return have_met;
}

TEST(Workers, RunTasksOfAHostAtTheSameTime) {
    EXPECT_TRUE(run_at_the_same_time(Workers(test::host_tasks(2))));
    const Workers nesting(nesting_host(2));
    nesting.for_each(2, [&](int) { EXPECT_TRUE(run_at_the_same_time(nesting)); });
}

TEST(Workers, RunTasksOfTheirOwnThreadsAtTheSameTime) {
    if (Workers(2).threads() == 1) {
        GTEST_SKIP() << "this build has no threads";
    }
    if (std::thread::hardware_concurrency() < 2) {
        GTEST_SKIP() << "this machine has one core";
    }
    EXPECT_TRUE(run_at_the_same_time(Workers(2)));
}

TEST(Workers, KeepALoopOnItsThreadWhereThereIsOneWorkerOrNone) {
    const std::thread::id caller = std::this_thread::get_id();
    const auto look = [&](int) { EXPECT_EQ(std::this_thread::get_id(), caller); };
    Workers(1).for_each(100, look);
    EXPECT_EQ(workers_here().threads(), 1);
    parallel_for(100, look);
    const Workers one(1);
    Workers(test::host_tasks(4)).run([&] { one.for_each(100, look); });
}

TEST(Workers, KeepALoopWithinATaskOnItsThreadWhereTheHostDoesNotNest) {
    const Workers workers(test::host_tasks(4));
    workers.for_each(8, [&](int) {
        const std::thread::id task = std::this_thread::get_id();
        parallel_for(8, [&](int) { EXPECT_EQ(std::this_thread::get_id(), task); });
        workers.run(
            [&] { parallel_for(8, [&](int) { EXPECT_EQ(std::this_thread::get_id(), task); }); });
    });
}

TEST(Workers, RefuseAHostWithoutWorkersOrWithoutAFunctionAndNoThreads) {
    EXPECT_EQ(test::error_of([] { Workers(0); }), "0 threads, expected at least 1");
    EXPECT_EQ(test::error_of([] { Workers(-1); }), "-1 threads, expected at least 1");
    EXPECT_EQ(test::error_of([] { Workers(TaskSystem{.workers = 0}); }),
              "task system: 0 workers, expected at least 1");
    EXPECT_EQ(test::error_of([] { Workers(TaskSystem{.workers = 3}); }),
              "task system: 3 workers and no function that runs tasks; give `run`, or one worker");
}

}  // namespace
}  // namespace pent
