#include "contact_scenes.h"
#include "support/messages.h"

#include <pent/contact/obstacles.h>
#include <pent/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

// Obstacles that move, and what they push and carry.

namespace pent::simulator {
namespace {

using test::cube;
using test::mean_velocity;
using test::still;

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class MovingObstacle : public testing::Test {};
TYPED_TEST_SUITE(MovingObstacle, Dimensions);

constexpr ContactModel kModels[] = {ContactModel::Penalty, ContactModel::Barrier};

// A cube of one cell that rests on a floor whose top is a little below it.
template <int Dim>
Scene cube_on_floor(ContactModel model) {
    Scene scene = test::box_scene<Dim>();
    scene.frames_per_second = 100;
    scene.gravity[1] = -9.8;
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(Dim, 1), .offset = -0.01},
         .distance = 0.02,
         .stiffness = 2e4,
         .motion = {still(Dim)}}};
    scene.contact = ContactSettings{.model = model, .distance = 0.02, .stiffness = 2e4};
    return scene;
}

template <int Dim>
double gap(const Simulation<Dim>& simulation, std::size_t obstacle) {
    const Positions<Dim> x = simulation.positions(0);
    double least = 1e9;
    for (Eigen::Index v = 0; v < x.cols(); ++v) {
        least = std::min(
            least, contact::signed_distance<Dim>(simulation.obstacles()[obstacle], x.col(v)).value);
    }
    return least;
}

TYPED_TEST(MovingObstacle, CarriesWhatLiesOnItByFriction) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : kModels) {
        for (const Integrator integrator : {Integrator::LinearEuler, Integrator::NewtonEuler}) {
            if (model == ContactModel::Barrier && integrator == Integrator::LinearEuler) {
                continue;
            }
            Scene scene = cube_on_floor<kDim>(model);
            scene.solver.integrator = integrator;
            scene.contact->friction = 0.5;
            scene.damping = Damping{.mass = 0, .stiffness = 0.02};  // it is not to rock for long
            scene.obstacles[0].motion[0].translate[0] = 0.5;        // a belt
            Simulation<kDim> simulation(scene, {cube<kDim>(1)});
            for (int i = 0; i < 100; ++i) {
                const StepReport report = simulation.step();
                ASSERT_TRUE(report.is_accepted) << report.failure;
            }
            // Reached after 0.5 / (0.5 9.8) = 0.1 s.
            EXPECT_NEAR(mean_velocity<kDim>(simulation, 0)[0], 0.5, 0.01) << int(integrator);
        }
    }
}

// A state does not say how far things have slipped: restored it has no friction, on belts neither.
TYPED_TEST(MovingObstacle, HasNoFrictionInARestoredState) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : kModels) {
        Scene scene = cube_on_floor<kDim>(model);
        scene.contact->friction = 0.5;
        scene.obstacles[0].motion[0].translate[0] = 0.5;
        Simulation<kDim> simulation(scene, {cube<kDim>(1)});
        for (int i = 0; i < 5; ++i) {
            ASSERT_TRUE(simulation.step().is_accepted);
        }
        ASSERT_GT(simulation.contact_forces(0).row(0).norm(), 0);
        Simulation<kDim> other(scene, {cube<kDim>(1)});
        other.restore(simulation.save());
        EXPECT_GT(other.contact_forces(0).row(1).norm(), 0);
        EXPECT_EQ(other.contact_forces(0).row(0).norm(), 0);
        EXPECT_EQ(other.energies().of("friction"), 0);
        ASSERT_TRUE(simulation.step().is_accepted);
        ASSERT_TRUE(other.step().is_accepted);
        EXPECT_EQ(other.positions(0), simulation.positions(0));
    }
}

