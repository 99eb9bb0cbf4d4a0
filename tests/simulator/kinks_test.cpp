#include "contact_scenes.h"

#include <gtest/gtest.h>

// Penalty contact between cubes that meet at corners and edges: the forces jump where a vertex
// changes its facet, and Newton's method finds no point where they balance.

namespace pent::simulator {
namespace {

class Kinks : public testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(All, Kinks, testing::Values(Integrator::NewtonEuler, Integrator::Bdf2));

TEST_P(Kinks, NeitherStopNewtonsMethodNorMakeItGoInCircles) {
    Scene scene = test::box_scene<4>();
    scene.solver.integrator = GetParam();
    scene.frames_per_second = 60;
    scene.contact = ContactSettings{.distance = 0.05, .stiffness = 2e4};
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[1].name = "b";
    scene.bodies[0].velocity = Eigen::Vector4d(2, 0, 0, 0);
    scene.bodies[1].velocity = Eigen::Vector4d(-2, 0, 0, 0);
    scene.bodies[1].place.translate = Eigen::Vector4d(1.4, 0.3, 0.2, 0.1);
    scene.bodies[1].place.rotate = {{.plane = {0, 3}, .degrees = 20}};
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1});
    Simulation<4> simulation(scene, {mesh, mesh});
    int iterations = 0;
    double loaded = 0;
    constexpr int kSteps = 24;
    for (int step = 0; step < kSteps; ++step) {
        const StepReport report = simulation.step();
        ASSERT_TRUE(report.is_accepted) << report.failure;
        EXPECT_EQ(report.refused, 0) << step;
        EXPECT_LE(report.unbalanced, 0.1) << step;
        iterations += report.newton_iterations;
        loaded = std::max(loaded, report.energies.of("contact"));
    }
    EXPECT_GT(loaded, 1);
    EXPECT_LT(iterations, 10 * kSteps);  // eight of them to see that it goes in circles
    // What is left of a tenth of the forces of a step at most, of 2000 kg m/s each.
    EXPECT_LT(test::momentum(simulation).norm(), 1);
}

}  // namespace
}  // namespace pent::simulator
