#include "barrier_scenes.h"
#include "support/cut_in_two.h"

#include <pent/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

// The barrier with every integrator that takes it, and with bodies that are moved from outside.

namespace pent::simulator {
namespace {

using test::BarrierScene;
using test::box;
using test::vector;
using test::WatchedRun;

template <typename T>
class BarrierMotionTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(BarrierMotionTest, Dimensions);

template <int Dim>
BarrierScene<Dim> collision(Integrator integrator) {
    BarrierScene<Dim> scene;
    scene.scene.solver.integrator = integrator;
    const Eigen::VectorXd unit = Eigen::VectorXd::Constant(Dim, 0.2);
    scene.add(box<Dim>(1, 1, 1, unit), vector<Dim>(0, 0)).velocity = vector<Dim>(1, 0);
    scene.add(box<Dim>(1, 1, 1, unit), vector<Dim>(0.24, 0.01, 0.02)).velocity = vector<Dim>(-2, 0);
    return scene;
}

template <int Dim>
Eigen::VectorXd momentum(const Simulation<Dim>& simulation) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(Dim);
    for (int body = 0; body < simulation.body_count(); ++body) {
        sum += simulation.velocities(body) * simulation.masses(body);
    }
    return sum;
}

TYPED_TEST(BarrierMotionTest, Bdf2KeepsBodiesApartAndMomentum) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene = collision<kDim>(Integrator::Bdf2);
    scene.scene.solver.newton_tolerance = 1e-8;
    WatchedRun<kDim> run(scene);
    const Eigen::VectorXd before = momentum(run.simulation());
    run.run(12);
    EXPECT_EQ(run.failure(), "");
    EXPECT_EQ(run.crossings(), 0);
    EXPECT_LT(run.smallest_distance(), 0.02);  // they met
    EXPECT_GT(run.simulation().save().previous_positions.cols(), 0);
    // What Newton's method leaves unbalanced in a step is 1e-8 of the momentum in it.
    EXPECT_LT((momentum(run.simulation()) - before).norm(), 1e-5 * before.norm());
}

// What is left of two quadratic cubes in R^4 that meet, one of them sliding along the third axis.
struct Rubbed {
    double sliding = 0;      // Speed of one along the other, m/s.
    double energy_gain = 0;  // The largest of a step, over the energy at the start.
};

Rubbed rub(double friction) {
    BarrierScene<4> scene = collision<4>(Integrator::Bdf2);
    scene.scene.solver.elements = ElementKind::Quadratic;
    scene.scene.solver.newton_tolerance = 1e-8;
    scene.scene.contact->friction = friction;
    scene.scene.bodies[0].velocity = vector<4>(1, 0, 0.5);
    for (SimplexMesh<4>& mesh : scene.meshes) {
        mesh = pent::test::cut_in_two<4>(mesh);
    }
    WatchedRun<4> run(scene);
    const Eigen::VectorXd before = momentum(run.simulation());
    const double start = run.simulation().energies().total();
    Rubbed rubbed;
    for (int k = 0; k < 8; ++k) {
        const double last = run.simulation().energies().total();
        run.run(1);
        rubbed.energy_gain =
            std::max(rubbed.energy_gain, (run.simulation().energies().total() - last) / start);
    }
    EXPECT_EQ(run.failure(), "");
    EXPECT_EQ(run.crossings(), 0);
    EXPECT_LT(run.smallest_distance(), 0.02);  // they met
    EXPECT_LT((momentum(run.simulation()) - before).norm(), 1e-5 * before.norm());
    const auto along = [&](int body) { return run.simulation().velocities(body).row(2).mean(); };
    rubbed.sliding = along(0) - along(1);
    return rubbed;
}

TEST(BarrierMotion, QuadraticBodiesThatRubKeepApartAndMomentumAndOnlyLoseEnergy) {
    const Rubbed smooth = rub(0);
    const Rubbed rough = rub(0.4);
    // The faces that meet are parallel: without friction nothing stops what slides along them. With
    // it they stick, and spring back a little.
    EXPECT_NEAR(smooth.sliding, 0.5, 0.05);
    EXPECT_LT(std::abs(rough.sliding), 0.2 * smooth.sliding);
    EXPECT_LE(rough.energy_gain, 1e-6);
    EXPECT_LE(smooth.energy_gain, 1e-6);
}

