#include "record/journal.h"

#include "falling_bar.h"
#include "support/messages.h"

#include <pent/crc32c.h>
#include <pent/formatted.h>
#include <pent/runs/run.h>

#include <gtest/gtest.h>

#include <fstream>

namespace pent::runs {
namespace {

namespace fs = std::filesystem;
using pent::test::TempFolder;

// That of a run of two parts.
class JournalFile : public testing::Test {
protected:
    JournalFile() {
        for (const int frames : {2, 3}) {
            static_cast<void>(run(test::falling_bar(folder_, frames),
                                  {.folder = folder_ / "run", .resume = frames == 3}));
        }
        text_ = test::bytes_of(file());
    }

    [[nodiscard]] fs::path file() const { return folder_ / "run/journal.txt"; }
    [[nodiscard]] std::optional<Journal> read_with(const std::string& text) const {
        std::ofstream(file(), std::ios::binary) << text;
        return read_journal(file());
    }

    TempFolder folder_;
    std::string text_;
};

// Written in one go, a part has what is known at its end in its first line, too.
TEST_F(JournalFile, IsReadAsItWasWritten) {
    const Journal journal = *read_with(text_);
    const std::string again = journal_text(journal);
    EXPECT_TRUE(journal_text(*read_with(again)) == again);
    EXPECT_EQ(journal.parts.size(), 2U);
    EXPECT_EQ(journal.frames.size(), 4U);
    EXPECT_EQ(journal.steps.size(), 6U);
}

TEST_F(JournalFile, IsRefusedWithTheLineWhereAnyByteHasChanged) {
    int line = 1;
    for (std::size_t at = 0; at < text_.size(); ++at) {
        if (text_[at] == '\n') {
            ++line;
            continue;
        }
        if (at % 7 != 0) {
            continue;  // enough of them
        }
        std::string changed = text_;
        changed[at] = static_cast<char>(changed[at] ^ 1);
        pent::test::expect_contains(
            pent::test::error_of([&] { static_cast<void>(read_with(changed)); }),
            {"journal.txt:" + std::to_string(line) + ": "});
    }
}

// Lines whose checksum is right.
TEST_F(JournalFile, IsRefusedWhereALineIsNotOfAJournal) {
    for (const std::string line : {"{}", "[1]", "7", "{\"end\":{},\"part\":{}}", "{\"stop\":{}}"}) {
        const std::string text = formatted("%08x ", crc32c(line.data(), line.size())) + line + "\n";
        pent::test::expect_contains(
            pent::test::error_of([&] { static_cast<void>(read_with(text_ + text)); }),
            {"journal.txt:15: is damaged", "found ", "; expected "});
    }
}

// As a kill leaves it: what is whole counts, and the part has died.
TEST_F(JournalFile, IsReadUpToItsLastWholeLineWhereverItWasCut) {
    std::size_t steps = 0;
    for (std::size_t size = 1; size <= text_.size(); size += 11) {
        const Journal journal = *read_with(text_.substr(0, size));
        EXPECT_GE(journal.steps.size(), steps);
        steps = journal.steps.size();
        const std::string whole = text_.substr(0, text_.rfind('\n', size - 1) + 1);
        const bool has_ended =
            whole.find("{\"end\"", whole.rfind("{\"part\"")) != std::string::npos;
        if (!journal.parts.empty()) {
            EXPECT_EQ(journal.parts.back().verdict,
                      has_ended ? RunVerdict::Finished : RunVerdict::Died)
                << size;
        }
    }
}

TEST_F(JournalFile, ForgetsWhatIsBehindAFrame) {
    Journal journal = *read_with(text_);
    journal.cut(1);
    EXPECT_EQ(journal.frames.size(), 2U);
    EXPECT_EQ(journal.has_checkpoint.size(), 2U);
    EXPECT_EQ(journal.steps.size(), 2U);
    EXPECT_EQ(journal.parts.front().last_frame, 1);
}

TEST_F(JournalFile, MayBeMissing) {
    EXPECT_EQ(read_journal(folder_ / "none.txt"), std::nullopt);
}

}  // namespace
}  // namespace pent::runs
