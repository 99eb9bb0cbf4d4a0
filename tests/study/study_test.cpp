#include "../apps/run_program.h"
#include "scene.h"
#include "support/messages.h"

#include <pent/runs/scene_file.h>
#include <pent/study/study.h>
#include <pent/study/units.h>

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

namespace pent::study {
namespace {

using pent::test::expect_contains;
using pent::test::TempFolder;
using pent::test::text_of;

StudyOptions bar_study(const TempFolder& folder, std::vector<std::string> vary) {
    return {.scene = test::write_bar(folder),
            .folder = folder / "study",
            .vary = std::move(vary),
            .repeats = 1,
            .programs = PENT_BIN};
}

bool has_mesher() {
    return std::filesystem::exists(PENT_BIN "/pent-mesh");
}

// A box that flies down without a force, and other bodies; meshes by their recipes.
StudyOptions boxes_study(const TempFolder& folder,
                         const std::string& more,
                         std::vector<std::string> vary) {
    std::ofstream(folder / "boxes.toml") << R"([scene]
frames = 2
[[body]]
name = "a"
mesh = "none.pent"
recipe = "--box 1,1,1,1 --size 1,1,1,1"
velocity = [0, -2, 0, 0]
)" << more;
    return {.scene = folder / "boxes.toml",
            .folder = folder / "study",
            .vary = std::move(vary),
            .repeats = 1,
            .programs = PENT_BIN};
}

// Two cubes of one cell each that fly at each other.
std::filesystem::path write_collision(const TempFolder& folder) {
    write_mesh(folder / "cube.pent", pent::test::kuhn_box<3>({1, 1, 1}, {0.5, 0.5, 0.5}));
    std::ofstream(folder / "hit.toml") << R"([scene]
dimension = 3
frames = 9

[[body]]
name = "a"
mesh = "cube.pent"
velocity = [1, 0, 0]

[[body]]
name = "b"
mesh = "cube.pent"
place = { translate = [0.55, 0.1, 0.1] }

[contact]
distance = 0.04
)";
    return folder / "hit.toml";
}

// The theory of the integrators, seen from outside: the reference is of second order, Euler of
// first.
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
        EXPECT_EQ(result.verdict, UnitVerdict::Finished);
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

TEST(RunStudy, RefusesTheFolderThatAnotherProgramMeasuredFor) {
    const TempFolder folder;
    StudyOptions options = bar_study(folder, {"dt=1/30"});
    static_cast<void>(run_study(options, {.should_stop = [] { return true; }}));
    std::ofstream(options.folder / "program.txt") << "0123456789abcdef\n";
    expect_contains(pent::test::error_of([&] { static_cast<void>(run_study(options)); }),
                    {"another pent-sim", "--force"});
    options.force = true;
    EXPECT_NO_THROW(static_cast<void>(run_study(options)));
    options.force = false;
    EXPECT_NO_THROW(static_cast<void>(run_study(options)));
}

TEST(RunStudy, StudiesOnlySoManyFramesAndMeasuresEachSettingAsOftenAsAsked) {
    const TempFolder folder;
    StudyOptions options = bar_study(folder, {"dt=1/30"});
    options.frames = 2;
    options.repeats = 2;
    int total = 0;
    const StudyReport report =
        run_study(options, {.on_run = [&](int, int runs, const std::string&) { total = runs; }});
    EXPECT_EQ(report.frames, 2);
    EXPECT_EQ(report.scene_frames, 4);
    EXPECT_DOUBLE_EQ(report.reference.window, 2.0 / 30);
    EXPECT_EQ(total, 3 + 2);  // three levels of the reference
    const auto record = nlohmann::json::parse(text_of(folder / "study/runs/dt-1_30.json"));
    EXPECT_EQ(record.at("wall_seconds").size(), 2U);
    EXPECT_FALSE(std::filesystem::exists(folder / "study/runs/dt-1_30"));  // measured and gone
}

