#include "common/usage_error.h"

#include "common/values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace pent::apps {
namespace {

// What is said of a line of a program with options of every kind; "" if it is taken.
std::string said(std::vector<std::string> words) {
    CLI::App cli("Tries things");
    std::string input;
    std::string output;
    std::vector<std::string> places;
    int layers = 0;
    double scale = 1;
    std::vector<double> shift;
    std::string repair;
    bool is_quiet = false;
    cli.add_option("input", input, "Run folder or a mesh")->required()->type_name("RUN");
    cli.add_option("-o,--output", output, "Where it goes")->required()->type_name("OUT");
    cli.add_option("--w", places, "Slice at w = C, m; several with commas; default: the middle")
        ->type_name("C")
        ->allow_extra_args(false);
    cli.add_option("--layers", layers, "Layers of cells")->check(whole_number(1, 64));
    CLI::Option* size =
        cli.add_option("--scale", scale, "Multiply by this")->check(positive_number());
    cli.add_option("--shift", shift, "Move by x,y,z or x,y,z,w (m)")
        ->delimiter(',')
        ->expected(3, 4)
        ->type_name("X,Y,Z[,W]");
    cli.add_option("--repair", repair, "How far to mend")
        ->transform(one_of({"auto", "none"}))
        ->option_text("auto|none [auto]")
        ->needs(size);
    cli.add_flag("--quiet", is_quiet, "Say nothing")->excludes(size);
    std::reverse(words.begin(), words.end());
    try {
        cli.parse(words);
    } catch (const CLI::ParseError& error) {
        return usage_error(cli, error);
    }
    return swallowed_option(cli);
}

TEST(UsageError, IsNoneWhereAllIsRight) {
    EXPECT_EQ(said({"a", "-o", "b", "--w", "0", "--shift", "1,2,3", "--layers=3"}), "");
    EXPECT_EQ(said({"a", "-o", "b", "--w", "-0.1,0.1", "--w", "-1"}), "");
}

TEST(UsageError, SaysInWordsWhatBelongsBehindAnOption) {
    EXPECT_EQ(said({"a", "-o", "b", "--w"}),
              "--w: found no value; expected C (Slice at w = C, m; several with commas)");
    EXPECT_EQ(said({"a", "--output"}), "--output: found no value; expected OUT (Where it goes)");
    EXPECT_EQ(said({"a", "-o", "b", "--layers"}),
              "--layers: found no value; expected a whole number from 1 to 64 (Layers of cells)");
    EXPECT_EQ(said({"a", "-o", "b", "--scale"}),
              "--scale: found no value; expected a number above 0 (Multiply by this)");
    EXPECT_EQ(said({"a", "-o", "b", "--repair"}),
              "--repair: found no value; expected auto|none (How far to mend)");
}

// The parser takes it for the value; what is missing then is another one, or nothing is.
TEST(UsageError, NamesAnOptionThatStandsWhereAValueBelongs) {
    EXPECT_EQ(said({"a", "--w", "-o", "b"}),
              "--w: found the option -o after it; expected C (Slice at w = C, m; several with"
              " commas)");
    EXPECT_EQ(said({"a", "--output", "--quiet"}),
              "--output: found the option --quiet after it; expected OUT (Where it goes)");
    EXPECT_EQ(said({"a", "-o", "./--quiet"}), "");  // a file or folder may be called so
    EXPECT_EQ(said({"-o", "b", "--", "--quiet"}), "");
}

TEST(UsageError, CountsValues) {
    EXPECT_EQ(said({"a", "-o", "b", "--shift", "1,2"}),
              "--shift: found 2 values; expected X,Y,Z[,W] (Move by x,y,z or x,y,z,w (m))");
    EXPECT_EQ(said({"a", "-o", "b", "--shift", "1,2,3,4,5"}),
              "--shift: found 5 values; expected X,Y,Z[,W] (Move by x,y,z or x,y,z,w (m))");
    EXPECT_EQ(said({"a", "-o", "b", "-o", "c"}),
              "--output: found 2 values; expected OUT (Where it goes)");
    EXPECT_EQ(said({"a", "-o", "b", "--quiet=loud"}),
              "--quiet: found \"loud\"; expected nothing after it");
}

TEST(UsageError, NamesWhatIsMissing) {
    EXPECT_EQ(said({"-o", "b"}), "input is missing; expected RUN (Run folder or a mesh)");
    EXPECT_EQ(said({"a"}), "--output is missing; expected OUT (Where it goes)");
}

TEST(UsageError, NamesOptionsThatGoTogetherAndThatDoNot) {
    EXPECT_EQ(said({"a", "-o", "b", "--repair", "auto"}),
              "--repair requires --scale; give both or none");
    EXPECT_EQ(said({"a", "-o", "b", "--quiet", "--scale", "2"}),
              "--scale excludes --quiet; give one of them");
}

// As of a list with blanks.
TEST(UsageError, NamesAWordThatBelongsToNoOption) {
    EXPECT_EQ(said({"a", "-o", "b", "--w", "-0.1,", "0"}),
              "found \"0\" where nothing more belongs; lists have commas and no blanks, as in"
              " 1,2,3");
}

TEST(UsageError, KeepsWhatValuesAndTypesSay) {
    EXPECT_EQ(said({"a", "-o", "b", "--layers", "65"}),
              "--layers: found \"65\"; expected a whole number from 1 to 64");
    EXPECT_EQ(said({"a", "-o", "b", "--layer", "6"}),
              "unknown option --layer; did you mean --layers?");
}

TEST(UsageError, NamesAGroupOfWhichOneIsWanted) {
    const auto of_group = [](std::vector<std::string> words) -> std::string {
        CLI::App cli("Tries things");
        std::string file;
        int ball = 0;
        CLI::Option_group* input = cli.add_option_group("Input", "One of these");
        input->add_option("input", file, "A file");
        input->add_option("--ball", ball, "A ball");
        input->require_option(1);
        std::reverse(words.begin(), words.end());
        try {
            cli.parse(words);
        } catch (const CLI::ParseError& error) {
            return usage_error(cli, error);
        }
        return "";
    };
    EXPECT_EQ(of_group({}), "found none of input, --ball; expected one of them");
    EXPECT_EQ(of_group({"a", "--ball", "2"}),
              "found several of input, --ball; expected one of them");
}

}  // namespace
}  // namespace pent::apps
