#include "contact_scenes.h"
#include "support/messages.h"

#include <pent/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

// Bodies that are tied, in motion.

namespace pent::simulator {
namespace {

using test::cube;
using test::mean_velocity;
using test::momentum;
using test::still;

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class AttachmentMotion : public testing::Test {};
TYPED_TEST_SUITE(AttachmentMotion, Dimensions);

constexpr Integrator kWithInertia[] = {Integrator::LinearEuler, Integrator::NewtonEuler,
                                       Integrator::Bdf2};

// Solved so tightly that only the integrator is in the result.
void solve_tightly(Scene& scene) {
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-12;
    scene.solver.newton_tolerance = 1e-9;
}

// Cubes "a" and "b" of one cell in the same place that do not see each other; all of a is tied to
// b, each vertex to the one where it is.
template <int Dim>
Scene twins(double stiffness) {
    Scene scene = test::two_cubes<Dim>(0);
    scene.contact.reset();
    scene.bodies[1].place.translate.setZero();
    solve_tightly(scene);
    Attachment tie;
    tie.body = "a";
    tie.select = {EverythingSelection{}};
    tie.target = "b";
    tie.stiffness = stiffness;
    scene.attachments = {tie};
    return scene;
}

template <int Dim>
Simulation<Dim> start(const Scene& scene, int threads = 1) {
    return Simulation<Dim>(scene, {cube<Dim>(1), cube<Dim>(1)}, {.threads = threads});
}

template <int Dim>
double mass(const Simulation<Dim>& simulation, int body) {
    return simulation.masses(body).sum();
}

// How far a is ahead of b, along x, m.
template <int Dim>
double lead(const Simulation<Dim>& simulation) {
    const auto center = [&](int body) {
        return simulation.positions(body).row(0).dot(simulation.masses(body))
               / mass<Dim>(simulation, body);
    };
    return center(0) - center(1);
}

// What is said of forces is that of the stretch, in motion too, as of a state that is restored:
// what is damped is of the step. Elastic forces have no sum.
TYPED_TEST(AttachmentMotion, HasForcesWithoutDampingBetweenSteps) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Scene scene = twins<kDim>(50);
        scene.solver.integrator = integrator;
        scene.attachments[0].damping = 5;
        scene.bodies[0].velocity = Eigen::VectorXd::Unit(kDim, 0);
        Simulation<kDim> simulation = start<kDim>(scene);
        for (int i = 0; i < 3; ++i) {
            ASSERT_TRUE(simulation.step().is_accepted);
        }
        const Positions<kDim> forces = simulation.forces(0);
        const Eigen::Matrix<double, kDim, 1> pull =
            50 * (simulation.positions(1) - simulation.positions(0)).rowwise().sum();
        EXPECT_GT(pull.norm(), 1);
        EXPECT_LT((forces.rowwise().sum() - pull).norm(), 1e-9 * pull.norm());
        EXPECT_EQ(simulation.energies().of("attachment damping"), 0);
        Simulation<kDim> other = start<kDim>(scene);
        other.restore(simulation.save());
        EXPECT_EQ(other.forces(0), forces);
    }
}