TEST(RunStudy, RefusesAnAxisThatIsVariedTwice) {
    const TempFolder folder;
    const StudyOptions options = bar_study(folder, {"dt=1/30", "integrator=bdf2", "dt=1/60"});
    expect_contains(pent::test::error_of([&] { static_cast<void>(run_study(options)); }),
                    {"--vary dt=1/60", "dt is varied twice"});
    EXPECT_FALSE(std::filesystem::exists(folder / "study"));
}

TEST(RunStudy, AskedToStopAtOnceRunsNothing) {
    const TempFolder folder;
    int told = 0;
    const StudyReport report = run_study(bar_study(folder, {"dt=1/30"}),
                                         {.should_stop = [] { return true; },
                                          .on_run = [&](int, int, const std::string&) { ++told; }});
    EXPECT_TRUE(report.is_stopped);
    EXPECT_EQ(told, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "study/references/steps-1"));
}

// A folder of one's own that has the names that those of a study have.
TEST(RunStudy, RefusesAFolderThatIsNotOfAStudyWhateverIsAsked) {
    const TempFolder folder;
    StudyOptions options = bar_study(folder, {"dt=1/30"});
    std::filesystem::create_directories(options.folder / "runs");
    std::ofstream(options.folder / "runs/mine") << "mine";
    for (const bool force : {false, true}) {
        options.force = force;
        expect_contains(pent::test::error_of([&] { static_cast<void>(run_study(options)); }),
                        {(folder / "study").string(), "stays as it is"});
        EXPECT_EQ(text_of(folder / "study/runs/mine"), "mine");
    }
}

TEST(RunStudy, ThrowsAwayWhatAStudyWroteAndNothingElse) {
    const TempFolder folder;
    StudyOptions options = bar_study(folder, {"dt=1/30"});
    static_cast<void>(run_study(options));
    std::ofstream(folder / "study/references/steps-1/notes.txt") << "mine";
    std::ofstream(folder / "study/notes.txt") << "mine";
    options.force = true;
    static_cast<void>(run_study(options));
    EXPECT_EQ(text_of(folder / "study/references/steps-1/notes.txt"), "mine");
    EXPECT_EQ(text_of(folder / "study/notes.txt"), "mine");
}

TEST(RunStudy, RefusesAReferenceOfAnotherMeshThanItsFrames) {
    const TempFolder folder;
    const StudyOptions options = bar_study(folder, {"dt=1/30"});
    int started = 0;
    static_cast<void>(
        run_study(options, {.should_stop = [&] { return started > 2; },  // in the third level
                            .on_run = [&](int, int, const std::string&) { ++started; }}));
    const auto last = folder / "study/references/steps-2/frames/bar_000004.pent";
    Frame<4> frame = read_frame<4>(last);
    const Eigen::Index vertices = frame.positions.cols();
    frame.positions.conservativeResize(4, vertices - 1);
    frame.velocities.conservativeResize(4, vertices - 1);
    write_frame(last, frame);
    expect_contains(pent::test::error_of([&] { static_cast<void>(run_study(options)); }),
                    {last.string(), "has " + std::to_string(vertices - 1) + " vertices",
                     "expected " + std::to_string(vertices)});
}

TEST(RunStudy, ReportsSettingsThatDiverge) {
    const TempFolder folder;
    const StudyReport report =
        run_study(bar_study(folder, {"max_iterations=1,3000", "max_halvings=0"}));
    EXPECT_EQ(report.results[0].verdict, UnitVerdict::Diverged);
    expect_contains(report.results[0].message, {"did not reach its tolerance"});
    EXPECT_EQ(report.results[1].verdict, UnitVerdict::Finished);
    EXPECT_EQ(report.frontier, std::vector<std::size_t>{1});
}

