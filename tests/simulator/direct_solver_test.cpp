#include "host_scenes.h"
#include "linear/linear_solver.h"
#include "springy_box.h"
#include "support/messages.h"

#include <pent/formatted.h>

#include <gtest/gtest.h>

#include <limits>

namespace pent::simulator {
namespace {

using test::SpringyBox;

constexpr int kDim = test::kBoxDim;

TEST(DirectSolver, LeavesTheResidualOfRoundingWhateverBlocksAreStoredIn) {
    for (const Precision precision : {Precision::Float, Precision::Double}) {
        const SpringyBox problem(precision);
        const LinearSolution<kDim> solution = problem.solve(*problem.direct(), 0.5);
        // Backward stable: the solution of a matrix a few roundings in double away.
        const double roundings = 4 * std::numeric_limits<double>::epsilon();
        EXPECT_GT(solution.report.residual, 0);
        EXPECT_LT(solution.report.residual * problem.system.right().norm(),
                  roundings * problem.dense().norm() * solution.x.norm());
    }
}

TEST(DirectSolver, FindsNothingWhereNothingIsAskedFor) {
    SpringyBox problem(Precision::Double);
    problem.system.right().setZero();
    const BlockVector<kDim> guess = BlockVector<kDim>::Ones(kDim, problem.b.cols());
    const LinearSolution<kDim> solution =
        problem.direct()->solve(problem.system, guess, {.tolerance = 0.5}, guess);
    EXPECT_TRUE(solution.report.has_converged);
    EXPECT_TRUE(solution.x.isZero(0));
}

// What it says it takes beside elements is what decides.
TEST(DirectSolver, IsRefusedWhereItTakesMoreMemoryThanThereIs) {
    Scene scene = test::box_scene<4>();
    const auto bytes_by = [&](LinearSolverKind linear, std::int64_t memory) {
        scene.solver.linear = linear;
        return Simulation<4>(scene, {test::cube<4>(2)}, {.memory = memory}).size().matrix_bytes;
    };
    constexpr auto kDirect = LinearSolverKind::Direct;
    constexpr auto kIterative = LinearSolverKind::Iterative;
    const std::int64_t factor = bytes_by(kDirect, 0) - bytes_by(kIterative, 0);
    ASSERT_GT(factor, 0);
    EXPECT_GT(bytes_by(kDirect, factor), 0);
    EXPECT_GT(bytes_by(kIterative, 1), 0);
    const std::string error =
        pent::test::error_of([&] { static_cast<void>(bytes_by(kDirect, factor - 1)); });
    const auto megabytes = [](std::int64_t bytes) {
        return formatted("%.3g MB", static_cast<double>(bytes) / 1e6);
    };
    pent::test::expect_contains(error,
                                {"\"direct\" needs " + megabytes(factor) + " for ",
                                 ", of " + megabytes(factor - 1) + " that there are: use \"cg\""});
}

// One body on the other, with contact that couples them, one vertex held, and sleep.
Scene pile(LinearSolverKind linear) {
    Scene scene = test::two_cubes<4>(0);
    // On a cube of 0.25 m, of one cell; no vertex as near to one facet as to another, between which
    // rounding would choose.
    scene.bodies[1].place.translate = Eigen::Vector4d(0.041, 0.28, 0.027, 0.034);
    scene.gravity[1] = -9.8;
    scene.obstacles = {
        {.shape = HalfSpaceObstacle{.normal = Eigen::Vector4d::UnitY(), .offset = -0.03}}};
    scene.damping = Damping{.mass = 20};
    scene.sleep = Sleep{.speed = 0.2, .time = 0.03};
    scene.contact->friction = 0.3;
    scene.solver.linear = linear;
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-12;
    return scene;
}

TEST(DirectSolver, MovesAPileAsIterationsDoThroughContactSleepAndHeldVertices) {
    const SimplexMesh<4> mesh = test::cube<4>(1);
    Simulation<4> direct(pile(LinearSolverKind::Direct), {mesh, mesh});
    Simulation<4> threads(pile(LinearSolverKind::Direct), {mesh, mesh}, {.threads = 3});
    Simulation<4> often(pile(LinearSolverKind::Direct), {mesh, mesh});
    Simulation<4> iterations(pile(LinearSolverKind::Iterative), {mesh, mesh});
    bool has_touched = false;
    bool has_slept = false;
    for (int i = 0; i < 40; ++i) {
        for (Simulation<4>* simulation : {&direct, &threads, &often, &iterations}) {
            if (i == 3) {
                simulation->set_targets(0, {0}, simulation->positions(0).leftCols(1));
            } else if (i == 8) {
                simulation->release(0, {0});
            }
            const StepReport report = simulation->step();
            ASSERT_TRUE(report.is_accepted) << report.failure;
            ASSERT_LE(report.residual, 1e-12) << i;
            has_touched = has_touched || report.contact.point_facet > 0;
            has_slept = has_slept || report.asleep > 0;
        }
        test::expect_same(direct, threads);
        test::expect_same(direct, often);
        Simulation<4> next(pile(LinearSolverKind::Direct), {mesh, mesh});
        next.restore(often.save());
        often = std::move(next);
        for (int body = 0; body < 2; ++body) {
            // What iterations to 1e-12 leave, which contact and friction enlarge over 40 steps.
            ASSERT_LT((direct.positions(body) - iterations.positions(body)).norm(), 1e-6) << i;
        }
    }
    EXPECT_TRUE(has_touched);
    EXPECT_TRUE(has_slept);
}

}  // namespace
}  // namespace pent::simulator
