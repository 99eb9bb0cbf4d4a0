#include "stress_scenes.h"
#include "support/messages.h"

#include <pent/error.h>
#include <pent/simulator/crossing_error.h>

#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using test::BarrierScene;
using test::box;
using test::vector;
using test::WatchedRun;

// Every step taken, nothing ever crossed, and contact was what the scene is about.
template <int Dim>
void expect_sound(const WatchedRun<Dim>& run) {
    EXPECT_EQ(run.failure(), "");
    EXPECT_EQ(run.crossings(), 0);
    EXPECT_GT(run.smallest_distance(), 0);
    EXPECT_LT(run.smallest_distance(), 0.02);
    testing::Test::RecordProperty("smallest_distance", std::to_string(run.smallest_distance()));
    testing::Test::RecordProperty("newton_iterations", run.newton_iterations());
}

template <typename T>
class BarrierTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(BarrierTest, Dimensions);

TYPED_TEST(BarrierTest, HundredBodyLengthsASecondDoNotTunnel) {
    constexpr int kDim = TypeParam::value;
    WatchedRun<kDim> run(test::fast_impact<kDim>(1));
    run.run(10);
    expect_sound(run);
    EXPECT_GT(run.simulation().velocities(0).row(0).mean(), 1);  // the target was hit
}

TYPED_TEST(BarrierTest, StackedNoodlesStayApart) {
    constexpr int kDim = TypeParam::value;
    WatchedRun<kDim> run(test::stacked_noodles<kDim>(1));
    run.run(kDim == 3 ? 30 : 8);
    expect_sound(run);
}

TYPED_TEST(BarrierTest, NeedleGoesIntoAGapNarrowerThanItself) {
    constexpr int kDim = TypeParam::value;
    WatchedRun<kDim> run(test::needle_at_gap<kDim>(1));
    run.run(kDim == 3 ? 20 : 12);
    expect_sound(run);
    EXPECT_LT(run.simulation().positions(2).row(1).minCoeff(), 0.14);  // the tip is in the gap
}

TYPED_TEST(BarrierTest, HooksThatArePulledApartHold) {
    constexpr int kDim = TypeParam::value;
    WatchedRun<kDim> run(test::interlocked_hooks<kDim>(1));
    run.run(kDim == 3 ? 20 : 8);
    expect_sound(run);
}

TYPED_TEST(BarrierTest, StiffnessMayDifferAMillionfold) {
    constexpr int kDim = TypeParam::value;
    WatchedRun<kDim> run(test::million_to_one<kDim>(1));
    run.run(20);
    expect_sound(run);
}

TYPED_TEST(BarrierTest, SheetsOfOneLayerDoNotPassThroughEachOther) {
    constexpr int kDim = TypeParam::value;
    WatchedRun<kDim> run(test::thin_sheets<kDim>(1));
    run.run(kDim == 3 ? 20 : 4);
    expect_sound(run);
}

TYPED_TEST(BarrierTest, ABodyMeetsItselfIfAsked) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    scene.scene.contact->self = true;
    // The mouth of a hook is shut by force.
    SimplexMesh<kDim> hook = box<kDim>(4, 3, 1, vector<kDim>(0.4, 0.3, 0.1));
    hook = test::without<kDim>(hook, {-0.1, -0.05}, {0.21, 0.05});
    const Eigen::VectorXd everywhere = vector<kDim>(9, 9, 9);
    scene.add(hook, vector<kDim>(0, 0));
    scene.hold(-everywhere, vector<kDim>(9, -0.14, 9), vector<kDim>(0, 0));
    scene.hold(vector<kDim>(0.15, 0.14, -9), everywhere, vector<kDim>(0, -2), 0.045);
    WatchedRun<kDim> run(scene);
    run.run(kDim == 3 ? 12 : 6);
    expect_sound(run);
}

