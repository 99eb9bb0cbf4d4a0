#include "contact_scenes.h"
#include "model/rotation.h"
#include "support/messages.h"

#include <pent/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

// Vertices that are held for a while, and free before and after.

namespace pent::simulator {
namespace {

using test::cube;
using test::still;

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class Hold : public testing::Test {};
TYPED_TEST_SUITE(Hold, Dimensions);

constexpr Integrator kWithInertia[] = {Integrator::LinearEuler, Integrator::NewtonEuler,
                                       Integrator::Bdf2};

// The left side of a box of 2 cells, of steps of 10 ms.
template <int Dim>
Constraint left(double from, double to) {
    Constraint constraint = test::hold(
        HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(Dim, 0), .offset = 1e-6}, still(Dim));
    constraint.from = from;
    constraint.to = to;
    return constraint;
}

template <int Dim>
Scene falling_box() {
    Scene scene = test::box_scene<Dim>();
    scene.gravity[1] = -9.8;
    scene.frames_per_second = 100;
    return scene;
}

template <int Dim>
Positions<Dim> left_side(const Simulation<Dim>& simulation) {
    Positions<Dim> side(Dim, 0);
    for (Eigen::Index v = 0; v < simulation.mesh(0).vertex_count(); ++v) {
        if (simulation.mesh(0).positions(0, v) < 1e-6) {
            side.conservativeResize(Dim, side.cols() + 1);
            side.rightCols(1) = simulation.positions(0).col(v);
        }
    }
    return side;
}

TYPED_TEST(Hold, BeginsWhereVerticesAreThenAndEndsWithThemFree) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Scene scene = falling_box<kDim>();
        scene.solver.integrator = integrator;
        scene.constraints = {left<kDim>(0.05, 0.1)};
        for (const double to : {0.03, 0.05}) {  // motions that are over by then move nothing
            Motion over = still(kDim);
            over.translate[0] = 1;
            over.to = to;
            scene.constraints[0].motion.push_back(over);
        }
        Simulation<kDim> simulation(scene, {cube<kDim>()});
        const std::int64_t all = simulation.mesh(0).vertex_count();
        Positions<kDim> before = left_side(simulation);
        for (int i = 0; i < 15; ++i) {
            ASSERT_TRUE(simulation.step().is_accepted);
            const bool is_held = i >= 5 && i < 10;
            const Positions<kDim> now = left_side(simulation);
            EXPECT_EQ(now == before, is_held) << i;
            EXPECT_EQ(simulation.size().free_vertices, is_held ? all - now.cols() : all) << i;
            before = now;
        }
    }
}

// Until it begins nothing differs from a scene without it.
TYPED_TEST(Hold, ChangesNothingBeforeItBegins) {
    constexpr int kDim = TypeParam::value;
    Scene scene = falling_box<kDim>();
    Simulation<kDim> free(scene, {cube<kDim>()});
    scene.constraints = {left<kDim>(0.05, 0.1)};
    Simulation<kDim> held(scene, {cube<kDim>()});
    for (int i = 0; i < 7; ++i) {
        ASSERT_TRUE(free.step().is_accepted);
        ASSERT_TRUE(held.step().is_accepted);
        EXPECT_EQ(free.positions(0) == held.positions(0), i < 5) << i;
    }
}

// A box that is carried along is let go, and keeps its speed.
TYPED_TEST(Hold, LetsGoWithTheVelocityOfItsMotion) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    scene.frames_per_second = 100;
    scene.solver.integrator = Integrator::NewtonEuler;
    Constraint carry = left<kDim>(0, 0.5);
    carry.select = {EverythingSelection{}};
    carry.motion[0].translate[0] = 2;
    scene.constraints = {carry};
    Simulation<kDim> simulation(scene, {cube<kDim>(1)});
    const double start = simulation.positions(0)(0, 0);
    for (int i = 0; i < 100; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    EXPECT_NEAR(simulation.positions(0)(0, 0) - start, 2, 1e-6);
}

