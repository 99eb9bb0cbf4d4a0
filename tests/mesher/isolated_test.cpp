#include "isolated.h"

#include "support/messages.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <sys/resource.h>

namespace pent::mesher {
namespace {

using Step = std::function<Pieces<3>()>;

std::string message_of(const Step& step, const StepLimits& limits = {}) {
    return test::error_of([&] { static_cast<void>(run_isolated<3>("it", limits, step)); });
}

TEST(RunIsolated, BringsTheResultBackHoweverLarge) {
    Pieces<4> made;
    made.points = Positions<3>::Random(3, 100'000);  // 2.4 MB, more than a pipe holds
    made.cells = Simplices<4>::Constant(4, 50'000, 7U);
    const Pieces<4> back = run_isolated<4>("it", {}, [&] { return made; });
    EXPECT_EQ(back.points, made.points);
    EXPECT_EQ(back.cells, made.cells);
    const Pieces<3> nothing = run_isolated<3>("it", {}, [] { return Pieces<3>(); });
    EXPECT_EQ(nothing.points.cols() + nothing.cells.cols(), 0);
}

TEST(RunIsolated, HandsErrorsOnAndNamesTheStepInOthers) {
    EXPECT_EQ(message_of([]() -> Pieces<3> { throw Error("no such thing"); }), "no such thing");
    EXPECT_EQ(message_of([]() -> Pieces<3> { throw std::runtime_error("two\nlines"); }),
              "it failed: two lines");
    EXPECT_EQ(message_of([]() -> Pieces<3> { throw std::bad_alloc(); }, {.memory_mib = 300}),
              "it needs more than 300 MiB of memory");
}

TEST(RunIsolated, OutlivesWhatTheStepDoesNot) {
    test::expect_contains(message_of([]() -> Pieces<3> { std::abort(); }), {"it crashed (signal"});
    test::expect_contains(message_of([]() -> Pieces<3> { throw 7; }), {"it crashed (signal"});
    EXPECT_EQ(message_of([]() -> Pieces<3> {
                  ::raise(SIGKILL);
                  return {};
              }),
              "it was killed; the machine may be out of memory");
    EXPECT_EQ(message_of([]() -> Pieces<3> { std::_Exit(0); }), "it gave no result");
}

TEST(RunIsolated, SaysWhenNoMoreFilesCanBeOpened) {
    rlimit before = {};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    const rlimit none = {0, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
    const std::string message = message_of([] { return Pieces<3>(); });
    ::setrlimit(RLIMIT_NOFILE, &before);
    EXPECT_EQ(message, "it cannot be started: no pipe");
}

TEST(RunIsolated, EndsAStepAtItsLimits) {
    volatile bool is_endless = true;
    const Step endless = [&] {
        while (is_endless) {
        }
        return Pieces<3>();
    };
    EXPECT_EQ(message_of(endless, {.seconds = 1}), "it was ended after 1 s");
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    const Step greedy = [] { return Pieces<3>{Positions<3>::Zero(3, 10'000'000), {}}; };
    EXPECT_EQ(message_of(greedy, {.memory_mib = 200}), "it needs more than 200 MiB of memory");
#endif
}

}  // namespace
}  // namespace pent::mesher
