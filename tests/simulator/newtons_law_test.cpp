#include "muscle.h"
#include "potential_laws.h"
#include "scenes.h"

#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

#include <algorithm>

// Mass times acceleration is force, at every free vertex and with all features at once: what a step
// has done to velocities is compared with forces(), which are found anew at its end.

namespace pent::simulator {
namespace {

template <typename T>
class NewtonsLaw : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(NewtonsLaw, Dimensions);

constexpr double kSide = 0.5;    // of cubes with a vertex at the origin, m
constexpr double kDrag = 2;      // of damping, 1/s
constexpr double kDelay = 1e-3;  // of damping, s

template <int Dim>
HalfSpaceSelection below(double x) {
    return {.normal = Eigen::VectorXd::Unit(Dim, 0), .offset = x};
}

// A muscle that is turned at its left end, and let go, and a bag under pressure that is tied to it
// and to a point that moves, over a floor that comes up.
template <int Dim>
Scene all_at_once(Integrator integrator, ElementKind kind) {
    Scene scene = test::box_scene<Dim>();
    scene.frames_per_second = 100;
    scene.gravity[1] = -9.8;
    Body bag = scene.bodies[0];
    bag.name = "bag";
    bag.place.translate[0] = 0.6;
    bag.material = {.model = Model::MooneyRivlin,
                    .lame = lame_from_young(Dim, 3e4, 0.2),
                    .second_invariant = 0.3,
                    .density = 300};
    scene.bodies.push_back(bag);
    Motion turning = test::still(Dim);
    turning.rotate = {{.plane = {0, Dim - 1}, .degrees_per_s = 300}};
    scene.constraints = {test::hold(below<Dim>(1e-6), turning)};
    Load push{.body = "box", .select = {EverythingSelection{}}};
    push.force = Eigen::VectorXd::Constant(Dim, 30);
    push.keyframes = {{0, 0}, {0.05, 1}};
    Load swell{.body = "bag", .select = {EverythingSelection{}}};
    swell.pressure = 2e3;
    scene.loads = {push, swell};
    if (kind != ElementKind::Smoothed) {
        scene.activations = {test::muscle(0.8, Eigen::VectorXd::Unit(Dim, 1))};
        scene.activations[0].signal = Signal::Sine;
        scene.activations[0].frequency = 7;
    }
    Motion up = test::still(Dim);
    up.translate[1] = 0.5;
    Attachment tie;
    tie.body = "bag";
    tie.select = {below<Dim>(0.6 + 1e-6)};
    tie.target = "box";
    tie.max_distance = 1;
    Attachment crane;
    crane.body = "bag";
    crane.select = {below<Dim>(0.7)};
    crane.motion = {up};
    scene.attachments = {tie, crane};
    Obstacle floor;
    floor.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(Dim, 1)};
    floor.motion = {up};
    scene.obstacles = {floor};
    scene.damping = Damping{.mass = kDrag, .stiffness = kDelay};
    if (integrator == Integrator::Quasistatic) {
        scene.constraints.push_back(test::hold(below<Dim>(0.6 + 1e-6), test::still(Dim)));
        scene.constraints.back().body = "bag";
    } else {
        scene.constraints[0].to = 0.04;
    }
    scene.solver.integrator = integrator;
    scene.solver.elements = kind;
    scene.solver.filter = Filter::None;  // damping has the tangent as it is
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-10;
    scene.solver.newton_tolerance = 1e-9;
    return scene;
}

// What a step of an integrator takes for the acceleration and the velocity at its end.
template <int Dim>
struct Rates {
    Positions<Dim> accelerations;
    Positions<Dim> velocities;
};

// BDF2 begins anew where something is let go, by a step of Euler's.
template <int Dim>
Rates<Dim> rates(Integrator integrator,
                 const Snapshot<Dim>& before,
                 const Positions<Dim>& x,
                 double h,
                 bool is_anew) {
    Rates<Dim> all;
    if (integrator == Integrator::Bdf2 && before.previous_positions.cols() > 0 && !is_anew) {
        all.velocities = (3 * x - 4 * before.positions + before.previous_positions) / (2 * h);
        all.accelerations =
            (3 * all.velocities - 4 * before.velocities + before.previous_velocities) / (2 * h);
        return all;
    }
    all.velocities = (x - before.positions) / h;
    all.accelerations = (all.velocities - before.velocities) / h;
    if (integrator == Integrator::Quasistatic) {
        all.accelerations.setZero();
    }
    return all;
}

// Bodies of a scene alone, whose forces are elastic.
Scene elastic_part(Scene scene) {
    scene.gravity.setZero();
    scene.constraints.clear();
    scene.loads.clear();
    scene.attachments.clear();
    scene.obstacles.clear();
    scene.damping.reset();
    scene.solver.integrator = Integrator::NewtonEuler;
    return scene;
}

// What elastic forces at the start of a step, with the activations of its end, change by per second
// at these velocities, by central differences.
template <int Dim>
Positions<Dim> change_of_forces(Simulation<Dim>& elastic,
                                const Snapshot<Dim>& before,
                                const Positions<Dim>& velocities) {
    const double step = 1e-6 / velocities.cwiseAbs().maxCoeff();
    const auto forces_after = [&](double time) {
        Snapshot<Dim> state = elastic.save();
        state.steps = before.steps + 1;
        state.positions = before.positions + time * velocities;
        elastic.restore(state);
        Positions<Dim> forces(Dim, 0);
        for (int body = 0; body < elastic.body_count(); ++body) {
            const Positions<Dim> of_body = elastic.forces(body);
            forces.conservativeResize(Dim, forces.cols() + of_body.cols());
            forces.rightCols(of_body.cols()) = of_body;
        }
        return forces;
    };
    return (forces_after(step) - forces_after(-step)) / (2 * step);
}

template <int Dim>
void expect_law(Integrator integrator, ElementKind kind) {
    const Scene scene = all_at_once<Dim>(integrator, kind);
    Simulation<Dim> simulation(
        scene, {test::cube_for<Dim>(scene, 2), test::cube_for<Dim>(scene, 2)}, {.threads = 2});
    Simulation<Dim> elastic(elastic_part(scene),
                            {test::cube_for<Dim>(scene, 2), test::cube_for<Dim>(scene, 2)});
    const double h = scene.dt();
    std::int64_t held = 0;
    for (int step = 1; step <= 8; ++step) {
        const Snapshot<Dim> before = simulation.save();
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        ASSERT_EQ(report.substeps, 1);
        const bool is_anew = step > 1 && report.constraints[0].held != held;
        held = report.constraints[0].held;
        const Rates<Dim> all =
            rates<Dim>(integrator, before, simulation.save().positions, h, is_anew);
        const Positions<Dim> drag = -kDelay * change_of_forces(elastic, before, all.velocities);
        for (int body = 0; body < simulation.body_count(); ++body) {
            const auto first = static_cast<Eigen::Index>(simulation.first_vertex(body));
            const Eigen::VectorXd masses = simulation.masses(body);
            const Positions<Dim> forces = simulation.forces(body);
            const Positions<Dim> accelerations = all.accelerations.middleCols(first, masses.size());
            const Positions<Dim> velocities = all.velocities.middleCols(first, masses.size());
            const Eigen::MatrixXd reactions =
                simulation.vertex_values(VertexQuantity::Reaction, body);
            Positions<Dim> left = (accelerations + kDrag * velocities) * masses.asDiagonal()
                                  + drag.middleCols(first, masses.size()) - forces;
            int free = 0;
            for (Eigen::Index v = 0; v < masses.size(); ++v) {
                if (!reactions.col(v).isZero(0)) {
                    left.col(v).setZero();
                } else {
                    ++free;
                }
            }
            EXPECT_GT(free, masses.size() / 2);
            // What Newton's method leaves of what a step begins with, and differences.
            const double size = (accelerations * masses.asDiagonal()).norm() + forces.norm()
                                + (before.velocities.norm() / h) * masses.maxCoeff();
            EXPECT_LT(left.norm(), 1e-6 * size) << "step " << step << " body " << body;
        }
    }
    EXPECT_EQ(held == 0, integrator != Integrator::Quasistatic);
}

TYPED_TEST(NewtonsLaw, HoldsWithAllFeaturesAtOnce) {
    for (const Integrator integrator :
         {Integrator::NewtonEuler, Integrator::Bdf2, Integrator::Quasistatic}) {
        for (const ElementKind kind :
             {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic}) {
            SCOPED_TRACE(testing::Message() << word_of(integrator) << " " << word_of(kind));
            expect_law<TypeParam::value>(integrator, kind);
        }
    }
}

}  // namespace
}  // namespace pent::simulator