// A damper knows how fast its anchor goes: as fast where one motion goes on with another as in one
// motion, and nothing of one that begins where the step ends.
TYPED_TEST(AttachmentMotion, OfWhichOneGoesOnWithTheOtherIsThatOfBothInOne) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Scene scene = test::box_scene<kDim>();
        scene.frames_per_second = 30;
        scene.solver.integrator = integrator;
        solve_tightly(scene);
        Attachment tie;
        tie.body = "box";
        tie.select = {EverythingSelection{}};
        tie.stiffness = 50;
        tie.damping = 20;
        Motion pull = still(kDim);
        pull.translate = Eigen::VectorXd::LinSpaced(kDim, 0.7, -0.4);
        pull.from = 2 / 30.0;
        tie.motion = {pull};
        scene.attachments = {tie};
        Simulation<kDim> whole(scene, {cube<kDim>(1)});
        std::vector<Motion>& parts = scene.attachments[0].motion;
        parts.clear();
        for (int i = 2; i < 20; i += 3) {
            pull.from = i / 30.0;
            pull.to = (i + 3) / 30.0;
            parts.push_back(pull);
        }
        Simulation<kDim> in_parts(scene, {cube<kDim>(1)});
        const Positions<kDim> start = whole.positions(0);
        for (int i = 0; i < 20; ++i) {
            ASSERT_TRUE(whole.step().is_accepted);
            ASSERT_TRUE(in_parts.step().is_accepted);
            // Of rounded sums of the motions, and of the tolerance of the solver.
            EXPECT_LT((whole.positions(0) - in_parts.positions(0)).cwiseAbs().maxCoeff(), 1e-10)
                << i;
            EXPECT_EQ(whole.positions(0) == start, i < 2) << i;
        }
    }
}

// Two masses on springs of N k in all: x = v / omega e^(-gamma t) sin(omega t) with
// omega_0^2 = N k / mu, mu = m1 m2 / (m1 + m2), gamma = N c / (2 mu), omega^2 = omega_0^2 -
// gamma^2.
// 200 steps a period of BDF2 are (omega h)^2 / 3 = 0.03% off in a turn of phase; the bodies are so
// stiff that they give a thousandth.
template <int Dim>
void expect_two_masses(double damping_ratio) {
    Scene scene = twins<Dim>(50);
    scene.solver.integrator = Integrator::Bdf2;
    for (Body& body : scene.bodies) {
        body.material.lame = lame_from_young(Dim, 1e8, 0.28);
    }
    scene.bodies[1].material.density = 3000;
    scene.bodies[0].velocity = Eigen::VectorXd::Unit(Dim, 0);
    const auto springs = static_cast<double>(1 << Dim);
    Simulation<Dim> probe = start<Dim>(scene);
    const double m1 = mass<Dim>(probe, 0);
    const double m2 = mass<Dim>(probe, 1);
    const double reduced = m1 * m2 / (m1 + m2);
    const double omega_0 = std::sqrt(springs * 50 / reduced);
    const double gamma = damping_ratio * omega_0;
    const double omega = std::sqrt(omega_0 * omega_0 - gamma * gamma);
    scene.attachments[0].damping = 2 * reduced * gamma / springs;
    scene.frames_per_second = 200 * omega_0 / (2 * std::numbers::pi);
    Simulation<Dim> simulation = start<Dim>(scene);
    for (int i = 0; i < 200; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
        const double t = simulation.time();
        const double expected = std::exp(-gamma * t) * std::sin(omega * t) / omega;
        EXPECT_NEAR(lead(simulation), expected, 0.005 / omega) << t * omega;
    }
}

TYPED_TEST(AttachmentMotion, SwingsLikeTwoMassesOnASpring) {
    expect_two_masses<TypeParam::value>(0);
}

TYPED_TEST(AttachmentMotion, IsDampedLikeTwoMassesOnADampedSpring) {
    expect_two_masses<TypeParam::value>(0.1);
}

// L = sum of x v^T - v x^T, weighted by mass.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> angular_momentum(const Simulation<Dim>& simulation) {
    Eigen::Matrix<double, Dim, Dim> sum = Eigen::Matrix<double, Dim, Dim>::Zero();
    for (int body = 0; body < simulation.body_count(); ++body) {
        sum += simulation.positions(body) * simulation.masses(body).asDiagonal()
               * simulation.velocities(body).transpose();
    }
    return sum - sum.transpose();
}