// In a lift that goes up or down at constant speed a belt gets as hold of a body as in one at rest.
TYPED_TEST(MovingObstacle, HasTheFrictionOfTheWeightHoweverFastItRises) {
    constexpr int kDim = TypeParam::value;
    constexpr double kFriction = 0.2;
    for (const ContactModel model : kModels) {
        for (const Integrator integrator :
             {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
            if (model == ContactModel::Barrier && integrator == Integrator::LinearEuler) {
                continue;
            }
            for (const double rise : {0.0, 0.2, -0.2}) {
                Scene scene = cube_on_floor<kDim>(model);
                scene.solver.integrator = integrator;
                scene.contact->friction = kFriction;
                scene.damping = Damping{.mass = 0, .stiffness = 0.02};
                scene.bodies[0].velocity = rise * Eigen::VectorXd::Unit(kDim, 1);
                Motion belt = still(kDim);
                scene.obstacles[0].motion[0].translate[1] = rise;
                belt.translate[0] = 5;
                belt.from = 0.5;
                scene.obstacles[0].motion.push_back(belt);
                Simulation<kDim> simulation(scene, {cube<kDim>(1)});
                for (int i = 0; i < 80; ++i) {
                    const StepReport report = simulation.step();
                    ASSERT_TRUE(report.is_accepted) << report.failure;
                }
                // But for what is left of rocking when the belt starts to pull at its underside.
                const double gained = kFriction * 9.8 * 0.3;
                EXPECT_NEAR(mean_velocity<kDim>(simulation, 0)[0], gained, 0.03 * gained)
                    << int(model) << " " << int(integrator) << " " << rise;
            }
        }
    }
}

// Who goes along with the floor sees no difference: body and floor are looked at at one time, and
// both move in the step. Else a body that lies on a floor that sinks would fall behind it.
TYPED_TEST(MovingObstacle, IsTheSameToALinearStepAsOneAtRestHoweverFastItGoes) {
    constexpr int kDim = TypeParam::value;
    const auto make = [](const Eigen::VectorXd& velocity) {
        Scene scene = cube_on_floor<kDim>(ContactModel::Penalty);
        scene.solver.integrator = Integrator::LinearEuler;
        scene.solver.precision = Precision::Double;
        scene.solver.tolerance = 1e-12;
        scene.contact->friction = 0.2;
        scene.bodies[0].velocity = velocity;
        scene.obstacles[0].motion[0].translate = velocity;
        return Simulation<kDim>(scene, {cube<kDim>(1)});
    };
    for (const double rise : {0.5, -0.5, -2.0}) {
        Eigen::VectorXd velocity = Eigen::VectorXd::Zero(kDim);
        velocity[0] = 0.3;
        velocity[1] = rise;
        Simulation<kDim> at_rest = make(Eigen::VectorXd::Zero(kDim));
        Simulation<kDim> moving = make(velocity);
        for (int i = 0; i < 60; ++i) {
            ASSERT_TRUE(at_rest.step().is_accepted);
            ASSERT_TRUE(moving.step().is_accepted);
            const Positions<kDim> seen = moving.positions(0).colwise() - moving.time() * velocity;
            // Of the tolerance of the solver, of steps of 2 cm, what adds up.
            ASSERT_LT((seen - at_rest.positions(0)).cwiseAbs().maxCoeff(), 1e-11) << i;
        }
        const double weight = 9.8 * moving.masses(0).sum();
        EXPECT_NEAR(moving.contact_forces(0).row(1).sum(), weight, 1e-3 * weight) << rise;
    }
}

TYPED_TEST(MovingObstacle, LiftsWhatLiesOnItAndNothingCrosses) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : kModels) {
        Scene scene = cube_on_floor<kDim>(model);
        scene.damping = Damping{.mass = 0, .stiffness = 0.01};
        scene.obstacles[0].motion[0].translate[1] = 0.3;
        Simulation<kDim> simulation(scene, {cube<kDim>(1)});
        for (int i = 0; i < 80; ++i) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            if (model == ContactModel::Barrier) {
                EXPECT_GT(gap<kDim>(simulation, 0), 0) << i;
            }
        }
        EXPECT_NEAR(mean_velocity<kDim>(simulation, 0)[1], 0.3, 0.05);
        EXPECT_NEAR(std::get<HalfSpace<kDim>>(simulation.obstacles()[0]).offset,
                    -0.01 + 0.3 * simulation.time(), 1e-12);
    }
}