TEST(RunStudy, VariesTheModelOfContactAndRefusesWhatDoesNotGoTogether) {
    const TempFolder folder;
    const StudyReport report =
        run_study({.scene = write_collision(folder),
                   .folder = folder / "study",
                   .vary = {"contact=penalty,barrier", "integrator=linear_euler,newton_euler"},
                   .repeats = 1,
                   .programs = PENT_BIN});
    ASSERT_EQ(report.results.size(), 4U);
    EXPECT_TRUE(report.reference.has_contact);
    // 0.2 s behind the first contact, where a has gone 0.01 of the 0.05 m between them.
    EXPECT_NEAR(report.reference.window, 0.21, 1.0 / 120);
    EXPECT_EQ(report.reference.last.position, report.reference.difference.back());
    EXPECT_LT(report.reference.last.contact_work, report.results[0].errors.contact_work);
    for (const std::size_t i : {0U, 1U, 3U}) {
        EXPECT_EQ(report.results[i].verdict, UnitVerdict::Finished) << report.results[i].message;
    }
    EXPECT_EQ(report.results[2].verdict, UnitVerdict::Refused);  // barrier with linear_euler
    expect_contains(report.results[2].message, {"barrier", "newton_euler"});
    EXPECT_EQ(report.results[3].errors.deepest_penetration, 0);
    EXPECT_GT(report.results[3].errors.contact_work, 0);
    const std::string csv = text_of(folder / "study/study.csv");
    EXPECT_EQ(std::ranges::count(csv, '\n'), 5);
}

TEST(RunStudy, SaysWhyAReferenceDoesNotRunToItsEnd) {
    const TempFolder folder;
    const std::filesystem::path scene = write_collision(folder);
    std::string text = text_of(scene);
    text.replace(text.find("[0.55,"), 6, "[0.45,");  // one cube in the other
    std::ofstream(scene) << text << "model = \"barrier\"\n[solver]\nintegrator = \"bdf2\"\n";
    const StudyOptions options{.scene = scene,
                               .folder = folder / "study",
                               .vary = {"dt=1/30"},
                               .repeats = 1,
                               .programs = PENT_BIN};
    expect_contains(pent::test::error_of([&] { static_cast<void>(run_study(options)); }),
                    {"the reference (bdf2, dt = 0.0333 s) does not run to its end", "pent-sim: "});
}

TEST(RunStudy, VariesTheSettingsOfTheLinearSolver) {
    const TempFolder folder;
    const StudyReport report = run_study(
        bar_study(folder, {"precision=float,double", "tolerance=1e-1,1e-6", "filter=clamp,none",
                           "preconditioner=block-jacobi,rigid-modes"}));
    ASSERT_EQ(report.results.size(), 16U);
    for (const Result& result : report.results) {
        EXPECT_EQ(result.verdict, UnitVerdict::Finished) << settings_text(result.settings);
    }
    for (std::size_t i = 0; i < 16; i += 2) {  // the better preconditioner in as many or fewer
        EXPECT_GE(report.results[i].errors.iterations, report.results[i + 1].errors.iterations)
            << i;
    }
    EXPECT_GT(report.results[4].errors.iterations, report.results[0].errors.iterations);  // 1e-6
}

// A ball on layers held at its bottom; its recipe makes it anew for each level.
TEST(RunStudy, MakesTheMeshesOfItsLevelsAndMeasuresAgainstTheFinest) {
    if (!has_mesher()) {
        GTEST_SKIP() << "built without the mesher";
    }
    const TempFolder folder;
    std::ofstream(folder / "ball.toml") << R"([scene]
gravity = [0, -9.8, 0, 0]
frames = 2
[[body]]
name = "ball"
mesh = "ball.pent"
recipe = "--ball 1 --thickness 1 --layers 1"
[[constraint]]
body = "ball"
select = { half_space = { normal = [0, 1, 0, 0], offset = -0.5 } }
[solver]
preset = "accurate"
)";
    const StudyOptions options{.scene = folder / "ball.toml",
                               .folder = folder / "study",
                               .vary = {"layers=2,1", "subdivide=1,2", "dt=1/30,1/120"},
                               .repeats = 1,
                               .programs = PENT_BIN};
    const StudyReport report = run_study(options);
    ASSERT_EQ(report.results.size(), 8U);
    EXPECT_EQ(report.cells, 80 * 2 * 16);  // 4 pentachora a tetrahedron and layer, 2^4 of each
    const auto error = [&](std::size_t i) { return report.results[i].errors.position; };
    EXPECT_LT(error(3), error(1));  // 2 layers, subdivided or not, at 1/120
    EXPECT_LT(error(3), error(7));  // 2 layers or 1, both subdivided
    // The chosen scene names the mesh that was made for it.
    const simulator::Scene chosen =
        runs::parse_scene(scene_with(options.folder, report.results[3], folder / "study"), "chosen",
                          folder / "study");
    EXPECT_TRUE(std::filesystem::exists(chosen.bodies[0].mesh)) << chosen.bodies[0].mesh;
}