// At the end of a step their velocity is that of the step: also where one motion follows another,
// or waits to begin, and for what is let go where the next one would begin.
TYPED_TEST(Hold, HasTheVelocityOfTheStepFromOneMotionToTheNext) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Scene scene = test::box_scene<kDim>();
        scene.frames_per_second = 30;
        scene.solver.integrator = integrator;
        Constraint carry = left<kDim>(0, 20. / 30);
        carry.select = {EverythingSelection{}};
        carry.motion.clear();
        for (int i = 1; i < 20; i += 3) {  // there for three steps, and a step on, and so on
            Motion motion = still(kDim);
            motion.translate[i % kDim] = i;
            motion.from = i / 30.0;
            motion.to = (i + 3) / 30.0;
            carry.motion.push_back(motion);
        }
        carry.motion.back().to = 20. / 30;
        Motion next = still(kDim);
        next.translate[0] = -5;
        next.from = 20. / 30;
        carry.motion.push_back(next);
        scene.constraints = {carry};
        Simulation<kDim> simulation(scene, {cube<kDim>(1)});
        for (int i = 0; i < 25; ++i) {
            const Positions<kDim> before = simulation.positions(0);
            ASSERT_TRUE(simulation.step().is_accepted);
            const Positions<kDim> moved = simulation.positions(0) - before;
            // Rounding of places below 4 m over a step; the tolerance of the solver once it flies.
            EXPECT_LT((30 * moved - simulation.velocities(0)).cwiseAbs().maxCoeff(),
                      i < 20 ? 1e-12 : 1e-6)
                << i;
            if (i >= 20) {
                EXPECT_NEAR(simulation.velocities(0)(19 % kDim, 0), 19, 1e-6) << i;
            }
        }
    }
}

// A motion goes on from where the vertices are, however late it is asked for.
TYPED_TEST(Hold, BeginsItsMotionNoSoonerThanItself) {
    constexpr int kDim = TypeParam::value;
    Scene scene = falling_box<kDim>();
    Constraint carry = left<kDim>(0.05, 1);
    carry.select = {EverythingSelection{}};
    carry.motion[0].translate[0] = 2;
    carry.motion[0].rotate = {{.plane = {0, kDim - 1}, .degrees_per_s = 360}};
    scene.constraints = {carry};
    Simulation<kDim> simulation(scene, {cube<kDim>(1)});
    for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    const Positions<kDim> before = simulation.positions(0);
    const Eigen::Matrix<double, kDim, 1> middle = before.rowwise().mean();
    ASSERT_TRUE(simulation.step().is_accepted);
    const Eigen::Matrix<double, kDim, 1> ahead = simulation.positions(0).rowwise().mean() - middle;
    EXPECT_NEAR(ahead[0], 0.02, 1e-12);
    EXPECT_LT(ahead.tail(kDim - 1).norm(), 1e-12);
    // A hundredth of a turn, about the middle: each goes 2 r sin(1.8 degrees).
    const Positions<kDim> arms = before.colwise() - middle;
    const Eigen::Matrix<double, kDim, 1> now = middle + ahead;
    const Positions<kDim> turned = simulation.positions(0).colwise() - now;
    const double radius = std::hypot(arms(0, 0), arms(kDim - 1, 0));
    EXPECT_NEAR((turned - arms).col(0).norm(), 2 * radius * std::sin(std::numbers::pi / 100),
                1e-12);
}

TYPED_TEST(Hold, GoesOnToTheBitFromEverySavedState) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Scene scene = falling_box<kDim>();
        scene.solver.integrator = integrator;
        scene.obstacles = {{.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(kDim, 1),
                                                       .offset = -0.05}}};
        scene.constraints = {left<kDim>(0.03, 0.06), left<kDim>(0.08, 0.1), left<kDim>(0, 0.02)};
        scene.constraints[0].motion[0].translate[0] = 1;
        Simulation<kDim> whole(scene, {cube<kDim>()}, {.threads = 3});
        Simulation<kDim> often(scene, {cube<kDim>()});
        for (int i = 0; i < 14; ++i) {
            ASSERT_TRUE(whole.step().is_accepted);
            ASSERT_TRUE(often.step().is_accepted);
            ASSERT_EQ(whole.positions(0), often.positions(0)) << i;
            ASSERT_EQ(whole.velocities(0), often.velocities(0)) << i;
            Simulation<kDim> next(scene, {cube<kDim>()});
            next.restore(often.save());
            EXPECT_EQ(next.size().free_vertices, often.size().free_vertices) << i;
            EXPECT_EQ(next.forces(0), often.forces(0)) << i;
            often = std::move(next);
        }
    }
}

