#include "contact_scenes.h"

#include <pent/simulator/energy.h>

#include <gtest/gtest.h>

#include <cmath>

// Forces and pressure on bodies that move, against what can be worked out by hand.

namespace pent::simulator {
namespace {

using Eigen::MatrixXd;
using test::cube;
using test::momentum;

template <typename T>
class LoadsTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(LoadsTest, Dimensions);

// A bar 1 m long and half as thick, of `cells` cells across.
template <int Dim>
SimplexMesh<Dim> bar(int cells = 2) {
    std::array<int, Dim> count{};
    std::array<double, Dim> size{};
    count.fill(cells);
    size.fill(0.5);
    count[0] = 2 * cells;
    size[0] = 1;
    return pent::test::kuhn_box<Dim>(count, size);
}

template <int Dim>
Selection end(double sign, double offset) {
    return HalfSpaceSelection{.normal = sign * Eigen::VectorXd::Unit(Dim, 0), .offset = offset};
}

void solve_tightly(Scene& scene) {
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-12;
    scene.solver.newton_tolerance = 1e-10;
}

// Without Poisson's ratio the sides stay where they are, and a bar held at one end whose other end
// is pulled at by p on each unit stretches by p / E all along: what linear elements represent
// exactly. The pull follows the end as it grows by p / E of itself, here 1e-6, and no more.
TYPED_TEST(LoadsTest, StretchABarByTheirPartOfYoungsModulus) {
    constexpr int kDim = TypeParam::value;
    for (const Model model : {Model::Linear, Model::StableNeoHookean}) {
        Scene scene = test::box_scene<kDim>();
        scene.bodies[0].material = {.model = model, .lame = lame_from_young(kDim, 1e5, 0)};
        scene.solver.integrator = Integrator::Quasistatic;
        solve_tightly(scene);
        scene.constraints = {test::hold(end<kDim>(1, 1e-9), test::still(kDim))};
        scene.loads = {{.body = "box",
                        .select = {end<kDim>(-1, -1 + 1e-9)},
                        .force = {},
                        .pressure = -0.1,
                        .keyframes = {}}};
        Simulation<kDim> simulation(scene, {bar<kDim>()});
        for (int i = 0; i < 3; ++i) {
            const StepReport report = simulation.step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
        }
        const Positions<kDim> moved = simulation.positions(0) - simulation.mesh(0).positions;
        for (Eigen::Index v = 0; v < moved.cols(); ++v) {
            Eigen::VectorXd expected = Eigen::VectorXd::Zero(kDim);
            expected[0] = 1e-6 * simulation.mesh(0).positions(0, v);
            EXPECT_LT((moved.col(v) - expected).norm(), 1e-5 * 1e-6);
        }
    }
}

// The scale s at which a body under pressure p is at rest: every face of it is pulled at by
// P(s I)_11 on each unit at rest and pushed by p s^(n-1).
template <int Dim>
double scale_under(const Material& material, double pressure) {
    double low = 0.7;
    double high = 1.4;
    for (int i = 0; i < 60; ++i) {
        const double s = 0.5 * (low + high);
        const double pull = stress(material, s * MatrixXd::Identity(Dim, Dim))(0, 0);
        (pull + pressure * std::pow(s, Dim - 1) < 0 ? low : high) = s;
    }
    return low;
}

// Pressed from all around, and blown up: a body of any shape keeps it, and linear elements
// represent that exactly.
TYPED_TEST(LoadsTest, ScaleABodyAsItsStressSays) {
    constexpr int kDim = TypeParam::value;
    for (const Model model : {Model::StableNeoHookean, Model::MooneyRivlin}) {
        for (const double pressure : {1.5e4, -1e4}) {
            Scene scene = test::box_scene<kDim>();
            scene.bodies[0].material = {
                .model = model, .lame = lame_from_young(kDim, 1e5, 0.2), .second_invariant = 0.4};
            scene.solver.integrator = Integrator::NewtonEuler;
            solve_tightly(scene);
            scene.damping = Damping{.mass = 30, .stiffness = 0};
            scene.loads = {{.body = "box",
                            .select = {EverythingSelection{}},
                            .force = {},
                            .pressure = pressure,
                            .keyframes = {}}};
            Simulation<kDim> simulation(scene, {bar<kDim>(1)});
            for (int i = 0; i < 200; ++i) {
                const StepReport report = simulation.step();
                ASSERT_TRUE(report.is_accepted) << report.failure;
            }
            const double expected = scale_under<kDim>(scene.bodies[0].material, pressure);
            EXPECT_GT(std::abs(expected - 1), 0.02);
            // By volume, which does not see how the body may have turned a little.
            const SimplexMesh<kDim>& mesh = simulation.mesh(0);
            double volume = 0;
            for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
                volume += cell_volume<kDim>(simulation.positions(0), mesh.cells, cell);
            }
            const double rest = std::pow(0.5, kDim - 1);
            EXPECT_NEAR(std::pow(volume / rest, 1.0 / kDim), expected, 1e-7) << pressure;
        }
    }
}

// A force of m g on all of a body is gravity.
TYPED_TEST(LoadsTest, OnAllOfABodyAreGravity) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        Scene falling = test::box_scene<kDim>();
        falling.solver.integrator = integrator;
        solve_tightly(falling);
        falling.constraints = {test::hold(end<kDim>(1, 1e-9), test::still(kDim))};
        Scene pushed = falling;
        falling.gravity[1] = -9.8;
        Simulation<kDim> under_gravity(falling, {bar<kDim>()});
        pushed.loads = {{.body = "box",
                         .select = {EverythingSelection{}},
                         .force = falling.gravity * under_gravity.masses(0).sum(),
                         .keyframes = {}}};
        Simulation<kDim> under_force(pushed, {bar<kDim>()});
        for (int i = 0; i < 10; ++i) {
            ASSERT_TRUE(under_gravity.step().is_accepted);
            ASSERT_TRUE(under_force.step().is_accepted);
        }
        const double moved = (under_gravity.positions(0) - under_gravity.mesh(0).positions).norm();
        EXPECT_GT(moved, 0.01);
        EXPECT_LT((under_gravity.positions(0) - under_force.positions(0)).norm(), 1e-8 * moved);
        EXPECT_NEAR(under_force.energies().of("force"), under_gravity.energies().of("gravity"),
                    1e-8 * std::abs(under_gravity.energies().of("gravity")));
    }
}