std::filesystem::path write_beam(const TempFolder& folder, const std::string& more) {
    std::ofstream(folder / "beam.toml") << R"([scene]
gravity = [0, -9.8, 0, 0]
frames = 10
[[body]]
name = "beam"
mesh = "beam.pent"
recipe = "--box 4,1,1,1 --size 4,1,1,1)" << more
                                        << R"("
[[constraint]]
body = "beam"
select = { half_space = { normal = [1, 0, 0, 0], offset = -1.99 } }
[solver]
preset = "accurate"
)";
    return folder / "beam.toml";
}

// All kinds of elements have the same limit; on a coarse mesh the smoothed ones are nearer to it.
TEST(RunStudy, MeasuresKindsOfElementsAgainstThatWhichLocksLeast) {
    if (!has_mesher()) {
        GTEST_SKIP() << "built without the mesher";
    }
    const TempFolder folder;
    const StudyReport report =
        run_study({.scene = write_beam(folder, ""),
                   .folder = folder / "study",
                   .vary = {"elements=linear,smoothed", "subdivide=1,2", "dt=1/60"},
                   .repeats = 1,
                   .programs = PENT_BIN});
    ASSERT_EQ(report.results.size(), 4U);
    const auto error = [&](std::size_t i) { return report.results[i].errors.position; };
    EXPECT_GT(error(0), error(1));      // linear: the finer mesh
    EXPECT_GT(error(2), error(3));      // smoothed
    EXPECT_LT(error(2), error(0));      // coarse: smoothed instead of linear
    EXPECT_LT(error(3), error(1) / 3);  // fine: that of the reference itself but for its steps
    expect_contains(text_of(folder / "study/references/steps-8.toml"), {"elements = \"smoothed\""});
}

// On one mesh: what is left of the error of quadratic elements is that of steps.
TEST(RunStudy, MeasuresOthersAgainstQuadraticElementsWhereTheMeshHasThem) {
    if (!has_mesher()) {
        GTEST_SKIP() << "built without the mesher";
    }
    const TempFolder folder;
    const StudyReport report = run_study({.scene = write_beam(folder, " --quadratic"),
                                          .folder = folder / "study",
                                          .vary = {"elements=quadratic,smoothed,linear", "dt=1/60"},
                                          .repeats = 1,
                                          .programs = PENT_BIN});
    ASSERT_EQ(report.results.size(), 3U);
    const auto error = [&](std::size_t i) { return report.results[i].errors.position; };
    EXPECT_LT(error(0), error(1) / 3);
    EXPECT_LT(error(1), error(2));
    expect_contains(text_of(folder / "study/references/steps-8.toml"),
                    {"elements = \"quadratic\""});
}

// Presets of which one takes quadratic elements: what those of linear ones lack is in their errors.
TEST(RunStudy, MeasuresPresetsAgainstTheElementsOfTheBest) {
    const TempFolder folder;
    const std::filesystem::path scene = test::write_bar(folder);
    write_mesh(folder / "bar.pent",
               pent::test::quadratic_kuhn_box<4>({1, 1, 1, 1}, {1.5, 0.5, 0.5, 0.5}));
    const StudyReport report = run_study({.scene = scene,
                                          .folder = folder / "study",
                                          .vary = {"preset=balanced,accurate", "dt=1/60"},
                                          .repeats = 1,
                                          .programs = PENT_BIN});
    ASSERT_EQ(report.results.size(), 2U);
    EXPECT_LT(report.results[1].errors.position, report.results[0].errors.position / 3);
    expect_contains(text_of(folder / "study/references/steps-8.toml"),
                    {"elements = \"quadratic\""});
}

