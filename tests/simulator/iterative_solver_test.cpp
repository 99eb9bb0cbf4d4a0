#include "linear/conjugate_gradients.h"
#include "linear/linear_solver.h"
#include "springy_box.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>
#include <utility>
#include <vector>

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

// Two vertices to a column, which are not those of the mesh.
std::vector<std::uint32_t> pairs(std::uint32_t rows) {
    std::vector<std::uint32_t> start;
    for (std::uint32_t row = 0; row < rows; row += 2) {
        start.push_back(row);
    }
    start.push_back(rows);
    return start;
}

// The preconditioner that a kind stands for, put together by hand, for all blocks that there are:
// the spring couples corners that share no cell.
template <typename Scalar>
LinearSolution<kDim> by_hand(const SpringyBox& problem,
                             PreconditionerKind kind,
                             std::uint32_t rows,
                             const BlockVector<kDim>& positions,
                             const LinearSolveOptions& options) {
    const auto& A = std::get<BlockMatrix<kDim, Scalar>>(problem.system.matrix());
    const BlockKernels& blocks = kernels<kDim>(best_isa()).blocks;
    const std::vector<std::uint32_t> columns = pairs(rows);
    std::vector<std::uint32_t> single(rows + std::size_t{1});
    std::iota(single.begin(), single.end(), 0U);
    const Hierarchy hierarchy(
        make_hierarchy<kDim>(A.pattern(), columns,
                             at_dofs<kDim>(problem.box.dofs, problem.box.mesh.positions)),
        A.pattern(), &A.coupling()->pattern());
    std::unique_ptr<Preconditioner<kDim>> preconditioner = column_jacobi(
        problem.workers, blocks, A, kind == PreconditionerKind::BlockJacobi ? single : columns);
    if (kind == PreconditionerKind::RigidModes) {
        preconditioner =
            multilevel(problem.workers, blocks, A, hierarchy, positions, std::move(preconditioner));
    }
    return ConjugateGradients<kDim>(problem.workers, blocks)
        .solve(A, *preconditioner, problem.system.right(), options,
               BlockVector<kDim>::Zero(kDim, rows));
}

TEST(IterativeSolver, HasThePreconditionerThatItIsAskedForOfAllBlocks) {
    for (const Precision precision : {Precision::Float, Precision::Double}) {
        const SpringyBox problem(precision);
        const std::uint32_t rows = problem.box.dofs.count();
        const BlockVector<kDim> positions = at_dofs<kDim>(problem.box.dofs, problem.box.positions);
        const LinearSolveOptions options{.tolerance = 1e-5};
        std::set<int> iterations;
        for (const PreconditionerKind kind :
             {PreconditionerKind::BlockJacobi, PreconditionerKind::ColumnJacobi,
              PreconditionerKind::RigidModes}) {
            const auto solver = make_iterative_solver<kDim>(
                problem.workers, kernels<kDim>(best_isa()).blocks, kind,
                {.column_start = pairs(rows),
                 .rest = at_dofs<kDim>(problem.box.dofs, problem.box.mesh.positions)});
            const LinearSolution<kDim> expected =
                precision == Precision::Float
                    ? by_hand<float>(problem, kind, rows, positions, options)
                    : by_hand<double>(problem, kind, rows, positions, options);
            // The second time with what is left of the first.
            for (int time = 0; time < 2; ++time) {
                const LinearSolution<kDim> found = solver->solve(
                    problem.system, positions, options, BlockVector<kDim>::Zero(kDim, rows));
                EXPECT_EQ(found.report.iterations, expected.report.iterations);
                EXPECT_EQ(found.x, expected.x);
            }
            iterations.insert(expected.report.iterations);
        }
        EXPECT_EQ(iterations.size(), 3U);  // so that none is taken for another
    }
}

}  // namespace
}  // namespace pent::simulator
