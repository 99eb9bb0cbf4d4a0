#include "../apps/run_program.h"
#include "scene.h"
#include "support/messages.h"

#include <pent/file_lock.h>
#include <pent/output_folder.h>
#include <pent/study/units.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace pent::study {
namespace {

using pent::test::error_of;
using pent::test::expect_contains;
using pent::test::Outcome;
using pent::test::run_program;
using pent::test::TempFolder;
using pent::test::text_of;

// Units 1 to 3 are the reference, 4 and 5 combinations.
StudyOptions two_steps(const TempFolder& folder, const std::string& name = "study") {
    return {.scene = test::write_bar(folder),
            .folder = folder / name,
            .vary = {"dt=1/30,1/60"},
            .repeats = 2,
            .programs = PENT_BIN};
}

std::string run_error(const StudyOptions& options, int number) {
    return error_of([&] { static_cast<void>(run_unit(options.folder, number, PENT_BIN)); });
}

std::vector<bool> done(const StudyOptions& options) {
    std::vector<bool> result;
    for (const UnitState& unit : state_of_study(options.folder).units) {
        result.push_back(unit.is_done);
    }
    return result;
}

// Everything that a study found but the times and what follows from them.
nlohmann::json findings(const StudyOptions& options) {
    nlohmann::json json = nlohmann::json::parse(text_of(options.folder / "study.json"));
    for (const char* key : {"frontier", "sentences"}) {
        json.erase(key);
    }
    json.at("reference").erase("cost");
    for (nlohmann::json& result : json.at("results")) {
        result.erase("cost");
    }
    return json;
}

TEST(Units, AreTheStudyInOneGoInAnyOrderAndRepeated) {
    const TempFolder folder;
    const StudyOptions whole = two_steps(folder, "whole");
    static_cast<void>(run_study(whole));
    const StudyOptions parts = two_steps(folder, "parts");
    const std::optional<StudyState> prepared = prepare_study(parts);
    ASSERT_TRUE(prepared);
    ASSERT_EQ(prepared->units.size(), 5U);
    EXPECT_EQ(prepared->units[2].kind, UnitKind::Reference);
    EXPECT_EQ(prepared->units[4].name, "runs/dt-1_60");
    for (const int unit : {5, 3, 5, 1, 4, 2, 3}) {
        EXPECT_EQ(run_unit(parts.folder, unit, PENT_BIN).verdict, UnitVerdict::Finished) << unit;
    }
    // Of the first, which ran before there was a reference, the frames had to wait.
    EXPECT_TRUE(std::filesystem::exists(parts.folder / "runs/dt-1_60/report.json"));
    static_cast<void>(collect_study(parts.folder, whole.created_by));
    EXPECT_FALSE(std::filesystem::exists(parts.folder / "runs/dt-1_60"));
    EXPECT_EQ(findings(parts), findings(whole));
    // One made the folder in which the other goes on.
    const std::string json = text_of(parts.folder / "study.json");
    static_cast<void>(run_study(parts));
    EXPECT_EQ(text_of(parts.folder / "study.json"), json);
    EXPECT_EQ(done(whole), std::vector<bool>(5, true));
}

// As a queue does that takes a machine away: with all that runs on it.
TEST(Units, GoOnAfterAKillAtAnyMoment) {
    const TempFolder folder;
    const StudyOptions whole = two_steps(folder, "whole");
    static_cast<void>(run_study(whole));
    const StudyOptions parts = two_steps(folder, "parts");
    static_cast<void>(prepare_study(parts));
    int kills = 0;
    for (int unit = 5; unit >= 1; --unit) {
        const std::string command =
            "pent-study -o " + parts.folder.string() + " --run " + std::to_string(unit);
        double seconds = 0.01;
        for (int code = 137; code != 0; seconds *= 1.5) {
            ASSERT_LT(seconds, 100) << unit;
            const std::string limit = "timeout -s KILL " + std::to_string(seconds);
            code = run_program(command, pent::test::kUncounted + limit).exit_code;
            kills += code == 0 ? 0 : 1;
        }
    }
    EXPECT_GE(kills, 5);
    static_cast<void>(collect_study(parts.folder, whole.created_by));
    EXPECT_EQ(findings(parts), findings(whole));
}

TEST(Units, OfAReferenceThatWasStoppedGoOnBehindItsLastFrame) {
    const TempFolder folder;
    StudyOptions options = two_steps(folder);
    static_cast<void>(prepare_study(options));
    const auto report = options.folder / "references/steps-8/frames/bar_000002.pent";
    const UnitOutcome cut =
        run_unit(options.folder, 3, PENT_BIN,
                 {.should_stop = [&] { return std::filesystem::exists(report); }});
    EXPECT_EQ(cut.verdict, UnitVerdict::Stopped);
    const auto written = std::filesystem::last_write_time(report);
    EXPECT_EQ(run_unit(options.folder, 3, PENT_BIN).verdict, UnitVerdict::Finished);
    EXPECT_EQ(std::filesystem::last_write_time(report), written);
}

TEST(Units, ThatDivergeOrDoNotGoTogetherAreResults) {
    const TempFolder folder;
    StudyOptions options = two_steps(folder);
    options.vary = {"max_iterations=1,3000", "max_halvings=0"};
    static_cast<void>(prepare_study(options));
    const std::string command = "pent-study -o " + options.folder.string() + " --run 4";
    for (int i = 0; i < 2; ++i) {
        const Outcome diverged = run_program(command);
        EXPECT_EQ(diverged.exit_code, 0) << diverged.err;
        expect_contains(diverged.out, {"unit 4: diverged: ", "did not reach its tolerance"});
    }
    EXPECT_EQ(done(options), (std::vector<bool>{false, false, false, true, false}));
    const auto record = nlohmann::json::parse(
        text_of(options.folder / "runs/max_iterations-1.max_halvings-0.json"));
    EXPECT_EQ(record.at("wall_seconds").size(), 1U);  // neither repeated nor run again

    options = two_steps(folder, "refused");
    options.scene = test::write_bar(folder, "[contact]\n");
    options.vary = {"contact=barrier", "integrator=linear_euler,bdf2"};
    EXPECT_TRUE(prepare_study(options)->units[3].is_done);
    const UnitOutcome refused = run_unit(options.folder, 4, PENT_BIN);
    EXPECT_EQ(refused.verdict, UnitVerdict::Refused);
    EXPECT_FALSE(refused.has_failed);
    expect_contains(refused.message, {"barrier"});
}

// What was wrong may be mended, as a full disk: a unit that was refused is run again.
TEST(Units, ThatFailSayWhyAndAreRunAgain) {
    const TempFolder folder;
    const StudyOptions options = two_steps(folder);
    static_cast<void>(prepare_study(options));
    const std::string command = "pent-study -o " + options.folder.string() + " --run 4";
    const auto foreign = options.folder / "runs/dt-1_30/notes.txt";
    std::filesystem::create_directory(foreign.parent_path());
    std::ofstream(foreign) << "mine";
    const Outcome refused = run_program(command);
    EXPECT_EQ(refused.exit_code, 1);
    expect_contains(refused.err, {"pent-study: unit 4 was refused: pent-sim: ", "stays as it is"});
    std::filesystem::remove(foreign);
    const Outcome again = run_program(command);
    EXPECT_EQ(again.exit_code, 0) << again.err;
    expect_contains(again.out, {"unit 4: finished"});
}

TEST(Units, AreRunByOneProgramEachAndManyAtOnce) {
    const TempFolder folder;
    const StudyOptions options = two_steps(folder);
    static_cast<void>(prepare_study(options));
    {
        const FileLock other(options.folder / "references/steps-2.toml", "");
        expect_contains(run_error(options, 1), {"steps-2.toml", "being run by another program"});
        EXPECT_EQ(run_unit(options.folder, 4, PENT_BIN).verdict, UnitVerdict::Finished);
    }
    OutputFolder other(options.folder, "study");
    other.share();
    EXPECT_EQ(run_unit(options.folder, 1, PENT_BIN).verdict, UnitVerdict::Finished);
    expect_contains(error_of([&] { static_cast<void>(prepare_study(options)); }),
                    {"another program is writing"});
}

TEST(Units, ThatAreMissingAreNamedInACollection) {
    const TempFolder folder;
    const StudyOptions options = two_steps(folder);
    static_cast<void>(prepare_study(options));
    static_cast<void>(run_unit(options.folder, 2, PENT_BIN));
    expect_contains(error_of([&] { static_cast<void>(collect_study(options.folder, "")); }),
                    {"of 5 units", "not been run to their end: 1, 3-5;", "--run NUMBER"});
    EXPECT_FALSE(std::filesystem::exists(options.folder / "study.json"));
}

TEST(Units, AreNotRunWithoutAStudyOrOfANumberThatItHasNot) {
    const TempFolder folder;
    const StudyOptions options = two_steps(folder);
    expect_contains(run_error(options, 1), {"no study has been prepared", "--prepare"});
    OutputFolder(folder / "run", "run").adopt("scene.toml");
    expect_contains(error_of([&] { static_cast<void>(state_of_study(folder / "run")); }),
                    {"is the folder of a run, not of a study"});
    static_cast<void>(prepare_study(options));
    for (const int number : {-1, 0, 6}) {
        expect_contains(run_error(options, number),
                        {"--run " + std::to_string(number), "units 1 to 5", "--list-runs"});
    }
}

TEST(Units, AreOfTheSceneTheMeshAndTheProgramThatWerePrepared) {
    const TempFolder folder;
    const StudyOptions options = two_steps(folder);
    static_cast<void>(prepare_study(options));
    EXPECT_NO_THROW(require_scene(options.folder, options.scene));
    static_cast<void>(test::write_bar(folder, "[damping]\nmass = 1\n"));
    expect_contains(error_of([&] { require_scene(options.folder, options.scene); }),
                    {"bar.toml: is not the scene", "another folder"});

    write_mesh(folder / "bar.pent", pent::test::kuhn_box<4>({2, 1, 1, 1}, {1.5, 0.5, 0.5, 0.5}));
    expect_contains(run_error(options, 4), {"bar.pent: is not the mesh", "--prepare again"});
    static_cast<void>(test::write_bar(folder));
    std::ofstream(options.folder / "runs/dt-1_30.toml", std::ios::app) << "[damping]\nmass = 1\n";
    expect_contains(run_error(options, 4), {"dt-1_30.toml: is not the scene", "--prepare again"});
    std::ofstream(options.folder / "program.txt") << "0123456789abcdef\n";
    expect_contains(run_error(options, 5), {"pent-sim: is another build", "another folder"});
    std::ofstream(options.folder / "plan.json") << "{}";
    expect_contains(run_error(options, 5), {"plan.json: not the plan", "--prepare again"});
}

// With more values, a finer reference, or another mesh under the old name.
TEST(Units, ThatStillHoldAreKeptWhenAStudyIsPreparedAgain) {
    const TempFolder folder;
    StudyOptions options = two_steps(folder);
    options.vary = {"dt=1/60"};
    static_cast<void>(run_study(options));
    options.vary = {"dt=1/30,1/60"};  // the same reference
    static_cast<void>(prepare_study(options));
    EXPECT_EQ(done(options), (std::vector<bool>{true, true, true, false, true}));
    options.vary = {"dt=1/120,1/60"};
    static_cast<void>(prepare_study(options));
    EXPECT_EQ(done(options), (std::vector<bool>{true, true, false, false, false}));
    write_mesh(folder / "bar.pent", pent::test::kuhn_box<4>({2, 1, 1, 1}, {1.5, 0.5, 0.5, 0.5}));
    const StudyReport report = run_study(options);
    EXPECT_EQ(report.vertices, 3 * 2 * 2 * 2);
    EXPECT_EQ(done(options), std::vector<bool>(5, true));
}

TEST(Units, OnDifferentProcessorsHaveTimesThatDoNotCompare) {
    const TempFolder folder;
    const StudyOptions options = two_steps(folder);
    EXPECT_TRUE(run_study(options).warnings.empty());
    const auto path = options.folder / "runs/dt-1_30.json";
    auto record = nlohmann::json::parse(text_of(path));
    EXPECT_EQ(record.at("machines").size(), 2U);
    EXPECT_FALSE(record.at("machines")[0].at("node").get<std::string>().empty());
    record.at("machines")[1]["processor"] = "Another 9000";
    std::ofstream(path) << record;
    const Outcome outcome = run_program("pent-study -o " + options.folder.string() + " --collect");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_contains(outcome.out, {"warning: ", "Another 9000: 1 run"});
    expect_contains(text_of(options.folder / "study.json"), {"Another 9000"});
}

// Meshes that a study made go with its folder, which other machines may see under another name.
TEST(Units, RunWhereverTheFolderIs) {
    if (!std::filesystem::exists(PENT_BIN "/pent-mesh")) {
        GTEST_SKIP() << "built without the mesher";
    }
    const TempFolder folder;
    std::ofstream(folder / "box.toml")
        << "[scene]\nframes = 2\n[[body]]\nname = \"box\"\n"
           "mesh = \"box.pent\"\nspin = [{ plane = \"xy\", degrees_per_s = 90 }]\n"
           "recipe = \"--box 1,1,1,1 --size 1,1,1,1\"\n";
    StudyOptions options = two_steps(folder);
    options.scene = folder / "box.toml";
    static_cast<void>(prepare_study(options));
    std::filesystem::rename(options.folder, folder / "moved");
    for (int unit = 1; unit <= 5; ++unit) {
        EXPECT_EQ(run_unit(folder / "moved", unit, PENT_BIN).verdict, UnitVerdict::Finished);
    }
    EXPECT_EQ(collect_study(folder / "moved", "").results.size(), 2U);
}

TEST(PentStudy, InPartsChoosesAndWritesTheSceneOfTheStudyInOneGo) {
    const TempFolder folder;
    const std::string scene = test::write_bar(folder).string();
    const std::string what = scene + " --vary dt=1/30,1/240 --repeat 1 --frames 3 --threads 1 -o ";
    const std::string choice = " --error 20 --write-scene ";
    const std::string whole = (folder / "whole").string();
    const std::string parts = (folder / "parts").string();
    EXPECT_EQ(
        run_program("pent-study " + what + whole + choice + (folder / "a.toml").string()).exit_code,
        0);
    const Outcome prepared = run_program("pent-study --prepare " + what + parts);
    expect_contains(prepared.out, {"prepared: 5 units, of which 3 are the reference and 0 done"});
    const Outcome list = run_program("pent-study --list-runs -o " + parts);
    EXPECT_EQ(list.out,
              "1 reference references/steps-8 open\n2 reference references/steps-16 open\n"
              "3 reference references/steps-32 open\n4 combination runs/dt-1_30 open\n"
              "5 combination runs/dt-1_240 open\n");
    for (const char* unit : {"1", "2", "3", "4", "5"}) {
        EXPECT_EQ(run_program("pent-study --run " + std::string(unit) + " -o " + parts).exit_code,
                  0);
    }
    const Outcome collected =
        run_program("pent-study --collect -o " + parts + choice + (folder / "b.toml").string());
    EXPECT_EQ(collected.exit_code, 0) << collected.err;
    EXPECT_EQ(text_of(folder / "b.toml"), text_of(folder / "a.toml"));
}

TEST(PentStudy, SaysWhichOptionsGoWithWhichPart) {
    const TempFolder folder;
    const std::string scene = test::write_bar(folder).string();
    const std::string output = " -o " + (folder / "study").string();
    const std::pair<const char*, const char*> wrong[] = {
        {"--run 1 --force", "--force: throws a study away; it goes with --prepare"},
        {"--collect --repeat 3", "--repeat: was fixed by --prepare; leave it out with --collect"},
        {"--run 1 --threads 2", "--threads: was fixed by --prepare"},
        {"--run 1 --error 1", "--error: chooses from what a study has found"},
        {"--run 1 --collect", "--run excludes --collect"},
        {"--prepare --vary dt=1/30", "scene is missing"}};
    for (const auto& [options, message] : wrong) {
        const Outcome outcome = run_program("pent-study " + std::string(options) + output);
        EXPECT_EQ(outcome.exit_code, 2) << options;
        expect_contains(outcome.err, {message});
        pent::test::expect_one_error_line(outcome, "pent-study");
    }
    const Outcome early = run_program("pent-study --run 1" + output);
    EXPECT_EQ(early.exit_code, 1);
    pent::test::expect_one_error_line(early, "pent-study");
    EXPECT_FALSE(std::filesystem::exists(folder / "study"));
}

}  // namespace
}  // namespace pent::study
