#include "common/values.h"

#include "common/program.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pent::apps {
namespace {

// What is said of a value; "" if it is taken.
std::string said(const CLI::Validator& validator, std::string value) {
    return validator(value);
}

TEST(Values, AreWholeNumbersWithinTheirBounds) {
    const CLI::Validator layers = whole_number(1, 64);
    for (const char* taken : {"1", "7", "64"}) {
        EXPECT_EQ(said(layers, taken), "");
    }
    for (const std::string refused :
         {"0", "65", "-1", "2.5", "1e1", "two", "", "4G", "nan", "99999999999999999999"}) {
        EXPECT_EQ(said(layers, refused),
                  "found \"" + refused + "\"; expected a whole number from 1 to 64");
    }
}

TEST(Values, AreNumbersWithinTheirBounds) {
    const CLI::Validator distance = number(1e-4, 1);
    for (const char* taken : {"0.0001", "1e-4", "1", "0.5"}) {
        EXPECT_EQ(said(distance, taken), "");
    }
    for (const std::string refused : {"0", "1.0001", "-1", "3%", "0,5", "", "nan", "inf"}) {
        EXPECT_EQ(said(distance, refused),
                  "found \"" + refused + "\"; expected a number from 0.0001 to 1");
    }
}

// What --help shows, too.
TEST(Values, HaveBoundsAsOneReadsThem) {
    const CLI::Validator memory = number(0.1, 1e9);
    EXPECT_EQ(said(memory, "4G"), "found \"4G\"; expected a number from 0.1 to 1000000000");
    EXPECT_EQ(memory.get_description(), "from 0.1 to 1000000000");
    EXPECT_EQ(whole_number(-1, std::int64_t{1} << 31).get_description(), "from -1 to 2147483648");
}

TEST(Values, ArePositiveAndFinite) {
    for (const char* taken : {"1e-300", "5", "1e300"}) {
        EXPECT_EQ(said(positive_number(), taken), "");
        EXPECT_EQ(said(nonnegative_number(), taken), "");
    }
    EXPECT_EQ(said(nonnegative_number(), "0"), "");
    EXPECT_EQ(said(positive_number(), "0"), "found \"0\"; expected a number above 0");
    for (const std::string refused : {"-1", "nan", "inf", "-inf", "1min", ""}) {
        EXPECT_EQ(said(positive_number(), refused),
                  "found \"" + refused + "\"; expected a number above 0");
        EXPECT_EQ(said(nonnegative_number(), refused),
                  "found \"" + refused + "\"; expected a number of at least 0");
    }
}

TEST(Values, AreOneOfTheWordsInAnyLetters) {
    const CLI::Validator kind = one_of({"ply", "obj", "vtu"});
    for (std::string taken : {"obj", "OBJ", "Obj"}) {
        EXPECT_EQ(kind(taken), "");
        EXPECT_EQ(taken, "obj");
    }
    for (const std::string refused : {"stl", "0", "1", "", "ob"}) {
        EXPECT_EQ(said(kind, refused), "found \"" + refused + "\"; expected ply, obj or vtu");
    }
}

// What a program with options of every kind, some within a group, says of its command line.
std::string said_of(const std::vector<const char*>& words) {
    Program program("pent-try", "Tries things", "pent-try");
    int layers = 0;
    std::vector<int> box;
    bool is_round = false;
    program.options().add_option("--layers", layers)->check(whole_number(1, 64));
    program.options().add_flag("--round", is_round);
    CLI::Option_group* group = program.options().add_option_group("Input");
    group->add_option("--box", box)->delimiter(',')->type_name("X,Y");
    std::vector<const char*> line = {"pent-try"};
    line.insert(line.end(), words.begin(), words.end());
    testing::internal::CaptureStderr();
    EXPECT_EQ(
        program.run(static_cast<int>(line.size()), line.data(), [] { return Verdict::Finished; }),
        2);
    return testing::internal::GetCapturedStderr();
}

TEST(Values, AreToldByTheirOptionsInGroupsToo) {
    const std::string end = " (see pent-try --help)\n";
    EXPECT_EQ(said_of({"--layers", "2.5"}),
              "pent-try: --layers: found \"2.5\"; expected a whole number from 1 to 64" + end);
    EXPECT_EQ(said_of({"--box", "2,a"}), "pent-try: --box: found \"2,a\"; expected X,Y" + end);
    EXPECT_EQ(said_of({"--bux", "2"}), "pent-try: unknown option --bux; did you mean --box?" + end);
    EXPECT_EQ(said_of({"--round=maybe"}),
              "pent-try: --round: found \"maybe\"; expected nothing after it" + end);
}

}  // namespace
}  // namespace pent::apps
