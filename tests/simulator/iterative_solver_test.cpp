#include "linear/linear_solver.h"
#include "springy_box.h"

#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using test::SpringyBox;

constexpr int kDim = test::kBoxDim;

// The residual that counts is computed from the solution, not carried along.
TEST(IterativeSolver, ReportsTheResidualOfWhatItGives) {
    for (const Precision precision : {Precision::Float, Precision::Double}) {
        const SpringyBox problem(precision);
        const auto solver = problem.iterative(PreconditionerKind::RigidModes);
        for (const double tolerance : {1e-1, 1e-3, 1e-5}) {
            const LinearSolution<kDim> solution = problem.solve(*solver, tolerance);
            const Eigen::VectorXd b = problem.system.right().reshaped();
            const double left = (b - problem.dense() * solution.x.reshaped()).norm() / b.norm();
            EXPECT_TRUE(solution.report.has_converged);
            EXPECT_LE(solution.report.residual, tolerance);
            EXPECT_NEAR(solution.report.residual, left, 1e-6);  // the product is in float
        }
    }
}

TEST(IterativeSolver, StopsAtItsMostIterationsAndSaysThatItHasNotConverged) {
    const SpringyBox problem(Precision::Double);
    const auto solver = problem.iterative(PreconditionerKind::BlockJacobi);
    const BlockVector<kDim> zero = BlockVector<kDim>::Zero(kDim, problem.box.pattern.rows());
    const auto report =
        solver->solve(problem.system, zero, {.tolerance = 1e-12, .max_iterations = 3}, zero).report;
    EXPECT_EQ(report.iterations, 3);
    EXPECT_FALSE(report.has_converged);
    EXPECT_FALSE(report.has_broken_down);
    EXPECT_GT(report.residual, 1e-12);
}

TEST(IterativeSolver, TakesNoIterationFromTheSolution) {
    const SpringyBox problem(Precision::Double);
    const auto solver = problem.iterative(PreconditionerKind::ColumnJacobi);
    const LinearSolution<kDim> first = problem.solve(*solver, 1e-10);
    EXPECT_GT(first.report.iterations, 0);
    const LinearSolution<kDim> again =
        solver->solve(problem.system, at_dofs<kDim>(problem.box.dofs, problem.box.positions),
                      {.tolerance = 1e-10}, first.x);
    EXPECT_EQ(again.report.iterations, 0);
    EXPECT_EQ(again.x, first.x);
}

TEST(IterativeSolver, GivesTheSameBitsTwice) {
    const SpringyBox problem(Precision::Float);
    const auto solver = problem.iterative(PreconditionerKind::RigidModes);
    const LinearSolution<kDim> first = problem.solve(*solver, 1e-5);
    EXPECT_EQ(problem.solve(*solver, 1e-5).x, first.x);
}

}  // namespace
}  // namespace pent::simulator