// From hardly there to a million times the stiffness of the bodies (young times length^(n - 2)):
// momentum stays, to what the solver leaves; energy never rises; soft ones hardly pull, stiff ones
// hold what they tie together.
TYPED_TEST(AttachmentMotion, IsRightFromAMillionthToAMillionTimesTheStiffnessOfTheBodies) {
    constexpr int kDim = TypeParam::value;
    const double of_body = 1e5 * std::pow(0.25, kDim - 2);
    for (const Integrator integrator : kWithInertia) {
        for (const double factor : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
            Scene scene = twins<kDim>(factor * of_body);
            scene.solver = SolverOptions{.integrator = integrator};  // as people have it
            scene.bodies[0].velocity = 0.3 * Eigen::VectorXd::Unit(kDim, 0);
            Simulation<kDim> simulation = start<kDim>(scene);
            const double energy = simulation.energies().total();
            const auto before = momentum<kDim>(simulation);
            for (int i = 0; i < 20; ++i) {
                const StepReport report = simulation.step();
                ASSERT_TRUE(report.is_accepted) << factor << report.failure;
                // A step leaves a ten-thousandth of its momentum, twice that of its energy; 20
                // steps.
                EXPECT_LE(report.energies.total(), 1.005 * energy) << factor;
            }
            EXPECT_LT((momentum<kDim>(simulation) - before).norm(), 2e-3 * before.norm())
                << factor << ' ' << int(integrator);
            const double speed =
                (mean_velocity<kDim>(simulation, 0) - mean_velocity<kDim>(simulation, 1))[0];
            if (factor == 1e-6) {
                EXPECT_NEAR(speed, 0.3, 0.01);
            }
            if (factor == 1e6) {
                EXPECT_LT(std::abs(lead(simulation)), 1e-5);
            }
        }
    }
}

// Forces without a moment where a step of backward Euler ends leave L = sum of m x v^T - m v x^T
// to the integrator: it changes by h (v_n v_(n+1)^T - v_(n+1) v_n^T) m, whatever pulls. Newton's
// method leaves 1e-9 of the forces.
TYPED_TEST(AttachmentMotion, KeepsMomentumAndAngularMomentumOfTwoBodiesThatPullEachOther) {
    constexpr int kDim = TypeParam::value;
    Scene scene = twins<kDim>(2000);
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.bodies[1].place.translate[1] = 0.1;
    scene.attachments[0].max_distance = 1;
    scene.bodies[0].velocity = Eigen::VectorXd::LinSpaced(kDim, 0.5, -0.3);
    Simulation<kDim> simulation = start<kDim>(scene);
    const auto before = momentum<kDim>(simulation);
    double turned = 0;
    for (int i = 0; i < 20; ++i) {
        const auto moment = angular_momentum<kDim>(simulation);
        const Positions<kDim> v[2] = {simulation.velocities(0), simulation.velocities(1)};
        ASSERT_TRUE(simulation.step().is_accepted);
        Eigen::Matrix<double, kDim, kDim> own = Eigen::Matrix<double, kDim, kDim>::Zero();
        for (int body = 0; body < 2; ++body) {
            own += 0.01 * simulation.velocities(body) * simulation.masses(body).asDiagonal()
                   * v[body].transpose();
        }
        const Eigen::Matrix<double, kDim, kDim> change =
            angular_momentum<kDim>(simulation) - moment;
        EXPECT_LT((change - (own - own.transpose())).norm(), 1e-7 * moment.norm()) << i;
        turned = std::max(turned, change.norm());
    }
    EXPECT_LT((momentum<kDim>(simulation) - before).norm(), 1e-7 * before.norm());
    EXPECT_GT(turned, 0);
}