// The step in which it begins is refused, and a host puts the body elsewhere before it tries again.
TYPED_TEST(Hold, BeginsWhereVerticesAreWhenItsStepIsTriedAgain) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Scene scene = falling_box<kDim>();
        scene.solver.integrator = integrator;
        scene.solver.max_halvings = 0;
        scene.constraints = {left<kDim>(0.03, 0.06)};
        Simulation<kDim> simulation(scene, {cube<kDim>()});
        for (int i = 0; i < 3; ++i) {
            ASSERT_TRUE(simulation.step().is_accepted);
        }
        Positions<kDim> positions = simulation.positions(0);
        Positions<kDim> velocities = Positions<kDim>::Zero(kDim, positions.cols());
        velocities.rightCols(1).setConstant(1e7);  // far beyond all bounds
        simulation.set_state(0, positions, velocities);
        ASSERT_FALSE(simulation.step().is_accepted);
        positions.row(1).array() += 0.3;
        simulation.set_state(0, positions, Positions<kDim>::Zero(kDim, positions.cols()));
        const Positions<kDim> before = left_side(simulation);
        for (int i = 0; i < 3; ++i) {
            ASSERT_TRUE(simulation.step().is_accepted);
            EXPECT_EQ(left_side(simulation), before) << i;
        }
    }
}

TYPED_TEST(Hold, WakesWhatSleepsWhereItIsLetGo) {
    constexpr int kDim = TypeParam::value;
    Scene scene = falling_box<kDim>();
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.05};
    scene.constraints = {left<kDim>(0, 0.2)};
    scene.constraints[0].select = {EverythingSelection{}};
    Simulation<kDim> simulation(scene, {cube<kDim>(1)});
    const Positions<kDim> start = simulation.positions(0);
    for (int i = 0; i < 25; ++i) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted);
        EXPECT_EQ(report.asleep, i >= 4 && i < 20 ? 1 : 0) << i;
        EXPECT_EQ(simulation.positions(0) == start, i < 20) << i;
    }
}

// Under a barrier and with penalties: a block that is held above another comes down when it is let
// go, and rests upon it.
TYPED_TEST(Hold, GoesTogetherWithContact) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        Scene scene = test::two_cubes<kDim>(0.02);
        scene.gravity[1] = -9.8;
        scene.contact->model = model;
        scene.contact->friction = 0.3;
        scene.solver.integrator = Integrator::NewtonEuler;
        scene.constraints = {
            {.body = "a", .select = {EverythingSelection{}}, .motion = {}},
            {.body = "b", .select = {EverythingSelection{}}, .motion = {}, .to = 0.1}};
        Simulation<kDim> simulation(scene, {cube<kDim>(1), cube<kDim>(1)});
        for (int i = 0; i < 60; ++i) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            EXPECT_EQ(report.unknowns > 0, i >= 10) << i;
        }
        const double lowest = simulation.positions(1).row(1).minCoeff();
        EXPECT_GT(lowest, model == ContactModel::Barrier ? 0.25 : 0.2);
        EXPECT_LT(lowest, 0.5);
    }
}

TEST(Holds, OfOneVertexAtOneTimeAreRefused) {
    Scene scene = falling_box<3>();
    scene.constraints = {left<3>(0, 0.1), left<3>(0.1, 0.2)};
    EXPECT_NO_THROW(Simulation<3>(scene, {cube<3>()}));
    scene.constraints[1].from = 0.09;
    pent::test::expect_contains(
        pent::test::error_of([&] { Simulation<3>(scene, {cube<3>()}); }),
        {"vertex", "held by two constraints at one time", "let one end before the other begins"});
    // Of the second body, whose vertices are counted from its own first.
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = "other";
    for (Constraint& constraint : scene.constraints) {
        constraint.body = "other";
    }
    pent::test::expect_contains(pent::test::error_of([&] {
                                    Simulation<3>(scene, {cube<3>(), cube<3>()});
                                }),
                                {"vertex 0 of body \"other\" is held by two constraints"});
}