// A ball comes from the side and pushes the cube away; under a barrier it never is in it. It is so
// large that penalties, which know vertices alone, do not let it in between them.
TYPED_TEST(MovingObstacle, PushesWhatIsInItsWay) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : kModels) {
        Scene scene = cube_on_floor<kDim>(model);
        scene.gravity.setZero();
        Eigen::VectorXd center = Eigen::VectorXd::Constant(kDim, 0.125);
        center[0] = -0.65;
        scene.obstacles[0].shape = BallObstacle{.center = center, .radius = 0.6};
        scene.obstacles[0].motion[0].translate[0] = 1;
        Simulation<kDim> simulation(scene, {cube<kDim>(1)});
        for (int i = 0; i < 40; ++i) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            EXPECT_GT(gap<kDim>(simulation, 0), model == ContactModel::Barrier ? 0 : -0.05) << i;
        }
        EXPECT_GT(mean_velocity<kDim>(simulation, 0)[0], 0.8);
    }
}

TYPED_TEST(MovingObstacle, GoesOnToTheBitFromEverySavedState) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : kModels) {
        Scene scene = cube_on_floor<kDim>(model);
        scene.contact->friction = 0.5;
        scene.solver.integrator = Integrator::Bdf2;
        scene.obstacles[0].motion[0].translate[1] = 0.2;
        scene.obstacles[0].motion[0].rotate = {{.plane = {0, 1}, .degrees_per_s = 20}};
        scene.obstacles.push_back(scene.obstacles[0]);
        Eigen::VectorXd center = Eigen::VectorXd::Constant(kDim, 0.125);
        center[0] = -0.25;
        scene.obstacles[1].shape = BallObstacle{.center = center, .radius = 0.2};
        scene.obstacles[1].motion[0].translate[0] = 0.5;
        scene.obstacles.push_back(scene.obstacles[0]);
        center.setConstant(0.125);
        center[1] = -0.35;
        scene.obstacles[2].shape =
            BoxObstacle{.center = center, .sides = Eigen::VectorXd::Constant(kDim, 0.5)};
        scene.obstacles[2].rotate = {{.plane = {1, kDim - 1}, .degrees = 15}};
        Simulation<kDim> whole(scene, {cube<kDim>(1)}, {.threads = 3});
        Simulation<kDim> often(scene, {cube<kDim>(1)});
        for (int i = 0; i < 15; ++i) {
            ASSERT_TRUE(whole.step().is_accepted);
            ASSERT_TRUE(often.step().is_accepted);
            ASSERT_EQ(whole.positions(0), often.positions(0)) << i;
            Simulation<kDim> next(scene, {cube<kDim>(1)});
            next.restore(often.save());
            often = std::move(next);
        }
    }
}

TYPED_TEST(MovingObstacle, WakesWhatSleepsOnIt) {
    constexpr int kDim = TypeParam::value;
    Scene scene = cube_on_floor<kDim>(ContactModel::Penalty);
    scene.damping = Damping{.mass = 5, .stiffness = 0.01};
    scene.contact->friction = 0.5;
    scene.sleep = Sleep{.speed = 0.01, .time = 0.05};
    scene.obstacles[0].motion[0].translate[0] = 0.2;
    scene.obstacles[0].motion[0].from = 2;
    scene.obstacles[0].motion[0].to = 2.1;
    Simulation<kDim> simulation(scene, {cube<kDim>(1)});
    const auto asleep_at = [&](double time) {
        StepReport report;
        while (simulation.time() < time - 1e-9) {
            report = simulation.step();
            EXPECT_TRUE(report.is_accepted);
        }
        return report.asleep;
    };
    EXPECT_EQ(asleep_at(2), 1);
    EXPECT_EQ(asleep_at(2.1), 0);
    EXPECT_GT(mean_velocity<kDim>(simulation, 0)[0], 0.05);
    EXPECT_EQ(asleep_at(4), 1);
}

TEST(MovingObstacles, ThatGoTooFarInAStepOfABarrierAreReportedAndCutTheStep) {
    Scene scene = cube_on_floor<3>(ContactModel::Barrier);
    scene.obstacles[0].motion[0].translate[1] = 3;  // 3 cm a step, of a gap of 1 cm
    scene.solver.max_halvings = 0;
    Simulation<3> simulation(scene, {cube<3>(1)});
    const StepReport report = simulation.step();
    EXPECT_FALSE(report.is_accepted);
    pent::test::expect_contains(report.failure, {"an obstacle moves so far in a step that vertex",
                                                 "of 'box' is inside obstacle 1", "slowly"});
    scene.solver.max_halvings = 6;
    Simulation<3> cut(scene, {cube<3>(1)});
    const StepReport accepted = cut.step();
    EXPECT_TRUE(accepted.is_accepted) << accepted.failure;
    EXPECT_GT(accepted.substeps, 1);
    EXPECT_GT(gap<3>(cut, 0), 0);
}