TYPED_TEST(BarrierMotionTest, QuasistaticBlocksPressedTogetherAreInBalance) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    scene.scene.solver.integrator = Integrator::Quasistatic;
    scene.scene.solver.newton_tolerance = 1e-6;
    const Eigen::VectorXd everywhere = vector<kDim>(9, 9, 9);
    const Eigen::VectorXd size = vector<kDim>(0.2, 0.2, 0.2);
    scene.add(box<kDim>(1, 2, 1, size), vector<kDim>(0, 0));
    scene.hold(-everywhere, vector<kDim>(9, -0.09, 9), vector<kDim>(0, 0));
    scene.add(box<kDim>(1, 2, 1, size), vector<kDim>(0.03, 0.23, 0.02));
    scene.hold(vector<kDim>(-9, 0.32, -9), everywhere, vector<kDim>(0, -1));
    WatchedRun<kDim> run(scene);
    run.run(6);  // 0.06 m down, twice the gap
    EXPECT_EQ(run.failure(), "");
    EXPECT_EQ(run.crossings(), 0);
    EXPECT_LT(run.smallest_distance(), 0.02);
    // All forces on what is free add up to nothing, next to what the bodies press each other with.
    double pressed = 0;
    double left = 0;
    for (int body = 0; body < 2; ++body) {
        pressed += run.simulation().contact_forces(body).rowwise().sum().norm() / 2;
        const auto rest = run.simulation().mesh(body).positions;
        for (Eigen::Index v = 0; v < rest.cols(); ++v) {
            const bool is_held = body == 0 ? rest(1, v) < -0.09 : rest(1, v) > 0.32;
            left = std::max(left, is_held ? 0.0 : run.simulation().forces(body).col(v).norm());
        }
    }
    EXPECT_GT(pressed, 1);
    EXPECT_LT(left, 1e-3 * pressed);
}

TYPED_TEST(BarrierMotionTest, KinematicBodyPushesAFreeOneAndIsNotPushed) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene;
    const Eigen::VectorXd everywhere = vector<kDim>(9, 9, 9);
    const Eigen::VectorXd unit = Eigen::VectorXd::Constant(kDim, 0.2);
    scene.add(box<kDim>(1, 1, 1, unit), vector<kDim>(0, 0));
    scene.hold(-everywhere, everywhere, vector<kDim>(3, 0));
    scene.add(box<kDim>(1, 1, 1, unit), vector<kDim>(0.24, 0.01, 0.02));
    WatchedRun<kDim> run(scene);
    const double start = run.simulation().positions(0)(0, 0);
    run.run(12);
    EXPECT_EQ(run.failure(), "");
    EXPECT_EQ(run.crossings(), 0);
    EXPECT_LT(run.smallest_distance(), 0.02);
    EXPECT_NEAR(run.simulation().positions(0)(0, 0) - start, 3 * 0.12, 1e-12);
    EXPECT_GT(run.simulation().velocities(1).row(0).mean(), 2);
}

TYPED_TEST(BarrierMotionTest, BodiesMayBePutInEachOthersPlaces) {
    constexpr int kDim = TypeParam::value;
    BarrierScene<kDim> scene = collision<kDim>(Integrator::NewtonEuler);
    Simulation<kDim> simulation(scene.scene, scene.meshes);
    const Positions<kDim> first = simulation.positions(0);
    const Positions<kDim> second = simulation.positions(1);
    const Positions<kDim> still = Positions<kDim>::Zero(kDim, first.cols());
    EXPECT_THROW(simulation.set_state(0, second, still), Error);  // into the other body
    EXPECT_EQ(simulation.positions(0), first);
    Snapshot<kDim> snapshot = simulation.save();
    snapshot.positions << second, first;
    simulation.restore(snapshot);
    EXPECT_EQ(simulation.positions(0), second);
    EXPECT_TRUE(simulation.step().is_accepted);
}

// Nothing is solved for here, and yet a barrier keeps its word.
TYPED_TEST(BarrierMotionTest, BodiesHeldEverywhereDoNotPassThroughEachOther) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : {Integrator::NewtonEuler, Integrator::Quasistatic}) {
        BarrierScene<kDim> scene;
        scene.scene.solver.integrator = integrator;
        const Eigen::VectorXd everywhere = vector<kDim>(9, 9, 9);
        const Eigen::VectorXd size = vector<kDim>(0.2, 0.2, 0.2);
        scene.add(box<kDim>(1, 1, 1, size), vector<kDim>(0, 0));
        scene.hold(-everywhere, everywhere, vector<kDim>(0, 0));
        scene.add(box<kDim>(1, 1, 1, size), vector<kDim>(0.03, 0.23, 0.02));
        scene.hold(-everywhere, everywhere, vector<kDim>(0, -1));
        WatchedRun<kDim> run(scene);
        run.run(6);  // 0.06 m down, twice the gap
        EXPECT_EQ(run.crossings(), 0);
        EXPECT_NE(run.failure().find("held vertices cannot go on"), std::string::npos)
            << run.failure();
    }
}

}  // namespace
}  // namespace pent::simulator
