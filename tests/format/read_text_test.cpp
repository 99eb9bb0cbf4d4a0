#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/read_text.h>

#include <gtest/gtest.h>

#include <fstream>

namespace pent {
namespace {

TEST(ReadText, GivesEveryByte) {
    const test::TempFolder folder;
    std::string text(100'000, 'x');
    text[5] = '\0';
    std::ofstream(folder / "a", std::ios::binary) << text;
    EXPECT_EQ(read_text(folder / "a", "a text"), text);
}

TEST(ReadText, SaysWhatIsWrongAndWhatWasExpected) {
    const test::TempFolder folder;
    const auto message = [&](const std::string& name) {
        return test::error_of([&] { static_cast<void>(read_text(folder / name, "a scene file")); });
    };
    test::expect_contains(message("none"),
                          {"none: cannot be read: No such file", "expected a scene file"});
    test::expect_contains(message(""), {"Is a directory; expected a scene file"});
    test::expect_contains(message(std::string(300, 'n')), {"File name too long"});
}

}  // namespace
}  // namespace pent