TEST(RunStudy, RefusesLevelsOfDifferentShape) {
    if (!has_mesher()) {
        GTEST_SKIP() << "built without the mesher";
    }
    const TempFolder folder;
    const StudyOptions options = boxes_study(folder, "", {"subdivide=1,2"});
    ASSERT_TRUE(prepare_study(options));
    write_mesh(options.folder / "meshes/a.subdivide-1.pent",
               pent::test::kuhn_box<4>({1, 1, 1, 1}, {3, 1, 1, 1}));
    expect_contains(pent::test::error_of([&] { static_cast<void>(run_study(options)); }),
                    {"different shapes", "of one body"});
}

// Boxes that part as they are: they move exactly, in whatever cells the others are looked for.
TEST(RunStudy, ComparesBodiesThatTouchEachWithItself) {
    if (!has_mesher()) {
        GTEST_SKIP() << "built without the mesher";
    }
    const TempFolder folder;
    const StudyReport report = run_study(boxes_study(folder, R"(
[[body]]
name = "b"
mesh = "none.pent"
recipe = "--box 1,1,1,1 --size 1,1,1,1"
place = { translate = [0, 1, 0, 0] }
)",
                                                     {"subdivide=1,2"}));
    ASSERT_EQ(report.results.size(), 2U);
    for (const Result& result : report.results) {
        EXPECT_LT(result.errors.position, 1e-12);  // rounding of a rigid flight
    }
}

// A box twice as large is elsewhere by as much on every mesh, and in whatever order it comes.
TEST(RunStudy, ComparesPlacedMeshesAtTheirVerticesWhateverTheOrder) {
    if (!has_mesher()) {
        GTEST_SKIP() << "built without the mesher";
    }
    std::map<std::string, double> errors;
    for (const char* scales : {"body.place.scale=1,2", "body.place.scale=2,1"}) {
        const TempFolder folder;
        for (const Result& result :
             run_study(boxes_study(folder, "", {scales, "subdivide=1,2"})).results) {
            const double error = result.errors.position;
            const auto [known, is_new] = errors.emplace(settings_text(result.settings), error);
            EXPECT_NEAR(error, known->second, 1e-12) << known->first;
            const bool is_placed_alike = result.settings[0].value == "1";
            EXPECT_EQ(error < 1e-12, is_placed_alike) << known->first;
        }
    }
    EXPECT_EQ(errors.size(), 4U);
}

