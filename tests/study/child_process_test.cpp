#include "child_process.h"

#include "support/messages.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <sys/resource.h>

namespace pent::study {
namespace {

ChildOutcome shell(const std::string& command, const std::function<bool()>& should_stop = {}) {
    return run_child("/bin/sh", {"-c", command}, {}, should_stop);
}

TEST(RunChild, GivesExitCodeAndTheLastLineOfItsErrors) {
    const ChildOutcome outcome = shell("echo one >&2; echo two >&2; echo out; exit 3");
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_EQ(outcome.error, "two");
}

TEST(RunChild, TellsAnEndBySignal) {
    EXPECT_EQ(shell("kill -9 $$").exit_code, -1);
}

TEST(RunChild, MeasuresTimeSpentAndTimePassed) {
    const ChildOutcome asleep = shell("sleep 0.2");
    EXPECT_GE(asleep.wall_seconds, 0.2);
    EXPECT_LT(asleep.cpu_seconds, 0.15);  // a shell starts in some milliseconds
    const ChildOutcome busy = shell("i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done");
    EXPECT_GT(busy.cpu_seconds, 0.01);  // 100000 rounds of an interpreter at 10 ns
    EXPECT_GE(busy.wall_seconds, 0.5 * busy.cpu_seconds);
}

TEST(RunChild, MeasuresTheMemoryOfTheChildNotOfUs) {
    const std::vector<char> ours(std::size_t{1} << 28, 'x');  // 256 MiB in use
    const ChildOutcome outcome = shell("sleep 0.1; : " + std::string(1, ours.back()));
    EXPECT_GT(outcome.peak_bytes, 1e5);
    EXPECT_LT(outcome.peak_bytes, 1e8);
}

TEST(RunChild, WorksInAnotherFolder) {
    const pent::test::TempFolder folder;
    const ChildOutcome outcome = run_child("/bin/sh", {"-c", "pwd >&2"}, folder.path(), {});
    EXPECT_EQ(std::filesystem::canonical(outcome.error), std::filesystem::canonical(folder.path()));
}

TEST(RunChild, EndsTheChildWhenAsked) {
    const ChildOutcome outcome = shell("exec sleep 20", [] { return true; });
    EXPECT_LT(outcome.wall_seconds, 10);
    EXPECT_EQ(outcome.exit_code, -1);
}

TEST(RunChild, SaysWhenNoMoreFilesCanBeOpened) {
    rlimit before = {};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    const rlimit none = {0, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
    const std::string message = pent::test::error_of([] { static_cast<void>(shell("exit 0")); });
    ::setrlimit(RLIMIT_NOFILE, &before);
    pent::test::expect_contains(message, {"cannot make a temporary file", "make room"});
}

TEST(RunChild, SaysWhichProgramIsMissing) {
    pent::test::expect_contains(
        pent::test::error_of([] { static_cast<void>(run_child("/nowhere/pent-sim", {}, {}, {})); }),
        {"/nowhere/pent-sim"});
}

}  // namespace
}  // namespace pent::study