// Also where no step begins while both hold: other steps make no other scene of it.
TYPED_TEST(Hold, OfOneVertexByTwoIsJudgedByTimesWhateverTheSteps) {
    constexpr int kDim = TypeParam::value;
    Scene scene = falling_box<kDim>();
    const auto expect_refused = [&](const Constraint& first, const Constraint& second) {
        scene.constraints = {first, second};
        scene.constraints[0].source = "one:1:1";
        scene.constraints[1].source = "two:2:2";
        pent::test::expect_contains(
            pent::test::error_of([&] { Simulation<kDim>(scene, {cube<kDim>()}); }),
            {"two:2:2: vertex", "at one time, this one and that at one:1:1; make"});
    };
    for (const double rate : {1.0, 30.0, 300.0, 1e5}) {
        scene.frames_per_second = rate;
        expect_refused(left<kDim>(0, 0.04), left<kDim>(0.035, 2));
        expect_refused(left<kDim>(0.035, 2), left<kDim>(0, 0.04));
        expect_refused(left<kDim>(0, 2), left<kDim>(0.03, 0.031));
        // But for rounding one ends where the other begins.
        for (const double other : {0.3, 0.1 + 0.2, std::nextafter(0.3, 0.0)}) {
            scene.constraints = {left<kDim>(0, 0.1 + 0.2), left<kDim>(other, 2)};
            EXPECT_NO_THROW(Simulation<kDim>(scene, {cube<kDim>()})) << rate << ", " << other;
            std::swap(scene.constraints[0], scene.constraints[1]);
            EXPECT_NO_THROW(Simulation<kDim>(scene, {cube<kDim>()})) << rate << ", " << other;
        }
    }
}

TEST(Holds, ThatDoNotLastAreNoneForStatics) {
    Scene scene = falling_box<3>();
    scene.solver.integrator = Integrator::Quasistatic;
    scene.constraints = {left<3>(0, 1)};
    pent::test::expect_contains(pent::test::error_of([&] { check(scene); }),
                                {"box", "no constraint that lasts"});
}

// Carried along a curve and let go at its last keyframe, which has a velocity: a throw. A box held
// everywhere is thrown as it is, and falls from there on as any free body.
TYPED_TEST(Hold, ThrowsWhatItLetsGoAtAKeyframeWithAVelocity) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Scene scene = falling_box<kDim>();
        scene.solver.integrator = integrator;
        const Eigen::VectorXd velocity = Eigen::VectorXd::LinSpaced(kDim, 1, 2);
        const Eigen::VectorXd there = 0.05 * Eigen::VectorXd::Unit(kDim, kDim - 1);
        Motion carry = still(kDim);
        carry.keyframes = {
            {.time = 0.1, .translate = there, .rotate = {}, .velocity = velocity, .spin = {}}};
        scene.constraints = {test::hold(EverythingSelection{}, carry)};
        scene.constraints[0].to = 0.1;
        Simulation<kDim> simulation(scene, {cube<kDim>()});
        for (int i = 0; i < 10; ++i) {
            ASSERT_TRUE(simulation.step().is_accepted);
        }
        const Positions<kDim> start = simulation.mesh(0).positions;
        EXPECT_LT((simulation.positions(0) - (start.colwise() + Vector<kDim>(there))).norm(),
                  1e-12);
        EXPECT_LT((simulation.velocities(0).colwise() - Vector<kDim>(velocity)).norm(), 1e-11);
        ASSERT_TRUE(simulation.step().is_accepted);
        const Eigen::VectorXd later = velocity + 0.01 * scene.gravity;
        EXPECT_LT((test::mean_velocity<kDim>(simulation, 0) - Vector<kDim>(later)).norm(), 1e-4);
    }
}

}  // namespace
}  // namespace pent::simulator
