#include "resume_table.h"

#include "simulator/barrier_scenes.h"
#include "simulator/scenes.h"
#include "support/cut_in_two.h"
#include "support/temp_folder.h"

#include <pent/pent_file.h>
#include <pent/runs/run.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

// A run stopped at any step goes on to the same bytes, whatever it carries from step to step:
// previous states, who sleeps, stiffness that a barrier has adapted, friction of the last contacts.

namespace pent::runs {
namespace {

using namespace simulator;
namespace test = simulator::test;

namespace fs = std::filesystem;
using test::BarrierScene;
using test::box;
using test::vector;

constexpr int kSteps = 10;

// A fork whose left prong is bent to the right one, while a block comes down upon that, sliding;
// both are above ground. Aside from them a pebble flies at a block at rest, which by then has
// fallen asleep. Some vertices of each are held, as statics need it.
template <int Dim>
BarrierScene<Dim> busy_scene(const ResumeRow& row) {
    BarrierScene<Dim> made;
    made.scene.frames = kSteps;
    const Eigen::VectorXd small = Eigen::VectorXd::Constant(Dim, 0.1);
    const Eigen::VectorXd all = Eigen::VectorXd::Constant(Dim, 9);
    SimplexMesh<Dim> fork = box<Dim>(3, 2, 1, vector<Dim>(0.3, 0.3, 0.1));
    for (Eigen::Index v = 0; v < fork.vertex_count(); ++v) {
        fork.positions(0, v) *= std::abs(fork.positions(0, v)) < 0.1 ? 0.6 : 1;  // a gap of 6 cm
    }
    fork = test::without<Dim>(fork, {-0.03, 0}, {0.03, 1});
    made.add(fork, vector<Dim>(0, 0));
    // In statics nothing but a foot that is held keeps the fork from going along as a whole. Where
    // there is inertia the other prong is left behind, but less the slower the bend.
    const bool is_static = row.integrator == Integrator::Quasistatic;
    if (is_static) {
        made.hold(-all, vector<Dim>(9, -0.1, 9), vector<Dim>(0, 0));
    }
    const double bend = is_static ? 0.8 : 1.1;
    made.hold(vector<Dim>(-0.2, 0.1, -9), vector<Dim>(-0.02, 9, 9), vector<Dim>(bend, 0));
    const Eigen::VectorXd slide = (is_static ? 0.5 : 1) * vector<Dim>(-0.4, -0.5);
    made.add(box<Dim>(1, 1, 1, small), vector<Dim>(0.12, 0.22)).velocity = slide;
    made.hold(vector<Dim>(-9, 0.26, -9), all, slide);
    made.add(box<Dim>(1, 1, 1, small), vector<Dim>(1, 0.5));
    made.hold(vector<Dim>(1.04, -9, -9), all, vector<Dim>(0, 0));
    made.add(box<Dim>(1, 1, 1, small), vector<Dim>(0.83, 0.51, 0.02)).velocity = vector<Dim>(1, 0);
    made.hold(-all, vector<Dim>(0.79, 9, 9), vector<Dim>(1, 0));
    made.scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = vector<Dim>(0, 1), .offset = -0.16},
         .distance = 0.02}};
    for (Body& body : made.scene.bodies) {
        body.material.model = row.model;
        body.material.second_invariant = 0.4;
    }
    made.scene.contact.reset();
    const bool has_barrier = row.contact == ContactModel::Barrier;
    if (row.contact) {
        made.scene.contact = ContactSettings{.model = *row.contact,
                                             .distance = 0.02,
                                             .stiffness = has_barrier ? 20.0 : 100,  // has to adapt
                                             .self = row.is_self,
                                             .friction = row.friction};
    }
    if (row.has_sleep) {
        made.scene.sleep = Sleep{.speed = 0.01, .time = 0.03};
    }
    made.scene.solver.integrator = row.integrator;
    made.scene.solver.elements = row.elements;
    return made;
}

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Takes up to `steps` steps in a folder, behind those that it has.
RunReport go(const Scene& scene, const fs::path& folder, int steps) {
    return run(scene, {.folder = folder, .resume = fs::exists(folder)},
               {.should_stop = [&steps] { return steps-- == 0; }, .on_frame = {}});
}

// Empty, or the first frame that differs between two runs of a scene.
std::string different_frame(const Scene& scene, const fs::path& a, const fs::path& b) {
    for (int frame = 0; frame <= kSteps; ++frame) {
        for (const Body& body : scene.bodies) {
            const std::string name = frame_file_name(body.name, frame);
            if (bytes_of(a / "frames" / name).empty()
                || bytes_of(a / "frames" / name) != bytes_of(b / "frames" / name)) {
                return name;
            }
        }
    }
    return "";
}

