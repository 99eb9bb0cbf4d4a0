#include "common/same_file.h"

#include "run_program.h"
#include "support/messages.h"

#include <pent/error.h>

#include <gtest/gtest.h>

namespace pent::apps {
namespace {

namespace fs = std::filesystem;

void touch(const fs::path& path) {
    std::ofstream(path) << "x";
}

TEST(SameFile, IsSeenThroughOtherPathsAndLinksOfEitherKind) {
    const test::TempFolder folder;
    touch(folder / "a");
    touch(folder / "b");
    fs::create_directory(folder / "sub");
    fs::create_symlink(folder / "a", folder / "soft");
    fs::create_hard_link(folder / "a", folder / "hard");
    fs::create_directory_symlink(folder.path(), folder / "sub" / "up");
    for (const char* name : {"a", "sub/../a", "soft", "hard", "sub/up/a", "sub/up/soft"}) {
        EXPECT_TRUE(is_same_file(folder / name, folder / "a")) << name;
        EXPECT_TRUE(is_same_file(folder / "a", folder / name)) << name;
        EXPECT_FALSE(is_same_file(folder / name, folder / "b")) << name;
    }
}

TEST(SameFile, IsOneThatWouldBeMadeByBothNames) {
    const test::TempFolder folder;
    touch(folder / "a");
    fs::create_directory(folder / "sub");
    EXPECT_TRUE(is_same_file(folder / "new", folder / "sub" / ".." / "new"));
    EXPECT_FALSE(is_same_file(folder / "new", folder / "newer"));
    EXPECT_FALSE(is_same_file(folder / "new", folder / "a"));
    EXPECT_FALSE(is_same_file(std::string(5000, 'x'), folder / "a"));  // no name of a file
}

TEST(SameFile, IsNeverADevice) {
    EXPECT_FALSE(is_same_file("/dev/null", "/dev/null"));
}

TEST(RequireApart, NamesBothAndPassesOverWhatIsNotGiven) {
    const test::TempFolder folder;
    touch(folder / "a");
    fs::create_symlink(folder / "a", folder / "soft");
    const std::string a = (folder / "a").string();
    const std::string soft = (folder / "soft").string();
    const auto message = [](const std::vector<NamedFile>& inputs,
                            const std::vector<NamedFile>& outputs) {
        return test::error_of([&] { require_apart(inputs, outputs); });
    };
    EXPECT_EQ(message({{"the input", a}}, {{"-o", a}}),
              a + ": -o is the same file as the input; give it another name");
    EXPECT_EQ(message({{"the input", a}}, {{"-o", soft}}),
              soft + ": -o is the same file as the input, " + a + "; give it another name");
    EXPECT_EQ(message({{"the run", folder.path()}}, {{"-o", folder / ""}}),
              (folder / "").string() + ": -o is the same folder as the run, "
                  + folder.path().string() + "; give it another name");
    EXPECT_EQ(message({}, {{"-o", "new"}, {"--json", "./new"}}),
              "./new: --json is the same file as -o, new; give it another name");
    EXPECT_NO_THROW(
        require_apart({{"the input", a}, {"--profile", ""}}, {{"-o", "new"}, {"--json", ""}}));
}

TEST(RequireApart, KeepsOutOfFoldersWithTheirContentAlone) {
    const test::TempFolder folder;
    fs::create_directory(folder / "frames");
    fs::create_directory_symlink(folder / "frames", folder / "link");
    const auto check = [&](const std::string& name, bool has_content) {
        require_apart({{"frames", folder / "frames", has_content}}, {{"-o", folder / name}});
    };
    for (const char* name : {"frames/new", "frames/new/newer", "link/new", "frames/../link/a"}) {
        EXPECT_THROW(check(name, true), Error) << name;
        EXPECT_NO_THROW(check(name, false)) << name;
    }
    for (const char* name : {"frames", "frames/", "link"}) {
        EXPECT_THROW(check(name, true), Error) << name;
        EXPECT_THROW(check(name, false), Error) << name;
    }
    for (const char* name : {"frames.mp4", "frames2/new", "new", "link/../new"}) {
        EXPECT_NO_THROW(check(name, true)) << name;
    }
}

}  // namespace
}  // namespace pent::apps