// What is held for a while is let go again, and must not be inside an obstacle then; what is held
// for good may go anywhere, as may obstacles through it. Surfaces of obstacles (a half-space) and
// cores (a ball) are looked at by different code.
TYPED_TEST(MovingObstacle, DoesNotMeetWhatIsHeldForGoodAndIsStoppedByWhatIsHeldForAWhile) {
    constexpr int kDim = TypeParam::value;
    const Eigen::VectorXd up = Eigen::VectorXd::Unit(kDim, 1);
    const auto failure = [&](bool is_core, bool does_obstacle_move, double until) {
        Scene scene = cube_on_floor<kDim>(ContactModel::Barrier);
        scene.solver.max_halvings = 3;
        if (is_core) {
            Eigen::VectorXd center = Eigen::VectorXd::Constant(kDim, 0.125);  // below the middle
            center[1] = -0.51;
            scene.obstacles[0].shape = BallObstacle{.center = center, .radius = 0.5};
        }
        Motion motion = still(kDim);
        motion.translate = (does_obstacle_move ? 3 : -3) * up;  // 3 cm a step, of a gap of 1 cm
        scene.constraints = {test::hold(HalfSpaceSelection{-up, 100}, still(kDim))};
        scene.constraints[0].to = until;
        (does_obstacle_move ? scene.obstacles[0].motion[0] : scene.constraints[0].motion[0]) =
            motion;
        Simulation<kDim> simulation(scene, {cube<kDim>(1)});
        for (int k = 0; k < 4; ++k) {
            const StepReport report = simulation.step();
            if (!report.is_accepted) {
                return report.failure;
            }
        }
        return std::string();
    };
    for (const bool is_core : {false, true}) {
        for (const bool does_obstacle_move : {false, true}) {
            EXPECT_EQ(failure(is_core, does_obstacle_move, std::numeric_limits<double>::infinity()),
                      "");
            EXPECT_NE(failure(is_core, does_obstacle_move, 1)
                          .find(does_obstacle_move ? "an obstacle moves so far in a step"
                                                   : "held vertices cannot go on"),
                      std::string::npos)
                << is_core << failure(is_core, does_obstacle_move, 1);
        }
    }
}

// A board below the cube tilts and takes it along on its rising side.
TYPED_TEST(MovingObstacle, ThatIsABoxTurnsAndLiftsWhatLiesOnIt) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : kModels) {
        Scene scene = cube_on_floor<kDim>(model);
        Eigen::VectorXd center = Eigen::VectorXd::Zero(kDim);
        center[1] = -0.21;
        Eigen::VectorXd sides = Eigen::VectorXd::Constant(kDim, 2);
        sides[1] = 0.4;
        scene.obstacles[0].shape = BoxObstacle{.center = center, .sides = sides};
        scene.obstacles[0].motion[0].rotate = {{.plane = {0, 1}, .degrees_per_s = 40}};
        Simulation<kDim> simulation(scene, {cube<kDim>(1)}, {.threads = 2});
        const auto height = [&] { return simulation.positions(0).row(1).mean(); };
        const double before = height();
        for (int i = 0; i < 50; ++i) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            EXPECT_GT(gap<kDim>(simulation, 0), model == ContactModel::Barrier ? 0 : -0.02) << i;
        }
        EXPECT_GT(height(), before + 0.01);
        // The same board, put there.
        Scene standing = scene;
        standing.obstacles[0].motion = {};
        standing.contact->model = ContactModel::Penalty;  // it is in the cube
        standing.obstacles[0].rotate = {{.plane = {0, 1}, .degrees = 20}};
        const Simulation<kDim> other(standing, {cube<kDim>(1)});
        const auto turned = std::get<Cuboid<kDim>>(simulation.obstacles()[0]);
        const auto put = std::get<Cuboid<kDim>>(other.obstacles()[0]);
        EXPECT_LT((turned.axes - put.axes).norm(), 1e-13);
        EXPECT_LT((turned.center - put.center).norm(), 1e-13);
        EXPECT_NEAR(turned.axes(1, 0), std::sin(std::numbers::pi / 9), 1e-13);
    }
}

}  // namespace
}  // namespace pent::simulator