void expect_whole_report(const RunReport& report) {
    EXPECT_EQ(report.frames.size(), std::size_t{kSteps} + 1);
    EXPECT_EQ(report.steps.size(), std::size_t{kSteps});
    for (std::size_t i = 0; i < report.steps.size(); ++i) {
        EXPECT_EQ(report.steps[i].step, i + 1);
    }
}

// Whether a row has what it is there for.
void expect_busy(const ResumeRow& row, const RunReport& report) {
    std::int64_t between = 0;
    std::int64_t within = 0;
    int asleep = 0;
    for (const StepReport& step : report.steps) {
        between += step.contact.point_facet + step.contact.mixed - step.contact.self;
        within += step.contact.self;
        asleep = std::max(asleep, step.asleep);
    }
    EXPECT_EQ(between > 0, row.contact.has_value());
    EXPECT_EQ(within > 0, row.is_self);
    EXPECT_EQ(asleep > 0, row.has_sleep);
}

// Whether ties came, pulled, broke and went, and muscles worked.
void expect_driven(const RunReport& report) {
    const auto springs = [&](std::size_t step, std::size_t tie) {
        return report.steps[step].attachments[tie].springs;
    };
    EXPECT_EQ(springs(0, 0), 0);
    EXPECT_GT(springs(4, 0), 0);
    EXPECT_EQ(springs(9, 0), 0);
    EXPECT_GT(report.steps[9].attachments[1].force, 0);
    EXPECT_EQ(report.steps[0].attachments[2].broken, 0);
    EXPECT_GT(report.steps[9].attachments[2].broken, 0);
}

// Ties a and b to what they are near and to points that move, and lets go of it; what is tied to
// the block at rest breaks. Holds more of that block for a while. The ground rises; the fork is
// loaded, and contracts in pulses.
template <int Dim>
void drive(BarrierScene<Dim>& made) {
    Scene& scene = made.scene;  // ten steps of 10 ms
    const Eigen::VectorXd all = Eigen::VectorXd::Constant(Dim, 9);
    const auto box_of = [](const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
        return std::vector<Selection>{BoxSelection{.low = low, .high = high}};
    };
    Motion along = test::still(Dim);
    along.translate = vector<Dim>(0.5, 0.2);
    Attachment onto;
    onto.body = "b";
    onto.select = box_of(-all, vector<Dim>(9, 0.18, 9));
    onto.target = "a";
    onto.max_distance = 0.2;
    onto.stiffness = 50;
    onto.from = 0.02;
    onto.to = 0.07;
    Attachment pulled;
    pulled.body = "a";
    pulled.select = box_of(vector<Dim>(0.12, 0.12, -9), all);
    pulled.motion = {along};
    pulled.stiffness = 20;
    pulled.damping = 0.1;
    Attachment torn;
    torn.body = "c";
    torn.select = box_of(-all, vector<Dim>(0.96, 9, 9));
    torn.motion = {along};
    torn.stiffness = 100;
    torn.break_force = 1;
    scene.attachments = {onto, pulled, torn};
    Constraint hold;
    hold.body = "c";
    hold.select = box_of(-all, vector<Dim>(0.96, 9, 9));
    hold.motion = {test::still(Dim)};
    hold.from = 0.05;
    hold.to = 0.08;
    scene.constraints.push_back(hold);
    Motion rise = test::still(Dim);
    rise.translate = vector<Dim>(0, 0.1);
    scene.obstacles[0].motion = {rise};
    Activation muscle;
    muscle.body = "a";
    muscle.select = {EverythingSelection{}};
    muscle.stretch = 0.9;
    muscle.fibers = Fibers::Constant;
    muscle.direction = Eigen::VectorXd::Unit(Dim, 1);
    muscle.signal = Signal::Pulses;
    muscle.frequency = 20;
    scene.activations = {muscle};
    scene.loads = {{.body = "a",
                    .select = box_of(vector<Dim>(0.1, 0, -9), all),
                    .force = vector<Dim>(0, 0.2, 0.1),
                    .keyframes = {{0, 0}, {0.04, 1}, {0.09, 0.3}}}};
}

