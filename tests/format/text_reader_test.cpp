#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/text_reader.h>

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace pent {
namespace {

TextReader reader_of(const test::TempFolder& folder, const std::string& text) {
    std::ofstream(folder / "a.txt", std::ios::binary) << text;
    return TextReader(folder / "a.txt");
}

TEST(TextReader, JoinsALineThatEndsInABackslashWithTheNextOne) {
    const test::TempFolder folder;
    TextReader text = reader_of(folder, "v 1 \\\n2 \\ \n\n \\ 3 \\\n");
    ASSERT_TRUE(text.next_line());
    for (const char* expected : {"v", "1", "2", "\\", "3", "", ""}) {
        EXPECT_EQ(text.word(), expected);
    }
}

// One that called itself for each of them would run out of stack.
TEST(TextReader, JoinsAnyNumberOfLines) {
    const test::TempFolder folder;
    std::string lines;
    for (int line = 0; line < 1000000; ++line) {
        lines += "\\\n";
    }
    TextReader text = reader_of(folder, lines + "end\n");
    ASSERT_TRUE(text.next_line());
    EXPECT_EQ(text.word(), "end");
    test::expect_contains(test::error_of([&] { text.fail("it ends"); }),
                          {"a.txt: line 1000001: it ends"});
}

}  // namespace
}  // namespace pent
