#include "scenes.h"
#include "support/messages.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

namespace pent::simulator {
namespace {

using test::bar;
using test::box_scene;
using test::hold;
using test::still;
using test::swinging_bar;

const HalfSpaceSelection kLeftEnd = test::left_end();

// Implicit Euler under constant g: v_n = n h g, x_n = h^2 g n (n + 1) / 2, whatever the body.
template <int Dim>
void expect_free_fall(Precision precision) {
    Scene scene = box_scene<Dim>();
    scene.gravity[1] = -9.8;
    scene.solver.precision = precision;
    scene.solver.tolerance = precision == Precision::Double ? 1e-13 : 1e-6;
    std::array<int, Dim> count{};
    count.fill(2);
    std::array<double, Dim> size{};
    size.fill(1);
    Simulation<Dim> simulation(scene, {pent::test::kuhn_box<Dim>(count, size)});
    const int steps = 10;
    for (int i = 0; i < steps; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    const double h = scene.dt();
    const double fall = -9.8 * h * h * steps * (steps + 1) / 2;
    const Positions<Dim> moved = simulation.positions(0) - simulation.mesh(0).positions;
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(Dim);
    expected[1] = fall;
    const double error = (moved.colwise() - expected.head<Dim>()).colwise().norm().maxCoeff();
    // A constant field is in the null space of K, so that only rounding and, in each step, the
    // solver's tolerance are left.
    EXPECT_LT(error, 100 * scene.solver.tolerance * std::abs(fall));
    EXPECT_NEAR(simulation.velocities(0)(1, 3), -9.8 * h * steps, 1e-4);
}

// Rigid motions are in the coarse space, which the solver asks first.
TEST(FreeFall, TakesNoIterations) {
    Scene scene = box_scene<4>();
    scene.gravity[1] = -9.8;
    scene.solver.tolerance = 1e-8;
    scene.solver.precision = Precision::Double;
    Simulation<4> simulation(scene, {bar()});
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(simulation.step().iterations, 0);
    }
}

TEST(FreeFall, IsExactForTheIntegrator) {
    expect_free_fall<3>(Precision::Double);
    expect_free_fall<4>(Precision::Double);
    expect_free_fall<4>(Precision::Float);
}

TEST(BodyAtRest, StaysExactlyAtRest) {
    Simulation<4> simulation(box_scene<4>(), {bar(3)});
    ASSERT_TRUE(simulation.step().is_accepted);
    // Forces at rest are rounding of 1e5 Pa times areas; h^2 / m times that is far below 1e-12 m.
    EXPECT_LT((simulation.positions(0) - simulation.mesh(0).positions).cwiseAbs().maxCoeff(),
              1e-12);
}

TEST(HeldVertices, FollowTheirMotionExactly) {
    Scene scene = box_scene<4>();
    Motion motion = still(4);
    motion.rotate = {{{1, 2}, 90}, {{3, 0}, 60}};
    motion.about = Eigen::Vector4d(0, 0.25, 0.25, 0.25);
    scene.constraints = {hold(kLeftEnd, motion)};
    Simulation<4> simulation(scene, {bar()});
    for (int i = 0; i < 30; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    // After one second: y has turned onto z, w by 60 degrees onto x.
    for (Eigen::Index v = 0; v < simulation.mesh(0).vertex_count(); ++v) {
        const Eigen::Vector4d rest = simulation.mesh(0).positions.col(v);
        if (rest[0] > 1e-6) {
            continue;
        }
        const Eigen::Vector4d arm = rest - *motion.about;
        const double c = 0.5;
        const double s = std::sqrt(0.75);
        const Eigen::Vector4d turned(c * arm[0] + s * arm[3], -arm[2], arm[1],
                                     c * arm[3] - s * arm[0]);
        EXPECT_LT((simulation.positions(0).col(v) - *motion.about - turned).norm(), 1e-14);
    }
    EXPECT_GT((simulation.positions(0) - simulation.mesh(0).positions).norm(), 1);
}

// A quarter turn about the middle, a second's way along x, and then a quarter turn about where that
// has taken the middle: together a half turn and the way.
TEST(HeldVertices, GoThroughTheirMotionsOneAfterTheOther) {
    Scene scene = box_scene<4>();
    Motion turn = still(4);
    turn.rotate = {{{1, 3}, 90}};
    turn.to = 1;
    Motion way = still(4);
    way.translate = Eigen::Vector4d(2, 0, 0, 0);
    way.to = 1;
    Motion turn_again = turn;
    turn_again.from = 1;
    turn_again.to = 2;
    scene.constraints = {
        {.body = "box", .select = {EverythingSelection{}}, .motion = {turn, way, turn_again}}};
    Simulation<4> simulation(scene, {bar(2)});
    for (int i = 0; i < 60; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    const Positions<4> rest = simulation.mesh(0).positions;
    const Eigen::Vector4d middle = rest.rowwise().mean();
    const Positions<4> half_turned =
        Eigen::Vector4d(1, -1, 1, -1).asDiagonal() * (rest.colwise() - middle);
    const Eigen::Vector4d now = middle + Eigen::Vector4d(2, 0, 0, 0);
    const Positions<4> expected = half_turned.colwise() + now;
    EXPECT_LT((simulation.positions(0) - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(HeldVertices, HaveTheVelocityOfAllTheirMotions) {
    Scene scene = box_scene<4>();
    Motion turn = still(4);
    turn.rotate = {{{1, 3}, 90}};
    Motion way = still(4);
    way.translate = Eigen::Vector4d(2, 0, 0, 0);
    Motion other = still(4);
    other.rotate = {{{0, 1}, 60}};
    other.about = Eigen::Vector4d::Zero();
    scene.constraints = {
        {.body = "box", .select = {EverythingSelection{}}, .motion = {turn, way, other}}};
    scene.frames_per_second = 1e5;
    Simulation<4> simulation(scene, {bar(2)});
    ASSERT_TRUE(simulation.step().is_accepted);
    const Positions<4> before = simulation.positions(0);
    const Positions<4> velocities_before = simulation.velocities(0);
    ASSERT_TRUE(simulation.step().is_accepted);
    const Positions<4> mean = (velocities_before + simulation.velocities(0)) / 2;
    const Positions<4> difference = (simulation.positions(0) - before) * 1e5;
    // The trapezoid is exact to h^2 / 12 times the third derivative of some m/s^3; rounding of
    // positions of 1 m is 1e5 times 1e-16.
    EXPECT_LT((difference - mean).cwiseAbs().maxCoeff(), 1e-9);
}

// Without forces a body goes on as it started: the middle straight, and momentum kept.
TEST(Body, StartsWithItsVelocityAndSpin) {
    Scene scene = box_scene<4>();
    scene.bodies[0].velocity = Eigen::Vector4d(0, 3, 0, -1);
    scene.bodies[0].spin = {{{3, 2}, 90}};  // w towards z
    Simulation<4> simulation(scene, {bar(2)});
    const Positions<4> rest = simulation.mesh(0).positions;
    // The box is the same on both sides of its middle, which is therefore its center of mass.
    const Eigen::Vector4d middle = (rest.rowwise().maxCoeff() + rest.rowwise().minCoeff()) / 2;
    const double omega = std::acos(-1.0) / 2;
    for (Eigen::Index v = 0; v < rest.cols(); ++v) {
        const Eigen::Vector4d arm = rest.col(v) - middle;
        const Eigen::Vector4d expected(0, 3, omega * arm[3], -1 - omega * arm[2]);
        EXPECT_LT((simulation.velocities(0).col(v) - expected).norm(), 1e-14);
    }
}

TEST(FullyKinematicBody, HasNoUnknownsAndMovesRigidly) {
    Scene scene = box_scene<4>();
    Motion motion = still(4);
    motion.translate = Eigen::Vector4d(0, 0, 0, 1.5);
    scene.constraints = {hold(EverythingSelection{}, motion)};
    Simulation<4> simulation(scene, {bar(2)});
    EXPECT_EQ(simulation.size().free_vertices, 0);
    EXPECT_EQ(simulation.size().elements, 0);
    const StepReport report = simulation.step();
    EXPECT_TRUE(report.is_accepted);
    EXPECT_EQ(report.iterations, 0);
    EXPECT_NEAR(simulation.positions(0)(3, 0), 1.5 * scene.dt(), 1e-15);
    EXPECT_EQ(simulation.velocities(0)(3, 0), 1.5);
}

TEST(Constraints, ThatSelectTheSameVertexAreRefused) {
    Scene scene = box_scene<4>();
    scene.constraints = {hold(kLeftEnd, still(4)), hold(EverythingSelection{}, still(4))};
    EXPECT_THROW(Simulation<4>(scene, {bar(2)}), Error);
}

TEST(Simulation, RefusesAVertexWithoutCell) {
    SimplexMesh<4> mesh = bar(2);
    mesh.positions.conservativeResize(4, mesh.vertex_count() + 1);
    mesh.positions.rightCols<1>().setZero();
    mesh.columns.push_back(0);
    mesh.layers.push_back(9);
    EXPECT_THROW(Simulation<4>(box_scene<4>(), {mesh}), Error);
}

TEST(Simulation, RefusesASceneOfAnotherDimension) {
    EXPECT_THROW(Simulation<4>(box_scene<3>(), {bar(2)}), Error);
}

TEST(Simulation, AgreesBetweenInstructionSetsToTheSolversTolerance) {
    Scene scene = swinging_bar();
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-12;
    std::vector<Positions<4>> ends;
    for (const char* isa : {"scalar", "baseline", ""}) {
        Simulation<4> simulation(scene, {bar()}, {.threads = 1, .isa = isa});
        for (int i = 0; i < 5; ++i) {
            ASSERT_TRUE(simulation.step().is_accepted);
        }
        ends.push_back(simulation.positions(0));
    }
    // Condition number about 1e3 times the tolerance.
    EXPECT_LT((ends[0] - ends[1]).norm(), 1e-8 * ends[0].norm());
    EXPECT_LT((ends[0] - ends[2]).norm(), 1e-8 * ends[0].norm());
}

TEST(Simulation, RefusesAnUnknownInstructionSet) {
    EXPECT_THROW(Simulation<4>(box_scene<4>(), {bar(2)}, {.threads = 1, .isa = "mmx"}), Error);
}

TEST(FreeBody, KeepsItsLinearMomentumToTheSolversTolerance) {
    Scene scene = box_scene<4>();
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-11;
    Simulation<4> simulation(scene, {bar(3)});
    Positions<4> velocities = Positions<4>::Zero(4, simulation.mesh(0).vertex_count());
    velocities.row(3) = simulation.mesh(0).positions.row(0);  // shears along w
    simulation.set_state(0, simulation.mesh(0).positions, velocities);
    const Eigen::VectorXd masses = simulation.masses(0);
    const Eigen::Vector4d before = velocities * masses;
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    const Eigen::Vector4d after = simulation.velocities(0) * masses;
    EXPECT_LT((after - before).norm(), 1e-8 * before.norm());
}

TEST(LinearEnergy, NeverGainsTotalEnergyUnderImplicitEuler) {
    Scene scene = box_scene<4>();
    scene.gravity[1] = -9.8;
    scene.bodies[0].material.model = Model::Linear;
    scene.constraints = {hold(kLeftEnd, still(4))};
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-10;
    Simulation<4> simulation(scene, {bar()});
    double before = simulation.energies().total();
    const double scale = std::abs(before);
    for (int i = 0; i < 40; ++i) {
        const StepReport report = simulation.step();
        EXPECT_LE(report.energies.total(), before + 1e-7 * scale) << i;
        before = report.energies.total();
    }
}

TEST(Damping, SlowsAFreeBodyByTheMassTermExactly) {
    Scene scene = box_scene<4>();
    scene.damping = Damping{.mass = 3, .stiffness = 0.1};
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-12;
    Simulation<4> simulation(scene, {bar(2)});
    Positions<4> velocities = Positions<4>::Zero(4, simulation.mesh(0).vertex_count());
    velocities.row(2).setConstant(1);
    simulation.set_state(0, simulation.mesh(0).positions, velocities);
    for (int i = 0; i < 5; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    // Rigid motion feels no stiffness damping; each step divides the velocity by 1 + h a.
    EXPECT_NEAR(simulation.velocities(0)(2, 7), std::pow(1 + 3 * scene.dt(), -5), 1e-8);
}

// At rest on the floor the floor carries the weight: sum over vertices of 2 k gap = m g.
TEST(Floor, CarriesTheWeightOfABodyAtRest) {
    Scene scene = box_scene<4>();
    scene.gravity[1] = -9.8;
    scene.bodies[0].place.translate[1] = 0.02;
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d(0, 1, 0, 0), .offset = 0},
         .distance = 0.02,
         .stiffness = 2e4}};
    scene.damping = Damping{.mass = 5, .stiffness = 0.01};
    Simulation<4> simulation(scene, {bar(2)});
    for (int i = 0; i < 150; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    double carried = 0;
    for (Eigen::Index v = 0; v < simulation.mesh(0).vertex_count(); ++v) {
        carried += 2 * 2e4 * std::max(0.0, 0.02 - simulation.positions(0)(1, v));
    }
    const double weight = simulation.masses(0).sum() * 9.8;
    EXPECT_NEAR(carried, weight, 1e-2 * weight);
    EXPECT_LT(simulation.velocities(0).cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_GT(simulation.positions(0).row(1).minCoeff(), 0);
}

TEST(SetState, RefusesWhatIsNotFinite) {
    Simulation<4> simulation(box_scene<4>(), {bar(2)});
    Positions<4> positions = simulation.positions(0);
    const Positions<4> velocities = simulation.velocities(0);
    positions(2, 1) = std::nan("");
    EXPECT_THROW(simulation.set_state(0, positions, velocities), Error);
}

// Each part alone is wrong, and nothing has changed then.
TEST(Restore, RefusesEveryPartThatDoesNotFit) {
    Scene scene = box_scene<3>();
    scene.gravity[1] = -9.8;
    scene.solver.integrator = Integrator::Bdf2;
    scene.constraints = {hold(LayerSelection{}, test::still(3))};
    scene.constraints[0].select = {EverythingSelection{}};
    scene.constraints[0].from = 1;
    Attachment tie;
    tie.body = "box";
    tie.select = {EverythingSelection{}};
    scene.attachments = {tie};
    Simulation<3> simulation(scene, {pent::test::kuhn_box<3>({1, 1, 1}, {1, 1, 1})});
    ASSERT_TRUE(simulation.step().is_accepted);
    const Snapshot<3> good = simulation.save();
    ASSERT_EQ(good.previous_positions.cols(), 8);
    ASSERT_EQ(good.hold_places.cols(), 8);
    ASSERT_EQ(good.broken_springs.size(), 8U);
    std::vector<Snapshot<3>> bad;
    for (Positions<3> Snapshot<3>::*array :
         {&Snapshot<3>::positions, &Snapshot<3>::velocities, &Snapshot<3>::previous_positions,
          &Snapshot<3>::previous_velocities, &Snapshot<3>::hold_places}) {
        bad.insert(bad.end(), 4, good);
        (bad.end()[-1].*array)(1, 7) = std::nan("");
        (bad.end()[-2].*array)(1, 7) = INFINITY;
        (bad.end()[-3].*array).conservativeResize(3, 7);
        (bad.end()[-4].*array).setZero(3, 9);
    }
    bad.insert(bad.end(), 3, good);
    bad.end()[-1].broken_springs[7] = 2;
    bad.end()[-2].broken_springs.pop_back();
    bad.end()[-3].sleep[0].is_asleep = true;  // without [sleep]
    for (std::size_t k = 0; k < bad.size(); ++k) {
        EXPECT_THROW(simulation.restore(bad[k]), Error) << k;
    }
    EXPECT_EQ(simulation.save().positions, good.positions);
    EXPECT_EQ(simulation.save().hold_places, good.hold_places);
    simulation.restore(good);
    EXPECT_TRUE(simulation.step().is_accepted);
}

// Time is counted in steps, and BDF2 looks back one of them: who goes on by others says so.
template <int Dim>
void expect_steps_of_one_length() {
    Scene scene = box_scene<Dim>();
    scene.gravity[1] = -9.8;
    scene.solver.integrator = Integrator::Bdf2;
    std::array<int, Dim> count{};
    std::array<double, Dim> sides{};
    count.fill(1);
    sides.fill(1);
    const SimplexMesh<Dim> mesh = pent::test::kuhn_box<Dim>(count, sides);
    Simulation<Dim> coarse(scene, {mesh});
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(coarse.step().is_accepted);
    }
    scene.steps_per_frame *= 2;
    Simulation<Dim> fine(scene, {mesh});
    Snapshot<Dim> state = coarse.save();
    pent::test::expect_contains(pent::test::error_of([&] { fine.restore(state); }),
                                {"steps of " + pent::formatted("%.9g s", coarse.scene().dt()),
                                 "steps of " + pent::formatted("%.9g s", fine.scene().dt())});
    EXPECT_EQ(fine.step_count(), 0U);
    EXPECT_EQ(Positions<Dim>(fine.positions(0)), mesh.positions);
    state.time_step /= 2;
    state.steps *= 2;
    state.previous_positions.resize(Dim, 0);
    state.previous_velocities.resize(Dim, 0);
    fine.restore(state);
    EXPECT_EQ(fine.time(), coarse.time());
    EXPECT_EQ(Positions<Dim>(fine.positions(0)), Positions<Dim>(coarse.positions(0)));
    EXPECT_TRUE(fine.step().is_accepted);
}

TEST(Restore, RefusesAStateOfStepsOfAnotherLength) {
    expect_steps_of_one_length<3>();
    expect_steps_of_one_length<4>();
}

TEST(SetState, RefusesBodiesThatAreNotThere) {
    Simulation<4> simulation(box_scene<4>(), {bar(2)});
    const Positions<4> positions = simulation.positions(0);
    const Positions<4> velocities = simulation.velocities(0);
    for (const int body : {-1, 1, 1000000}) {
        pent::test::expect_contains(
            pent::test::error_of([&] { simulation.set_state(body, positions, velocities); }),
            {"body " + std::to_string(body) + " of 1; count from 0"});
    }
}

TEST(Simulation, GoesOnWhereItIsMovedTo) {
    const Scene scene = swinging_bar();
    Simulation<4> stays(scene, {bar()});
    Simulation<4> moves(scene, {bar()});
    ASSERT_TRUE(stays.step().is_accepted);
    ASSERT_TRUE(moves.step().is_accepted);
    std::vector<Simulation<4>> list;
    list.push_back(std::move(moves));
    ASSERT_TRUE(stays.step().is_accepted);
    ASSERT_TRUE(list[0].step().is_accepted);
    Simulation<4> assigned(scene, {bar()});
    assigned = std::move(list[0]);
    ASSERT_TRUE(stays.step().is_accepted);
    ASSERT_TRUE(assigned.step().is_accepted);
    EXPECT_EQ(assigned.step_count(), 3U);
    EXPECT_EQ(Positions<4>(assigned.positions(0)), Positions<4>(stays.positions(0)));
}

}  // namespace
}  // namespace pent::simulator