template <int Dim>
void expect_to_go_on(const ResumeRow& row, bool is_driven) {
    BarrierScene<Dim> made = busy_scene<Dim>(row);
    if (is_driven) {
        drive(made);
    }
    const pent::test::TempFolder folder;
    for (std::size_t body = 0; body < made.meshes.size(); ++body) {
        made.scene.bodies[body].mesh = (folder / made.scene.bodies[body].mesh).string();
        const SimplexMesh<Dim>& mesh = made.meshes[body];
        static_cast<void>(write_mesh(
            made.scene.bodies[body].mesh,
            row.elements == ElementKind::Quadratic ? pent::test::cut_in_two<Dim>(mesh) : mesh));
    }
    const RunReport whole = go(made.scene, folder / "whole", -1);
    ASSERT_EQ(whole.verdict, RunVerdict::Finished) << whole.message;
    is_driven ? expect_driven(whole) : expect_busy(row, whole);
    for (int stop = 1; stop < kSteps; ++stop) {
        const fs::path run = folder / ("stop" + std::to_string(stop));
        static_cast<void>(go(made.scene, run, stop));
        expect_whole_report(go(made.scene, run, -1));
        ASSERT_EQ(different_frame(made.scene, folder / "whole", run), "") << "stopped at " << stop;
    }
    for (int stop = 1; stop < kSteps; ++stop) {
        static_cast<void>(go(made.scene, folder / "often", 1));
    }
    expect_whole_report(go(made.scene, folder / "often", -1));
    EXPECT_EQ(different_frame(made.scene, folder / "whole", folder / "often"), "")
        << "stopped at every step";
}

class ResumeTable : public testing::TestWithParam<ResumeRow> {};

TEST_P(ResumeTable, RunStoppedAtEveryStepGoesOnToTheSameBytes) {
    GetParam().dimension == 3 ? expect_to_go_on<3>(GetParam(), false)
                              : expect_to_go_on<4>(GetParam(), false);
}

class DrivenResumeTable : public testing::TestWithParam<ResumeRow> {};

TEST_P(DrivenResumeTable, RunOfTiesHoldsLoadsAndMusclesGoesOnToTheSameBytes) {
    GetParam().dimension == 3 ? expect_to_go_on<3>(GetParam(), true)
                              : expect_to_go_on<4>(GetParam(), true);
}

std::string name_of(const testing::TestParamInfo<ResumeRow>& row) {
    std::string name = text_of(row.param);
    std::erase(name, ',');
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
    return name;
}

std::vector<ResumeRow> rows_of_both_dimensions() {
    std::vector<ResumeRow> rows = every_row(3);
    const std::vector<ResumeRow> in_4 = every_row(4);
    rows.insert(rows.end(), in_4.begin(), in_4.end());
    return rows;
}

// Each integrator with each model of contact, of the elements that muscles work in.
std::vector<ResumeRow> driven_rows(int dimension) {
    std::vector<ResumeRow> rows;
    for (const ResumeRow& row : every_row(dimension)) {
        const bool is_plain = row.elements != ElementKind::Smoothed && !row.has_sleep
                              && !row.is_self && row.model == Model::StableNeoHookean;
        if (is_plain && (row.friction > 0 || !row.contact)) {
            rows.push_back(row);
        }
    }
    return rows;
}

INSTANTIATE_TEST_SUITE_P(EveryPairOfSettings,
                         ResumeTable,
                         testing::ValuesIn(covering_rows(rows_of_both_dimensions())),
                         name_of);
INSTANTIATE_TEST_SUITE_P(EveryIntegratorAndContact,
                         DrivenResumeTable,
                         testing::ValuesIn(driven_rows(3)),
                         name_of);
// Minutes: scripts/faults.sh.
INSTANTIATE_TEST_SUITE_P(DISABLED_EveryCombinationIn4D,
                         DrivenResumeTable,
                         testing::ValuesIn(driven_rows(4)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(DISABLED_EveryCombination,
                         ResumeTable,
                         testing::ValuesIn(every_row(3)),
                         name_of);

TEST(CoveringRows, HaveEveryTwoSettingsThatGoTogether) {
    const std::vector<ResumeRow> rows = covering_rows(every_row(3));
    EXPECT_LT(rows.size(), 30U);  // 15 is the least: five energies by three models of contact
    const auto has = [&](const auto& condition) {
        return std::any_of(rows.begin(), rows.end(), condition);
    };
    EXPECT_TRUE(has([](const ResumeRow& row) {
        return row.contact == ContactModel::Barrier && row.friction > 0;
    }));
    EXPECT_TRUE(has(
        [](const ResumeRow& row) { return row.integrator == Integrator::Bdf2 && row.has_sleep; }));
    EXPECT_TRUE(has([](const ResumeRow& row) {
        return row.elements == ElementKind::Smoothed && row.model == Model::Linear;
    }));
}

}  // namespace
}  // namespace pent::runs