TYPED_TEST(BarrierTest, MomentumOfFreeBodiesIsKept) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    scene.scene.solver.newton_tolerance = 1e-8;
    const Eigen::VectorXd unit = Eigen::VectorXd::Constant(kDim, 0.2);
    scene.add(box<kDim>(1, 1, 1, unit), vector<kDim>(0, 0)).velocity = vector<kDim>(1, 0);
    scene.add(box<kDim>(1, 1, 1, unit), vector<kDim>(0.23, 0.01, 0.02)).velocity =
        vector<kDim>(-2, 0.1);
    WatchedRun<kDim> run(scene);
    const auto momentum = [&] {
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(kDim);
        for (int body = 0; body < 2; ++body) {
            sum += run.simulation().velocities(body) * run.simulation().masses(body);
        }
        return sum;
    };
    const Eigen::VectorXd before = momentum();
    run.run(10);
    expect_sound(run);
    // What Newton's method leaves unbalanced in a step is 1e-8 of the momentum in it.
    EXPECT_LT((momentum() - before).norm(), 1e-5 * before.norm());
}

TYPED_TEST(BarrierTest, StartThatCrossesIsRefusedWithItsPairs) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    const Eigen::VectorXd unit = Eigen::VectorXd::Constant(kDim, 0.2);
    scene.add(box<kDim>(1, 1, 1, unit), vector<kDim>(0, 0));
    scene.add(box<kDim>(1, 1, 1, unit), vector<kDim>(0.15, 0.03, 0.02));
    try {
        const Simulation<kDim> simulation(scene.scene, scene.meshes);
        FAIL() << "was not refused";
    } catch (const CrossingError<kDim>& error) {
        EXPECT_NE(std::string(error.what()).find("of 'a' goes through"), std::string::npos)
            << error.what();
        EXPECT_NO_THROW(validate<kDim>(error.offenders(), "offenders"));
        EXPECT_EQ(error.offenders().regions.size(),
                  static_cast<std::size_t>(error.offenders().cell_count()));
    }
    // Touching is refused too: a barrier has no force at distance 0.
    scene.scene.bodies[1].place.translate = vector<kDim>(0.2, 0);
    EXPECT_THROW(Simulation<kDim>(scene.scene, scene.meshes), CrossingError<kDim>);
    scene.scene.bodies[1].place.translate = vector<kDim>(0.21, 0);
    EXPECT_NO_THROW(Simulation<kDim>(scene.scene, scene.meshes));
}

TYPED_TEST(BarrierTest, HeldBodiesThatOverlapAreRefusedAsWell) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    const Eigen::VectorXd everywhere = vector<kDim>(9, 9, 9);
    const Eigen::VectorXd unit = Eigen::VectorXd::Constant(kDim, 0.2);
    for (const double x : {0.0, 0.15}) {
        scene.add(box<kDim>(1, 1, 1, unit), vector<kDim>(x, 0.2 * x, 0.1 * x));
        scene.hold(-everywhere, everywhere, vector<kDim>(0, 0));
    }
    EXPECT_NE(pent::test::error_of([&] {
                  const Simulation<kDim> simulation(scene.scene, scene.meshes);
              }).find("of 'a' goes through"),
              std::string::npos);
}

TYPED_TEST(BarrierTest, MotionThatLeavesNoWayOutIsReportedWithItsPair) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    scene.scene.solver.max_halvings = 0;
    const Eigen::VectorXd everywhere = vector<kDim>(9, 9, 9);
    // A held body is driven through another that is held.
    const Eigen::VectorXd unit = Eigen::VectorXd::Constant(kDim, 0.2);
    scene.add(box<kDim>(1, 1, 1, unit), vector<kDim>(0, 0));
    scene.hold(-everywhere, vector<kDim>(0.05, 9, 9), vector<kDim>(0, 0));
    scene.add(box<kDim>(1, 1, 1, unit), vector<kDim>(0.3, 0.01, 0.02));
    scene.hold(vector<kDim>(0.35, -9, -9), everywhere, vector<kDim>(-6, 0));
    WatchedRun<kDim> run(scene);
    run.run(12);
    EXPECT_NE(run.failure().find("cannot go on without a crossing at t = 0.0"), std::string::npos)
        << run.failure();
    EXPECT_NE(run.failure().find("of 'a'"), std::string::npos) << run.failure();
    EXPECT_NE(run.failure().find("of 'b'"), std::string::npos) << run.failure();
    EXPECT_EQ(run.crossings(), 0);
}

