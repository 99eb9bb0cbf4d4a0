#include "../apps/run_program.h"
#include "scene.h"
#include "support/messages.h"

#include <pent/simulator/scene_file.h>
#include <pent/study/study.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace pent::study {
namespace {

using pent::test::expect_contains;
using pent::test::Outcome;
using pent::test::run_program;
using pent::test::TempFolder;
using pent::test::text_of;

StudyOptions bar_study(const TempFolder& folder, std::vector<std::string> vary) {
    return {.scene = test::write_bar(folder),
            .folder = folder / "study",
            .vary = std::move(vary),
            .repeats = 1,
            .programs = PENT_BIN};
}

// The theory of the integrators, seen from outside: the reference is of second order, Euler of first.
TEST(RunStudy, FindsTheOrderOfTheReferenceAndErrorsThatFallWithTheStep) {
    const TempFolder folder;
    const StudyReport report =
        run_study(bar_study(folder, {"dt=1/60,1/120,1/240", "integrator=newton_euler,bdf2"}));
    EXPECT_TRUE(report.reference.is_converged);
    EXPECT_NEAR(report.reference.order, 2, 0.4);  // not yet in the limit of small steps
    ASSERT_EQ(report.results.size(), 6U);
    const auto error = [&](std::size_t i) { return report.results[i].errors.position; };
    EXPECT_NEAR(std::log2(error(2) / error(4)), 1, 0.3);  // newton_euler, 1/120 to 1/240
    EXPECT_GT(std::log2(error(3) / error(5)), 1.5);       // bdf2
    for (std::size_t i = 0; i < 6; i += 2) {
        EXPECT_GT(error(i), error(i + 1)) << i;  // bdf2 beats Euler at the same step
    }
    for (const Result& result : report.results) {
        EXPECT_EQ(result.verdict, "finished");
        EXPECT_GT(result.cost.wall_seconds, 0);
        EXPECT_GT(result.cost.peak_bytes, 1e6);
        EXPECT_GT(result.errors.iterations, 0);
        EXPECT_GT(result.errors.smallest_J, 0.5);
        EXPECT_LE(result.errors.smallest_J, 1);
        EXPECT_EQ(result.errors.angular_momentum.size(), 6U);
    }
    EXPECT_FALSE(report.frontier.empty());
    for (const char* name : {"study.csv", "study.json", "frontier.svg", "frontier.png"}) {
        EXPECT_TRUE(std::filesystem::exists(folder / "study" / name)) << name;
    }
}

TEST(RunStudy, GoesOnWhereItWasInterrupted) {
    const TempFolder folder;
    const StudyOptions options = bar_study(folder, {"dt=1/30,1/60"});
    int started = 0;
    const StudyReport stopped = run_study(
        options, {.should_stop = [&] { return started >= 4; },  // within the first combination
                  .on_run = [&](int, int, const std::string&) { ++started; }});
    EXPECT_TRUE(stopped.is_stopped);
    EXPECT_FALSE(std::filesystem::exists(folder / "study/study.csv"));
    const auto fine = folder / "study/references/steps-8/report.json";
    const auto before = std::filesystem::last_write_time(fine);
    const StudyReport report = run_study(options);
    EXPECT_FALSE(report.is_stopped);
    EXPECT_EQ(std::filesystem::last_write_time(fine), before);  // not run again
    const std::string csv = text_of(folder / "study/study.csv");
    static_cast<void>(run_study(options));
    EXPECT_EQ(text_of(folder / "study/study.csv"), csv);  // nothing was measured anew
}

TEST(RunStudy, RefusesTheFolderOfAnotherScene) {
    const TempFolder folder;
    StudyOptions options = bar_study(folder, {"dt=1/30"});
    static_cast<void>(run_study(options));
    static_cast<void>(test::write_bar(folder, "[damping]\nmass = 1\n"));
    expect_contains(pent::test::error_of([&] { static_cast<void>(run_study(options)); }),
                    {"another scene", "--force"});
    options.force = true;
    EXPECT_NO_THROW(static_cast<void>(run_study(options)));
}

TEST(RunStudy, ReportsSettingsThatDiverge) {
    const TempFolder folder;
    const StudyReport report =
        run_study(bar_study(folder, {"max_iterations=1,3000", "max_halvings=0"}));
    EXPECT_EQ(report.results[0].verdict, "diverged");
    expect_contains(report.results[0].message, {"did not reach its tolerance"});
    EXPECT_EQ(report.results[1].verdict, "finished");
    EXPECT_EQ(report.frontier, std::vector<std::size_t>{1});
}

TEST(PentStudy, ChoosesSettingsAndWritesASceneThatRuns) {
    const TempFolder folder;
    const std::string scene = test::write_bar(folder).string();
    const std::string chosen = (folder / "chosen.toml").string();
    const Outcome outcome =
        run_program("pent-study " + scene + " -o " + (folder / "study").string()
                    + " --vary dt=1/30,1/240 --repeat 1 --error 20 --write-scene " + chosen
                    + " --json " + (folder / "study.json").string());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_contains(outcome.out, {"converged, observed order", "within", "chosen", "frontier.png"});
    const simulator::Scene written = simulator::read_scene(chosen);
    EXPECT_EQ(std::filesystem::weakly_canonical(written.bodies[0].mesh),
              std::filesystem::weakly_canonical(folder / "bar.pent"));
    EXPECT_EQ(written.frames, 4);
    const auto json = nlohmann::json::parse(text_of(folder / "study.json"));
    EXPECT_EQ(json.at("verdict"), "finished");
    EXPECT_EQ(json.at("runs"), 2);
}

TEST(PentStudy, SaysInOneLineWhatItDoesNotUnderstand) {
    const TempFolder folder;
    const std::string scene = test::write_bar(folder).string();
    const Outcome outcome = run_program("pent-study " + scene + " -o " + (folder / "study").string()
                                        + " --vary presicion=float");
    EXPECT_EQ(outcome.exit_code, 1);
    pent::test::expect_one_error_line(outcome, "pent-study");
    expect_contains(outcome.err, {"presicion", "precision"});
    EXPECT_FALSE(std::filesystem::exists(folder / "study"));
}

}  // namespace
}  // namespace pent::study
