#include "../apps/run_program.h"
#include "scene.h"
#include "support/messages.h"

#include <pent/runs/scene_file.h>
#include <pent/study/study.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace pent::study {
namespace {

using pent::test::expect_contains;
using pent::test::interrupt_at;
using pent::test::Outcome;
using pent::test::run_program;
using pent::test::TempFolder;
using pent::test::text_of;

TEST(PentStudy, NeverWritesToWhatItReads) {
    const TempFolder folder;
    const std::string scene = test::write_bar(folder).string();
    const std::string text = text_of(scene);
    for (const std::string option : {"--write-scene ", "--json "}) {
        for (const char* file : {"bar.toml", "bar.pent"}) {
            const Outcome outcome =
                run_program("pent-study " + scene + " -o " + (folder / "study").string()
                            + " --vary dt=1/30 --error 50 " + option + (folder / file).string());
            EXPECT_EQ(outcome.exit_code, 1);
            expect_contains(outcome.err,
                            {option.substr(0, option.size() - 1) + " is the same file as the "});
            EXPECT_FALSE(std::filesystem::exists(folder / "study"));
        }
    }
    EXPECT_EQ(text_of(scene), text);
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
    const simulator::Scene written = runs::read_scene(chosen);
    EXPECT_EQ(std::filesystem::weakly_canonical(written.bodies[0].mesh),
              std::filesystem::weakly_canonical(folder / "bar.pent"));
    EXPECT_EQ(written.frames, 4);
    const auto json = nlohmann::json::parse(text_of(folder / "study.json"));
    EXPECT_EQ(json.at("verdict"), "finished");
    EXPECT_EQ(json.at("runs"), 2);
}

TEST(PentStudy, WritesItsSceneAndReportOutsideOfTheStudyAlone) {
    const TempFolder folder;
    const std::string command = "pent-study " + test::write_bar(folder).string() + " -o "
                                + (folder / "study").string() + " --vary dt=1/30";
    const Outcome once = run_program(command + " --prepare");
    ASSERT_EQ(once.exit_code, 0) << once.err;
    const std::string plan = text_of(folder / "study/plan.json");
    for (const std::string option : {"--write-scene ", "--json "}) {
        for (const char* file : {"plan.json", "scene.toml", "runs/dt-1_30.toml", "new"}) {
            const Outcome outcome =
                run_program(command + " --error 50 " + option + (folder / "study" / file).string());
            EXPECT_EQ(outcome.exit_code, 1);
            expect_contains(outcome.err, {option + "is in the study"});
        }
    }
    EXPECT_EQ(run_program("pent-study -o " + (folder / "study").string() + " --list-runs --json "
                          + (folder / "study/new").string())
                  .exit_code,
              1);
    EXPECT_EQ(text_of(folder / "study/plan.json"), plan);
    EXPECT_FALSE(std::filesystem::exists(folder / "study/new"));
}

TEST(PentStudy, SaysBeforeTheWorkThatItsSceneCannotBeWritten) {
    const TempFolder folder;
    const std::string command = "pent-study " + test::write_bar(folder).string() + " -o "
                                + (folder / "study").string()
                                + " --vary dt=1/30 --write-scene /dev/null/no/x";
    const Outcome unasked = run_program(command);
    EXPECT_EQ(unasked.exit_code, 2);
    expect_contains(unasked.err, {"--write-scene", "--error or --budget"});
    const Outcome missing = run_program(command + " --error 50");
    EXPECT_EQ(missing.exit_code, 1);
    expect_contains(missing.err, {"/dev/null/no: folder cannot be made"});
    EXPECT_FALSE(std::filesystem::exists(folder / "study"));
}

TEST(PentStudy, SaysWhySettingsDidNotFinish) {
    const TempFolder folder;
    const Outcome outcome = run_program(
        "pent-study " + test::write_bar(folder).string() + " -o " + (folder / "study").string()
        + " --vary max_iterations=1 --vary max_halvings=0 --vary dt=1/30 --repeat 1");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_contains(outcome.out, {"max_iterations=1 max_halvings=0 dt=1/30: diverged: ",
                                  "did not reach its tolerance"});
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

TEST(PentStudy, ChoosesTheMostAccurateSettingsWithinABudget) {
    const TempFolder folder;
    const std::string command = "pent-study " + test::write_bar(folder).string() + " -o "
                                + (folder / "study").string() + " --vary dt=1/30,1/240 --repeat 1";
    const Outcome rich = run_program(command + " --budget 1000");
    ASSERT_EQ(rich.exit_code, 0) << rich.err;
    expect_contains(rich.out, {"chosen     dt=1/240"});
    const Outcome poor = run_program(command + " --budget 1e-9");  // nothing is run anew
    EXPECT_EQ(poor.exit_code, 1);
    expect_contains(poor.err, {"at most 1e-09 s", "ask for less"});
}

TEST(PentStudy, GoesOnAfterCtrlC) {
    const TempFolder folder;
    const std::string scene = test::write_bar(folder).string();
    const std::string out = (folder / "study").string();
    const std::string command =
        "pent-study " + scene + " -o " + out + " --vary dt=1/240 --repeat 1 --reference-halvings ";
    // A reference down to 1/61440 s takes far longer than its folder does to appear.
    const Outcome cut = run_program(command + "8", interrupt_at(folder / "study/references"));
    EXPECT_EQ(cut.exit_code, 3);
    expect_contains(cut.out, {"stopped: run the same command again"});
    const Outcome again = run_program(command + "2");  // its levels are the first of those
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "study/frontier.png"));
}

}  // namespace
}  // namespace pent::study