TYPED_TEST(AttachmentMotion, IsTheSameForAnyNumberOfThreadsAndFromASavedState) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : kWithInertia) {
        Scene scene = twins<kDim>(2000);
        scene.solver.integrator = integrator;
        scene.bodies[0].velocity = Eigen::VectorXd::LinSpaced(kDim, 0.5, -0.3);
        scene.attachments[0].damping = 5;
        scene.attachments[0].break_force = 2;
        scene.attachments[0].select = {
            HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 0), .offset = 0.1}};
        scene.attachments.push_back(scene.attachments[0]);
        scene.attachments[1].break_force = 1e9;
        scene.attachments[1].to = 0.15;
        Simulation<kDim> first = start<kDim>(scene, 1);
        Simulation<kDim> second = start<kDim>(scene, 3);
        std::int64_t broken = 0;
        for (int i = 0; i < 20; ++i) {
            const StepReport report = first.step();
            ASSERT_TRUE(report.is_accepted);
            ASSERT_TRUE(second.step().is_accepted);
            broken = report.attachments[0].broken;
            EXPECT_EQ(first.positions(1), second.positions(1));
            Simulation<kDim> third = start<kDim>(scene, 2);
            third.restore(first.save());
            EXPECT_EQ(third.energies().of("attachment"), first.energies().of("attachment"));
            second = std::move(third);
        }
        EXPECT_GT(broken, 0);  // on the way: what is broken is part of the state
        EXPECT_EQ(first.save().broken_springs.size(), std::size_t{1} << kDim);
    }
}

// One point in space drags a body along until its springs break, one after the other.
TYPED_TEST(AttachmentMotion, BreaksAtItsForceAndLetsGo) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    scene.frames_per_second = 100;
    scene.solver.integrator = Integrator::NewtonEuler;
    Attachment tie;
    tie.body = "box";
    tie.select = {HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 0), .offset = 0.01}};
    tie.motion = {still(kDim)};
    tie.motion[0].translate[0] = -1;
    scene.attachments = {tie};
    // Half of the largest force that they would come to: the anchors run ahead, then the body
    // catches up.
    double limit = 0;
    Simulation<kDim> unbroken(scene, {cube<kDim>(1)});
    for (int i = 0; i < 100; ++i) {
        limit = std::max(limit, 0.5 * unbroken.step().attachments[0].largest_force);
    }
    scene.attachments[0].break_force = limit;
    Simulation<kDim> simulation(scene, {cube<kDim>(1)});
    StepReport report = simulation.step();
    const auto springs = report.attachments[0].springs;
    EXPECT_EQ(springs, 1 << (kDim - 1));
    EXPECT_GT(report.attachments[0].force, 0);
    int steps = 0;
    for (; report.attachments[0].broken < springs && steps < 100; ++steps) {
        // What pulls harder at the end of a step is gone then.
        EXPECT_LE(report.attachments[0].largest_force, limit);
        report = simulation.step();
        ASSERT_TRUE(report.is_accepted);
    }
    ASSERT_LT(steps, 100);
    EXPECT_EQ(report.attachments[0].springs, 0);
    EXPECT_EQ(report.attachments[0].force, 0);
    EXPECT_EQ(report.energies.of("attachment"), 0);
    const auto speed = mean_velocity<kDim>(simulation, 0);
    EXPECT_LT(speed[0], 0);
    ASSERT_TRUE(simulation.step().is_accepted);
    EXPECT_LT((mean_velocity<kDim>(simulation, 0) - speed).norm(), 1e-4 * speed.norm());
}

// In statics an attachment bears the weight: the forces of its springs are those of gravity.
TYPED_TEST(AttachmentMotion, BearsTheWeightOfWhatHangsOnIt) {
    constexpr int kDim = TypeParam::value;
    Scene scene = twins<kDim>(500);
    scene.gravity[1] = -9.8;
    scene.constraints = {{.body = "b", .select = {EverythingSelection{}}, .motion = {}}};
    scene.attachments[0].damping = 300;
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.frames_per_second = 5;
    Simulation<kDim> simulation = start<kDim>(scene);
    StepReport report;
    for (int i = 0; i < 60; ++i) {
        report = simulation.step();
        ASSERT_TRUE(report.is_accepted);
    }
    const double weight = 9.8 * mass<kDim>(simulation, 0);
    EXPECT_NEAR(report.attachments[0].force, weight, 1e-3 * weight);
}