TEST(RunStudy, MakesAMeshAnewWhenTheModelOfItsRecipeHasChanged) {
    if (!has_mesher()) {
        GTEST_SKIP() << "built without the mesher";
    }
    const TempFolder folder;
    const auto write_model = [&](const char* height) {  // a tetrahedron
        std::ofstream(folder / "my model.off") << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 " << height
                                               << "\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    };
    std::ofstream(folder / "model.toml") << "[[body]]\nname = \"a\"\nmesh = \"none.pent\"\n"
                                            "recipe = \"'my model.off' --thickness 1\"\n";
    const StudyOptions options{.scene = folder / "model.toml",
                               .folder = folder / "study",
                               .vary = {"layers=1"},
                               .programs = PENT_BIN};
    const auto mesh = [&] {
        EXPECT_TRUE(prepare_study(options));
        return text_of(options.folder / "meshes/a.layers-1.pent");
    };
    write_model("1");
    const std::string before = mesh();
    EXPECT_EQ(mesh(), before);
    write_model("2");
    EXPECT_NE(mesh(), before);
}

TEST(RunStudy, TakesRunsAnewThatHadOtherThreads) {
    const TempFolder folder;
    StudyOptions options = bar_study(folder, {"dt=1/30"});
    static_cast<void>(run_study(options));
    const auto runs = [&] {
        int started = 0;
        static_cast<void>(
            run_study(options, {.on_run = [&](int, int, const std::string&) { ++started; }}));
        return started;
    };
    EXPECT_EQ(runs(), 0);
    options.threads = 2;
    EXPECT_EQ(runs(), 4);  // three levels of the reference and the run
}

TEST(RunStudy, KeepsTheFramesOfRunsThatWereMeasuredBeforeItWasAsked) {
    const TempFolder folder;
    StudyOptions options = bar_study(folder, {"dt=1/30"});
    static_cast<void>(run_study(options));
    options.keep_runs = true;
    static_cast<void>(run_study(options));
    EXPECT_TRUE(std::filesystem::exists(options.folder / "runs/dt-1_30/frames/bar_000004.pent"));
}

TEST(RunStudy, RefusesAnAxisThatIsVariedTwiceByItsNameAndItsPath) {
    const TempFolder folder;
    const StudyOptions options =
        bar_study(folder, {"elements=linear", "solver.elements=quadratic"});
    expect_contains(pent::test::error_of([&] { static_cast<void>(run_study(options)); }),
                    {"elements is varied twice"});
}

// The law that decides the reference is that of the runs, whatever the scene had before.
TEST(RunStudy, HasAReferenceThatMovesWhereItsRunsDo) {
    const TempFolder folder;
    StudyOptions options = bar_study(folder, {"integrator=bdf2,newton_euler"});
    static_cast<void>(test::write_bar(folder, "[solver]\nintegrator = \"quasistatic\"\n"));
    ASSERT_TRUE(prepare_study(options));
    expect_contains(text_of(options.folder / "references/steps-4.toml"), {"integrator = \"bdf2\""});
    options.vary = {"integrator=quasistatic"};
    static_cast<void>(test::write_bar(folder));
    options.force = true;
    ASSERT_TRUE(prepare_study(options));
    expect_contains(text_of(options.folder / "references/steps-4.toml"),
                    {"integrator = \"quasistatic\""});
}

TEST(RunStudy, RefusesToMixMotionsWithEquilibria) {
    const TempFolder folder;
    StudyOptions options = bar_study(folder, {"integrator=quasistatic,bdf2"});
    const auto error = [&] {
        return pent::test::error_of([&] { static_cast<void>(run_study(options)); });
    };
    expect_contains(error(), {"integrator=quasistatic", "integrator=bdf2", "two studies"});
    options.vary = {"dt=1/30"};
    options.reference_integrator = "quasistatic";
    expect_contains(error(), {"--reference-integrator quasistatic", "bdf2"});
}

TEST(RunStudy, RefusesOptionsOutOfRange) {
    for (const StudyOptions& options :
         {StudyOptions{.repeats = 0}, StudyOptions{.reference_halvings = 1},
          StudyOptions{.reference_halvings = 9}, StudyOptions{.threads = 0}}) {
        expect_contains(pent::test::error_of([&] { static_cast<void>(run_study(options)); }),
                        {"at least 1 repetition", "2 to 8 halvings", "at least 1 thread"});
    }
}

TEST(RunStudy, NamesTheBodyWhoseRecipeMakesNoMesh) {
    if (!has_mesher()) {
        GTEST_SKIP() << "built without the mesher";
    }
    const TempFolder folder;
    std::ofstream(folder / "ball.toml") << "[[body]]\nname = \"ball\"\nmesh = \"ball.pent\"\n"
                                           "recipe = \"--bal 1\"\n";
    const StudyOptions options{.scene = folder / "ball.toml",
                               .folder = folder / "study",
                               .vary = {"layers=1,2"},
                               .repeats = 1,
                               .programs = PENT_BIN};
    expect_contains(pent::test::error_of([&] { static_cast<void>(run_study(options)); }),
                    {"the recipe of \"ball\" does not make a mesh", "--bal"});
}

}  // namespace
}  // namespace pent::study