// Backward Euler takes the force at the end of each step: m v is the sum of h f(t_k).
TYPED_TEST(LoadsTest, AddTheirIntegralToTheMomentum) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator : {Integrator::LinearEuler, Integrator::NewtonEuler}) {
        Scene scene = test::box_scene<kDim>();
        scene.solver.integrator = integrator;
        scene.solver.precision = Precision::Double;
        scene.solver.tolerance = 1e-9;
        scene.solver.newton_tolerance = 1e-9;
        const Eigen::VectorXd force = Eigen::VectorXd::LinSpaced(kDim, -3, 4);
        scene.loads = {{.body = "box",
                        .select = {end<kDim>(1, 0.3)},
                        .force = force,
                        .keyframes = {{0, 0}, {0.1, 1}, {0.2, -0.5}}},
                       {.body = "box",
                        .select = {EverythingSelection{}},
                        .force = {},
                        .pressure = 200,
                        .keyframes = {}}};
        Simulation<kDim> simulation(scene, {bar<kDim>()});
        Eigen::VectorXd expected = Eigen::VectorXd::Zero(kDim);
        const double h = scene.dt();
        const auto smooth = [](double s) { return s * s * (3 - 2 * s); };
        for (int k = 1; k <= 9; ++k) {
            ASSERT_EQ(simulation.step().substeps, 1);
            // Rises and falls by one cubic each: 0.1 s is a highest point, with no slope.
            const double t = k * h;
            const double factor = t >= 0.2   ? -0.5
                                  : t >= 0.1 ? 1 - 1.5 * smooth((t - 0.1) / 0.1)
                                             : smooth(t / 0.1);
            expected += h * factor * force;
        }
        // Pressure adds nothing. A step leaves 1e-9 of what it starts with unsolved, of the 50 N or
        // so on a vertex, and there are nine.
        EXPECT_LT((momentum(simulation) - expected).norm(), 1e-5 * expected.norm());
    }
}

