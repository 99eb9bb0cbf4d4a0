#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/child_process.h>
#include <pent/output_file.h>

#include <gtest/gtest.h>

#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <thread>
#include <unistd.h>

namespace pent {
namespace {

namespace fs = std::filesystem;

std::string text_of(std::FILE* file) {
    std::rewind(file);
    std::string text(4096, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), file));
    return text;
}

ChildEnd run(const std::string& script, const ChildOptions& options = {}) {
    return ChildProcess("/bin/sh", {"-c", script}, options).wait();
}

TEST(ChildProcess, EndsWithItsCodeOrItsSignal) {
    for (const int code : {0, 1, 255}) {
        const ChildEnd end = run("exit " + std::to_string(code));
        EXPECT_EQ(end.exit_code, code);
        EXPECT_EQ(end.signal, 0);
    }
    EXPECT_EQ(run("kill -9 $$").signal, SIGKILL);
}

TEST(ChildProcess, ReadsAndWritesTheFilesThatItGets) {
    const File input = temporary_file();
    const File output = temporary_file();
    const File errors = temporary_file();
    std::fputs("of the input", input.get());
    std::rewind(input.get());
    const ChildOptions options{.input = ::fileno(input.get()),
                               .output = ::fileno(output.get()),
                               .errors = ::fileno(errors.get())};
    EXPECT_EQ(run("cat; echo to the errors >&2", options).exit_code, 0);
    EXPECT_EQ(text_of(output.get()), "of the input");
    EXPECT_EQ(text_of(errors.get()), "to the errors\n");
}

TEST(ChildProcess, HasAnEmptyInputAndDropsItsOutputUnlessToldOtherwise) {
    EXPECT_EQ(run("read line && exit 1; echo nobody reads this").exit_code, 0);
}

TEST(ChildProcess, WorksInTheFolderThatItIsTold) {
    const test::TempFolder folder;
    const File output = temporary_file();
    EXPECT_EQ(run("pwd", {.output = ::fileno(output.get()), .folder = folder / "."}).exit_code, 0);
    EXPECT_EQ(fs::canonical(text_of(output.get()).substr(0, text_of(output.get()).size() - 1)),
              fs::canonical(folder / "."));
}

TEST(ChildProcess, IsFoundInThePathByItsName) {
    EXPECT_EQ(ChildProcess("true", {}).wait().exit_code, 0);
    EXPECT_NE(ChildProcess("false", {}).wait().exit_code, 0);
}

TEST(ChildProcess, ThatCannotBeStartedIsNamed) {
    for (const char* name : {"no-such-program-at-all", "/no/such/program", "/"}) {
        test::expect_contains(test::error_of([&] { ChildProcess child(name, {}); }),
                              {name, "cannot be started"});
    }
}

TEST(ChildProcess, IsAskedWhetherItHasEndedAndToldToEnd) {
    ChildProcess child("/bin/sh", {"-c", "trap 'exit 7' TERM; while :; do sleep 0.01; done"});
    EXPECT_EQ(child.poll(), std::nullopt);
    std::optional<ChildEnd> end;
    while (!(end = child.poll())) {
        child.stop();  // more than once: the trap may not be set yet
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_TRUE(end->exit_code == 7 || end->signal == SIGTERM);
    EXPECT_EQ(child.wait().exit_code, end->exit_code);  // may be asked again
    child.stop();                                       // of no one
}

TEST(ChildProcess, SaysHowLongTheProcessorWorked) {
    EXPECT_LT(run("sleep 0.2").cpu_seconds, 0.1);
    EXPECT_GT(run("i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done").cpu_seconds, 0.01);
}

TEST(ChildProcess, IsWaitedForByWhoeverLetsGoOfIt) {
    const test::TempFolder folder;
    {
        const ChildProcess child("/bin/sh", {"-c", "sleep 0.1; touch done"},
                                 {.folder = folder / "."});
    }
    EXPECT_TRUE(fs::exists(folder / "done"));
}

TEST(ChildProcess, RunsOnWhenItIsDetached) {
    // It ends well only if it is told to go on, which can be done only once it was let go of.
    const test::TempFolder folder;
    const std::string wait_for_go =
        "i=0; while [ ! -e go ]; do i=$((i+1)); [ $i -lt 200 ] || exit 1; sleep 0.05; done; ";
    ChildProcess("/bin/sh", {"-c", wait_for_go + "touch done"}, {.folder = folder / "."}).detach();
    EXPECT_FALSE(fs::exists(folder / "done"));
    write_text(folder / "go", "");
    for (int i = 0; i < 1000 && !fs::exists(folder / "done"); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_TRUE(fs::exists(folder / "done"));
}

TEST(ChildProcess, MayHaveAGroupOfItsOwn) {
    const auto group = [](bool is_own) {
        ChildProcess child("/bin/sh", {"-c", "sleep 0.1"}, {.has_own_group = is_own});
        return ::getpgid(child.id()) == child.id();
    };
    EXPECT_TRUE(group(true));
    EXPECT_FALSE(group(false));
}

}  // namespace
}  // namespace pent