// The first step is thrown away, not cut, and leaves everything where it was.
template <int Dim>
StepReport expect_failure(BarrierScene<Dim>& scene, const std::string& why) {
    scene.scene.solver.max_halvings = 0;
    Simulation<Dim> simulation(scene.scene, scene.meshes);
    const Positions<Dim> before = simulation.positions(0);
    const StepReport report = simulation.step();
    EXPECT_FALSE(report.is_accepted);
    EXPECT_EQ(report.failure, why);
    EXPECT_EQ(Positions<Dim>(simulation.positions(0)), before);
    return report;
}

TYPED_TEST(BarrierTest, EnergyThatIsNotANumberIsAFailureOfTheStep) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    scene.add(box<kDim>(1, 1, 1, Eigen::VectorXd::Constant(kDim, 0.2)), vector<kDim>(0, 0))
        .velocity = vector<kDim>(1e160, 0);
    expect_failure(scene, "the energy grew beyond all bounds");
}

// An energy that falls without end, by pressure on a body that nothing holds together: corrections
// of a thousand times its size, which what is beside it cuts to a thousandth. Twenty iterations
// more would be on their way out.
TYPED_TEST(BarrierTest, BodyThatIsBlownUpIsAFailureOfTheStepBeforeLong) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    const SimplexMesh<kDim> cube = box<kDim>(1, 1, 1, Eigen::VectorXd::Constant(kDim, 0.2));
    scene.add(cube, vector<kDim>(0, 0), 1e4).material.model = Model::Arap;
    scene.add(cube, vector<kDim>(0.05, 0.25), 1e6);
    scene.scene.contact->self = true;
    scene.scene.loads = {{.body = "a",
                          .select = {EverythingSelection{}},
                          .force = {},
                          .pressure = -1e6,
                          .keyframes = {}}};
    EXPECT_LT(expect_failure(scene, "the motion grew beyond all bounds").newton_iterations, 20);
}

// The forces of something so soft are small next to its masses, but its energy is not a number even
// a trillionth of the way along.
TYPED_TEST(BarrierTest, MotionThatIsFarTooFarIsAFailureOfTheStep) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    scene.add(box<kDim>(1, 1, 1, Eigen::VectorXd::Constant(kDim, 0.2)), vector<kDim>(0, 0), 1e-60);
    scene.hold(vector<kDim>(-9, -9, -9), vector<kDim>(0, 9, 9), vector<kDim>(0, 1e202));
    expect_failure(scene, "the line search found no decrease");
}

TEST(Barrier, NeedsAnIntegratorThatIterates) {
    BarrierScene<3> scene;
    scene.add(box<3>(1, 1, 1, Eigen::VectorXd::Constant(3, 0.2)), vector<3>(0, 0));
    scene.scene.solver.integrator = Integrator::LinearEuler;
    EXPECT_NE(pent::test::error_of([&] { check(scene.scene); }).find("newton_euler"),
              std::string::npos);
}

TEST(Barrier, ResultsAreTheSameForAnyNumberOfThreads) {
    Positions<4> first;
    for (const int threads : {1, 3}) {
        BarrierScene<4> scene;
        const Eigen::VectorXd unit = Eigen::VectorXd::Constant(4, 0.2);
        scene.add(box<4>(1, 1, 1, unit), vector<4>(0, 0));
        scene.add(box<4>(1, 1, 1, unit), vector<4>(-0.23, 0.03, 0.02)).velocity = vector<4>(3, 0);
        Simulation<4> simulation(scene.scene, scene.meshes, {.threads = threads});
        for (int k = 0; k < 4; ++k) {
            EXPECT_TRUE(simulation.step().is_accepted);
        }
        const Positions<4> end = simulation.positions(1);
        if (threads == 1) {
            first = end;
        }
        EXPECT_EQ(end, first);
    }
}

}  // namespace
}  // namespace pent::simulator