// A load on one side turns with the body: thrust, normal to the side wherever that is.
template <int Dim>
Scene loaded_scene(Integrator integrator) {
    Scene scene = test::two_cubes<Dim>(0.02);
    scene.solver.integrator = integrator;
    scene.contact->friction = 0.3;
    scene.bodies[0].spin = {{.plane = {0, Dim - 1}, .degrees_per_s = 400}};
    scene.loads = {{.body = "a",
                    .select = {end<Dim>(1, 1e-9)},
                    .force = {},
                    .pressure = 3e3,
                    .keyframes = {{0, 0.2}, {0.05, 1}, {0.1, 0.4}}},
                   {.body = "b",
                    .select = {EverythingSelection{}},
                    .force = -40 * Eigen::VectorXd::Unit(Dim, 1),
                    .pressure = 2e3,
                    .keyframes = {{0.02, 1}, {0.06, 0}}}};
    return scene;
}

template <int Dim>
void expect_same(const Simulation<Dim>& a, const Simulation<Dim>& b) {
    for (int body = 0; body < a.body_count(); ++body) {
        EXPECT_EQ(a.positions(body), b.positions(body));
        EXPECT_EQ(a.velocities(body), b.velocities(body));
    }
}

TYPED_TEST(LoadsTest, GiveTheSameBitsForAnyNumberOfThreadsAndBehindARestore) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        const Scene scene = loaded_scene<kDim>(integrator);
        Simulation<kDim> one(scene, {cube<kDim>(), cube<kDim>()}, {.threads = 1});
        Simulation<kDim> three(scene, {cube<kDim>(), cube<kDim>()}, {.threads = 3});
        Simulation<kDim> resumed(scene, {cube<kDim>(), cube<kDim>()}, {.threads = 2});
        for (int i = 0; i < 12; ++i) {
            if (i == 5) {
                resumed.restore(one.save());
            }
            ASSERT_TRUE(one.step().is_accepted);
            ASSERT_TRUE(three.step().is_accepted);
            if (i >= 5) {
                ASSERT_TRUE(resumed.step().is_accepted);
            }
        }
        expect_same(one, three);
        expect_same(one, resumed);
    }
}

// At rest under a load for a while; then the load changes.
TYPED_TEST(LoadsTest, WakeABodyWhenTheyChange) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    scene.frames_per_second = 60;
    scene.constraints = {test::hold(end<kDim>(1, 1e-9), test::still(kDim))};
    scene.damping = Damping{.mass = 40, .stiffness = 0};
    scene.sleep = Sleep{.speed = 1e-2, .time = 0.1};
    scene.loads = {{.body = "box",
                    .select = {end<kDim>(-1, -1 + 1e-9)},
                    .force = -20 * Eigen::VectorXd::Unit(kDim, 1),
                    .keyframes = {{2, 1}, {2.5, -1}}}};
    Simulation<kDim> simulation(scene, {bar<kDim>()});
    bool has_slept = false;
    while (simulation.time() < 1.99) {
        has_slept = simulation.step().asleep > 0;
    }
    EXPECT_TRUE(has_slept);
    const double before = simulation.positions(0).row(1).sum();
    while (simulation.time() < 2.49) {
        EXPECT_EQ(simulation.step().asleep, 0) << simulation.time();
    }
    EXPECT_GT(simulation.positions(0).row(1).sum(), before + 1e-3);
}

TEST(Loads, ThatAreNotThereHaveNoEnergy) {
    Simulation<4> simulation(test::box_scene<4>(), {cube<4>()});
    for (const TermEnergy& term : simulation.step().energies.terms) {
        EXPECT_TRUE(term.name != "force" && term.name != "pressure") << term.name;
    }
}

}  // namespace
}  // namespace pent::simulator