TYPED_TEST(AttachmentMotion, PullsNothingBeforeFromAndFromToOn) {
    constexpr int kDim = TypeParam::value;
    Scene scene = twins<kDim>(2000);
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.bodies[0].velocity = Eigen::VectorXd::LinSpaced(kDim, 0.5, -0.3);
    scene.attachments[0].from = 0.05;
    scene.attachments[0].to = 0.1;
    Scene without = scene;
    without.attachments.clear();
    Simulation<kDim> tied = start<kDim>(scene);
    Simulation<kDim> alone = start<kDim>(without);
    for (int i = 0; i < 15; ++i) {
        const StepReport report = tied.step();
        ASSERT_TRUE(alone.step().is_accepted);
        EXPECT_EQ(tied.positions(0) == alone.positions(0), i < 5) << i;
        EXPECT_EQ(report.attachments[0].springs > 0, i >= 5 && i < 10) << i;
        EXPECT_EQ(report.energies.of("attachment") > 0, i >= 5 && i < 10) << i;
    }
}

TYPED_TEST(AttachmentMotion, LetsBodiesSleepAndWakeTogether) {
    constexpr int kDim = TypeParam::value;
    Scene scene = twins<kDim>(2000);
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.sleep = Sleep{.speed = 1e-3, .time = 0.05};
    Attachment pull;
    pull.body = "b";
    pull.select = {EverythingSelection{}};
    pull.motion = {still(kDim)};
    pull.motion[0].translate[0] = 0.5;
    pull.motion[0].from = 0.2;
    scene.attachments.push_back(pull);
    Simulation<kDim> simulation = start<kDim>(scene);
    int asleep_first = 0;
    for (int i = 0; i < 30; ++i) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted);
        EXPECT_NE(report.asleep, 1) << i;  // both or none
        asleep_first += report.asleep == 2 && i < 20 ? 1 : 0;
        EXPECT_EQ(report.asleep == 0, i < 4 || i >= 20) << i;
    }
    EXPECT_EQ(asleep_first, 16);
    EXPECT_GT(mean_velocity<kDim>(simulation, 0)[0], 0);
}

// What is tied at a distance that is no contact would push; bodies that overlap do not, if asked.
TYPED_TEST(AttachmentMotion, LeavesOutContactBetweenWhatItTiesIfAsked) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        Scene scene = test::two_cubes<kDim>(0.01);
        scene.contact->model = model;
        scene.solver.integrator = Integrator::NewtonEuler;
        Attachment tie;
        tie.body = "b";
        tie.target = "a";
        tie.select = {HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 1), .offset = 0.55}};
        tie.max_distance = 0.1;
        for (const bool contact : {true, false}) {
            tie.contact = contact;
            scene.attachments = {tie};
            Simulation<kDim> simulation(scene, {cube<kDim>(), cube<kDim>()});
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted);
            EXPECT_EQ(report.contact.point_facet > 0, contact);
        }
    }
}

TEST(Attachments, AreNotThereWithoutBeingAskedFor) {
    Scene scene = test::box_scene<4>();
    Simulation<4> simulation(scene, {cube<4>()});
    const StepReport report = simulation.step();
    EXPECT_TRUE(report.attachments.empty());
    for (const TermEnergy& term : report.energies.terms) {
        EXPECT_EQ(std::string(term.name).find("attachment"), std::string::npos);
    }
    EXPECT_TRUE(simulation.save().broken_springs.empty());
}

TEST(Attachments, RefuseASnapshotOfOtherSprings) {
    Simulation<3> simulation = start<3>(twins<3>(100));
    Snapshot<3> snapshot = simulation.save();
    snapshot.broken_springs.pop_back();
    pent::test::expect_contains(pent::test::error_of([&] { simulation.restore(snapshot); }),
                                {"7 springs", "8"});
}

}  // namespace
}  // namespace pent::simulator
