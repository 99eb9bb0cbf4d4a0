#include "common/program.h"

#include <gtest/gtest.h>

#include <array>
#include <new>
#include <stdexcept>

namespace pent::apps {
namespace {

constexpr std::array<const char*, 3> kCommand = {"pent-try", "--json", "/dev/null/folder/a.json"};

Program program() {
    return {"pent-try", "Tries things", "pent-try"};
}

// As libraries of others throw them.
TEST(Program, SaysTheErrorOfSeveralLinesInOne) {
    Program tried = program();
    testing::internal::CaptureStderr();
    EXPECT_EQ(
        tried.run(1, kCommand.data(), []() -> Verdict { throw std::runtime_error("no\nway\n\n"); }),
        1);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "pent-try: no way\n");
}

TEST(Program, SaysThatMemoryRanOut) {
    Program tried = program();
    testing::internal::CaptureStderr();
    EXPECT_EQ(tried.run(1, kCommand.data(), []() -> Verdict { throw std::bad_alloc(); }), 1);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "pent-try: out of memory\n");
}

TEST(Program, IsRefusedWhereItsReportCannotBeWritten) {
    Program tried = program();
    testing::internal::CaptureStderr();
    EXPECT_EQ(tried.run(3, kCommand.data(), [] { return Verdict::Finished; }), 1);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("/dev/null/folder"), std::string::npos);
}

// CLI11 takes it for a file of that name.
TEST(Program, DoesNotTakeAnOptionForTheValueOfAnother) {
    Program tried = program();
    const std::array<const char*, 3> command = {"pent-try", "--json", "--quiet"};
    testing::internal::CaptureStderr();
    EXPECT_EQ(tried.run(3, command.data(), [] { return Verdict::Finished; }), 2);
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "pent-try: --json: found the option --quiet after it; expected FILE (Write a"
              " machine-readable report to this file) (see pent-try --help)\n");
}

TEST(Program, AbandonedSaysSoAndThatItsReportCannotBeWritten) {
    Program tried = program();
    EXPECT_EXIT(static_cast<void>(tried.run(
                    3, kCommand.data(),
                    [&]() -> Verdict { tried.abandon(Verdict::Stopped, "stopped as asked"); })),
                testing::ExitedWithCode(3),
                "pent-try: stopped as asked\npent-try: /dev/null/folder");
}

}  // namespace
}  // namespace pent::apps
