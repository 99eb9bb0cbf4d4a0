#include "run_program.h"
#include "support/messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

// What every program does alike.

namespace pent {
namespace {

using test::expect_contains;
using test::expect_one_error_line;
using test::Outcome;
using test::run_program;

std::vector<std::string> programs() {
    std::vector<std::string> names;
    std::istringstream list(PENT_PROGRAMS);
    for (std::string name; std::getline(list, name, ',');) {
        names.push_back(name);
    }
    return names;
}

class EveryProgram : public testing::TestWithParam<std::string> {};

TEST_P(EveryProgram, ShowsHelpWithAnExampleThatItParses) {
    const Outcome outcome = run_program(GetParam() + " --help");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.err, "");
    expect_contains(outcome.out, {"Example:\n  " + GetParam() + " ", "--version", "--threads",
                                  "--quiet", "--json"});
}

TEST_P(EveryProgram, SaysThatWhatItPrintsDoesNotArrive) {
    const test::TempFolder folder;
    const std::string err = (folder / "err").string();
    const std::string line = PENT_BIN "/" + GetParam() + " --help >/dev/full 2>" + err;
    EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 1);  // NOLINT(cert-env33-c)
    EXPECT_EQ(test::text_of(err), GetParam() + ": standard output: cannot be written;"
                                  " free some space or print elsewhere\n");
}

TEST_P(EveryProgram, SaysItsVersion) {
    const Outcome outcome = run_program(GetParam() + " --version");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.out.rfind(GetParam() + " ", 0), 0U) << outcome.out;
    EXPECT_TRUE(std::any_of(outcome.out.begin(), outcome.out.end(), [](char c) {
        return c >= '0' && c <= '9';
    })) << outcome.out;
}

TEST_P(EveryProgram, RefusesAnUnknownOptionAndNamesTheNearest) {
    const Outcome outcome = run_program(GetParam() + " --thraeds 2 --quite");
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.out, "");
    expect_one_error_line(outcome, GetParam());
    expect_contains(outcome.err, {"unknown option --thraeds", "did you mean --threads?",
                                  GetParam() + " --help"});
}

TEST_P(EveryProgram, RefusesThreadsOutOfRange) {
    for (const std::string value : {"0", "-1", "many"}) {
        const Outcome outcome = run_program(GetParam() + " in --threads " + value);
        EXPECT_EQ(outcome.exit_code, 2);
        expect_one_error_line(outcome, GetParam());
        expect_contains(outcome.err, {"--threads"});
    }
}

Outcome run_on_missing(const std::string& program,
                       const test::TempFolder& folder,
                       const std::string& name,
                       const std::string& options = "") {
    const std::string name_of_output =
        program == "pent-mesh" || program == "pent-convert" ? "out.pent" : "out.png";
    const std::string option = program == "pent-view" ? " --export " : " -o ";
    const std::string output =
        program == "pent-check" ? "" : option + (folder / name_of_output).string();
    return run_program(program + " " + (folder / name).string() + output + options);
}

TEST_P(EveryProgram, NamesAMissingInput) {
    const test::TempFolder folder;
    const Outcome outcome = run_on_missing(GetParam(), folder, "missing.pent");
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, GetParam());
    expect_contains(outcome.err, {"missing.pent"});
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST_P(EveryProgram, WritesAReportOfAFileWhoseNameIsNotUtf8) {
    const test::TempFolder folder;
    const std::string report = (folder / "report.json").string();
    const Outcome outcome =
        run_on_missing(GetParam(), folder, "missing\xff.pent", " --json " + report);
    EXPECT_EQ(outcome.exit_code, 1);
    expect_one_error_line(outcome, GetParam());
    const auto json = nlohmann::json::parse(test::text_of(report));  // throws unless all is UTF-8
    EXPECT_NE(json.at("error").get<std::string>().find("missing\xef\xbf\xbd.pent"),
              std::string::npos);
}

std::string test_name(const testing::TestParamInfo<std::string>& program) {
    std::string name = program.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Programs, EveryProgram, testing::ValuesIn(programs()), test_name);

}  // namespace
}  // namespace pent
