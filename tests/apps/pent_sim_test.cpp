#include "run_program.h"
#include "support/kuhn_box.h"
#include "support/messages.h"

#include <pent/pent_file.h>

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

// What pent-sim says of a run that ends, but not as one would wish.

namespace pent {
namespace {

using test::expect_contains;
using test::Outcome;

// Two cells in a row, both ends held, the right one pushed by `meters` along x within ten steps.
nlohmann::json push_through(double meters, const std::string& solver, Outcome& outcome) {
    const test::TempFolder folder;
    write_mesh(folder / "bar.pent", test::kuhn_box<3>({2, 1, 1}, {1, 0.5, 0.5}));
    std::ofstream(folder / "bar.toml") << R"([scene]
dimension = 3
frames = 10
frames_per_second = 10

[[body]]
name = "bar"
mesh = "bar.pent"

[[constraint]]
body = "bar"
select = { half_space = { normal = [1, 0, 0], offset = 1e-6 } }

[[constraint]]
body = "bar"
select = { half_space = { normal = [-1, 0, 0], offset = -0.999999 } }
motion = { translate = [)" << meters << R"(, 0, 0] }

[solver]
integrator = "newton_euler"
)" << solver;
    outcome =
        test::run_program("pent-sim " + (folder / "bar.toml").string() + " -o "
                          + (folder / "run").string() + " --json " + (folder / "all").string());
    return nlohmann::json::parse(test::text_of(folder / "all"));
}

TEST(PentSim, SaysThatElementsAreInsideOut) {
    Outcome outcome;
    const nlohmann::json report = push_through(-2, "", outcome);  // the ends have changed sides
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const int inverted = report.at("inverted");
    EXPECT_GT(inverted, 0);  // the two ends alone have the signed volume of a bar inside out
    EXPECT_GT(report.at("inverted_steps"), 2);
    expect_contains(outcome.out,
                    {std::to_string(inverted) + " of 12 elements are inside out at the end",
                     "finished with inverted elements"});
}

TEST(PentSim, SaysWhyStepsWereCut) {
    Outcome outcome;
    const nlohmann::json report =
        push_through(-2, "max_iterations = 2\npreconditioner = \"block-jacobi\"\n", outcome);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const int refused = report.at("refused");
    EXPECT_GT(refused, 0);
    expect_contains(outcome.out, {std::to_string(refused) + " attempts at steps were cut in two",
                                  "because the linear solver did not reach its tolerance"});
}

TEST(PentSim, SaysNothingOfElementsThatAreNot) {
    Outcome outcome;
    const nlohmann::json report = push_through(0.1, "", outcome);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(report.at("inverted"), 0);
    EXPECT_EQ(report.at("refused"), 0);
    EXPECT_EQ(outcome.out.find("inside out"), std::string::npos);
    EXPECT_EQ(outcome.out.find("inverted"), std::string::npos);
    EXPECT_EQ(outcome.out.find("cut"), std::string::npos);
}

}  // namespace
}  // namespace pent
