#include "support/kuhn_box.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/output_file.h>
#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

namespace pent {
namespace {

using test::error_of;
using test::expect_contains;

std::string text_of(const std::filesystem::path& path) {
    std::string text;
    std::getline(std::ifstream(path), text, '\0');
    return text;
}

TEST(OutputFile, AppearsOnlyWhenItIsWhole) {
    const test::TempFolder folder;
    {
        OutputFile file(folder / "a.txt");
        file.write("half");
        EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
        file.write(" and half");
        file.commit();
    }
    EXPECT_EQ(text_of(folder / "a.txt"), "half and half");
}

TEST(OutputFile, LeavesTheOldFileAndNothingElseWhenGivenUp) {
    const test::TempFolder folder;
    write_text(folder / "a.txt", "old");
    {
        OutputFile file(folder / "a.txt");
        file.write("new");
    }
    EXPECT_EQ(text_of(folder / "a.txt"), "old");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(OutputFile, KeepsALinkAndWritesWhatItLeadsTo) {
    const test::TempFolder folder;
    make_folder(folder / "far");
    write_text(folder / "far/a.txt", "old");
    std::filesystem::create_symlink("far/a.txt", folder / "link");
    write_text(folder / "link", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(text_of(folder / "far/a.txt"), "new");
    std::filesystem::remove(folder / "far/a.txt");
    write_text(folder / "link", "newer");  // leads nowhere: a file takes its place
    EXPECT_EQ(text_of(folder / "link"), "newer");
}

TEST(OutputFile, NeverTakesThePlaceOfADevice) {
    const test::TempFolder folder;
    std::filesystem::create_symlink("/dev/null", folder / "null");
    write_text(folder / "null", "nothing");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "null"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    std::filesystem::create_symlink("/dev/full", folder / "full");
    expect_contains(error_of([&] { write_text(folder / "full", "x"); }),
                    {"full: cannot be written", "No space left", "free some space"});
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(OutputFile, IsWhatTheReaderOfAPipeGets) {
    const test::TempFolder folder;
    const std::filesystem::path pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::thread writer([&] { write_text(pipe, "through"); });
    EXPECT_EQ(text_of(pipe), "through");
    writer.join();
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(OutputFile, SaysWhatToDoWhenItsFolderIsMissing) {
    const test::TempFolder folder;
    expect_contains(error_of([&] { write_text(folder / "no/a.txt", "x"); }),
                    {"no/a.txt", "No such file or directory", "make its folder"});
}

TEST(OutputFile, RefusesAFolder) {
    const test::TempFolder folder;
    expect_contains(error_of([&] { write_text(folder.path(), "x"); }), {"Is a directory"});
}

// A full disk, as the kernel reports one at a limit that a test can set.
TEST(OutputFile, LeavesNothingBehindWhenSpaceRunsOut) {
    const test::TempFolder folder;
    rlimit before = {};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small = {1000, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string message = error_of([&] {
        write_mesh(folder / "a.pent", test::kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1}));
    });
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    expect_contains(message, {"a.pent", "cannot be written", "File too large"});
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(OutputFile, SaysWhoseFolderItIs) {
    // Nobody makes files there, whatever their rights.
    if (!std::filesystem::is_directory("/sys/kernel")) {
        GTEST_SKIP() << "no /sys";
    }
    expect_contains(error_of([] { write_text("/sys/kernel/a.txt", "x"); }),
                    {"/sys/kernel/a.txt: cannot be written", "a folder that you may write to"});
}

TEST(OutputFile, LeavesAFolderThatTookItsNameMeanwhile) {
    const test::TempFolder folder;
    {
        OutputFile file(folder / "a.txt");
        file.write("x");
        make_folder(folder / "a.txt");
        expect_contains(error_of([&] { file.commit(); }), {"a.txt", "Is a directory"});
    }
    EXPECT_TRUE(std::filesystem::is_directory(folder / "a.txt"));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(MakeFolder, MakesParentsAndNamesWhatStandsInTheWay) {
    const test::TempFolder folder;
    make_folder(folder / "a/b/c");
    EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b/c"));
    make_folder(folder / "a/b/c");
    write_text(folder / "file", "x");
    expect_contains(error_of([&] { make_folder(folder / "file/sub"); }), {"file/sub", "folder"});
}

}  // namespace
}  // namespace pent
