#include "linear/linear_solver.h"

#include "springy_box.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using test::SpringyBox;

constexpr int kDim = test::kBoxDim;

TEST(LinearSolvers, FindTheSolutionOfTheDenseFactorization) {
    const SpringyBox problem(Precision::Double);
    const Eigen::VectorXd expected =
        problem.dense().ldlt().solve(problem.system.right().reshaped()).eval();
    for (const PreconditionerKind kind :
         {PreconditionerKind::BlockJacobi, PreconditionerKind::ColumnJacobi,
          PreconditionerKind::RigidModes}) {
        const auto solver = problem.iterative(kind);
        const LinearSolution<kDim> solution = problem.solve(*solver, 1e-12);
        EXPECT_TRUE(solution.report.has_converged);
        EXPECT_LE(solution.report.residual, 1e-12);
        EXPECT_GT(solution.report.iterations, 0);
        // Condition about 1e4 times the residual.
        EXPECT_LT((solution.x.reshaped() - expected).norm(), 1e-8 * expected.norm());
    }
    const LinearSolution<kDim> direct = problem.solve(*problem.direct(), 1e-12);
    EXPECT_TRUE(direct.report.has_converged);
    EXPECT_LT((direct.x.reshaped() - expected).norm(), 1e-11 * expected.norm());
}

TEST(LinearSolvers, ReportAMatrixThatIsNotPositiveDefinite) {
    SpringyBox problem(Precision::Double);
    auto& matrix = std::get<BlockMatrix<kDim, double>>(problem.system.matrix());
    matrix.diagonal(3).setZero();
    matrix.diagonal(3).diagonal().setConstant(-1);
    std::vector<std::unique_ptr<LinearSolver<kDim>>> solvers;
    solvers.push_back(problem.iterative(PreconditionerKind::ColumnJacobi));
    solvers.push_back(problem.direct());
    for (const auto& solver : solvers) {
        const LinearSolution<kDim> solution = problem.solve(*solver, 1e-8);
        EXPECT_TRUE(solution.report.has_broken_down);
        EXPECT_FALSE(solution.report.has_converged);
    }
}

TEST(LinearSolvers, GiveZeroForZero) {
    SpringyBox problem(Precision::Double);
    problem.system.right().setZero();
    std::vector<std::unique_ptr<LinearSolver<kDim>>> solvers;
    solvers.push_back(problem.iterative(PreconditionerKind::RigidModes));
    solvers.push_back(problem.direct());
    for (const auto& solver : solvers) {
        const LinearSolution<kDim> solution = problem.solve(*solver, 1e-8);
        EXPECT_TRUE(solution.report.has_converged);
        EXPECT_EQ(solution.x.norm(), 0);
    }
}

}  // namespace
}  // namespace pent::simulator
