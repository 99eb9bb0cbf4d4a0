#include "run_program.h"
#include "support/messages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
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

// "--version" of a program, which says PENT_VERSION, what it was built from, and what it has.
void expect_build_info(const std::string& program) {
    const Outcome outcome = run_program(program + " --version");
    EXPECT_EQ(outcome.exit_code, 0);
    const std::regex said(program
                          + " " PENT_VERSION
                            "\n"
                            "commit: ([0-9a-f]{12,}\\+?|unknown)\n"
                            "compiler: [^\n]+\n"
                            "features: [^\n]*threads (tbb|serial|plain), kernels scalar[^\n]*\n");
    EXPECT_TRUE(std::regex_match(outcome.out, said)) << outcome.out;
}

TEST_P(EveryProgram, SaysItsVersionCommitAndFeatures) {
    expect_build_info(GetParam());
}

#ifdef PENT_HAS_MESHER
TEST(Tetgen, SaysItsVersionCommitAndFeatures) {
    expect_build_info("pent-tetgen");
}
#endif

// What is written before each build of a source.
std::string written_commit(const std::filesystem::path& source) {
    const test::TempFolder folder;
    const std::string header = (folder / "commit.h").string();
    const std::string line = "cmake -DSOURCE=" + source.string() + " -DHEADER=" + header
                             + " -P " PENT_SOURCE "/cmake/build_info/write_commit.cmake";
    EXPECT_EQ(std::system(line.c_str()), 0);  // NOLINT(cert-env33-c)
    return test::text_of(header);
}

TEST(BuildInfo, NamesTheCommitOfACheckoutAndThatItWasChanged) {
    const test::TempFolder folder;
    const std::string source = folder.path().string();
    const std::string git = "git -C " + source + " -c user.name=a -c user.email=a@b ";
    std::ofstream(folder / "a") << "1";
    const std::string commit = (folder / "commit").string();
    const std::string lines = git + "init -q && " + git + "add a && " + git + "commit -qm a && "
                              + git + "rev-parse --short=12 HEAD >" + commit;
    ASSERT_EQ(std::system(lines.c_str()), 0);  // NOLINT(cert-env33-c)
    std::string expected = test::text_of(commit);
    expected.pop_back();
    EXPECT_EQ(written_commit(source), "#define PENT_COMMIT \"" + expected + "\"\n");
    std::ofstream(folder / "a") << "2";
    EXPECT_EQ(written_commit(source), "#define PENT_COMMIT \"" + expected + "+\"\n");
}

TEST(BuildInfo, IsUnknownWhereThereIsNoCheckout) {
    const test::TempFolder folder;
    EXPECT_EQ(written_commit(folder.path()), "#define PENT_COMMIT \"unknown\"\n");
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
    const std::string option = program == "pent-view"    ? " --export "
                               : program == "pent-study" ? " --vary dt=0.1 -o "
                                                         : " -o ";
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
