#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/file_lock.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

namespace pent {
namespace {

std::string error_of_lock(const std::filesystem::path& path, const FileLockOptions& options = {}) {
    return test::error_of([&] { const FileLock lock(path, "is busy", options); });
}

TEST(FileLock, IsOfOneProgramOrOfManyThatShareIt) {
    const test::TempFolder folder;
    std::ofstream(folder / "file") << "text";
    for (const std::filesystem::path& path : {folder / "file", folder.path()}) {
        auto alone = std::make_unique<FileLock>(path, "");
        EXPECT_EQ(error_of_lock(path), path.string() + ": is busy");
        EXPECT_EQ(error_of_lock(path, {.is_shared = true}), path.string() + ": is busy");
        alone.reset();
        const FileLock first(path, "", {.is_shared = true});
        const FileLock second(path, "", {.is_shared = true});
        EXPECT_EQ(error_of_lock(path), path.string() + ": is busy");
    }
    EXPECT_NO_THROW(FileLock(folder / "none", ""));  // nothing to lock
}

TEST(FileLock, IsKeptByProgramsThatWereStartedMeanwhileOnlyIfItIsToBe) {
    const test::TempFolder folder;
    std::ofstream(folder / "file") << "text";
    for (const bool is_inherited : {false, true}) {
        FILE* child = nullptr;
        {
            const FileLock lock(folder / "file", "", {.is_inherited = is_inherited});
            child = popen("cat", "w");  // lives until its input ends
            ASSERT_NE(child, nullptr);
        }
        if (is_inherited) {
            EXPECT_EQ(error_of_lock(folder / "file"), (folder / "file").string() + ": is busy");
        } else {
            EXPECT_NO_THROW(FileLock(folder / "file", ""));
        }
        pclose(child);
        EXPECT_NO_THROW(FileLock(folder / "file", ""));
    }
}

}  // namespace
}  // namespace pent
