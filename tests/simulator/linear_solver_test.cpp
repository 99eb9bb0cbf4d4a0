#include "linear/linear_solver.h"

#include "springy_box.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <random>

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
    matrix.set_block(matrix.diagonal_of(3), -Eigen::Matrix4d::Identity());
    std::vector<std::unique_ptr<LinearSolver<kDim>>> solvers;
    solvers.push_back(problem.iterative(PreconditionerKind::ColumnJacobi));
    solvers.push_back(problem.direct());
    for (const auto& solver : solvers) {
        const LinearSolution<kDim> solution = problem.solve(*solver, 1e-8);
        EXPECT_TRUE(solution.report.has_broken_down);
        EXPECT_FALSE(solution.report.has_converged);
    }
}

// A free box, whose rigid motions the masses alone resist: 1e-9 of the stiffness, a hundredth of
// what floats round away of it.
struct LightBox {
    test::ElasticBox<kDim> box{{.lame = {.lambda = 2, .mu = 1}}};
    Workers workers{2};
    NewtonSystem<kDim> system;

    explicit LightBox(Precision precision) : system(workers, box.dofs, box.pattern, precision) {
        std::mt19937 random(1);
        std::normal_distribution<double> normal;
        system.begin(BlockVector<kDim>::NullaryExpr(kDim, box.pattern.rows(),
                                                    [&] { return normal(random); }),
                     0 * box.positions);
        std::visit(
            [&](auto& matrix) {
                box.elements->add_hessian(workers, kernels<kDim>(best_isa()), box.positions,
                                          target_in(matrix, 1, Filter::Clamp));
            },
            system.matrix());
        system.add_masses(1, Eigen::VectorXd::Constant(box.positions.cols(), kMass));
        system.weigh_masses();
        system.finish();
    }

    // How far a solution is from that of the dense factorization in double, which loses seven
    // digits of its sixteen; in parts of it.
    [[nodiscard]] double error_of(LinearSolver<kDim>& solver) const {
        Eigen::MatrixXd dense = box.stiffness<double>(best_isa(), Filter::Clamp);
        dense.diagonal().array() += kMass;
        const Eigen::VectorXd expected = dense.ldlt().solve(system.right().reshaped()).eval();
        const BlockVector<kDim> zero = 0 * system.right();
        const LinearSolution<kDim> solution =
            solver.solve(system, at_dofs<kDim>(box.dofs, box.positions), {.tolerance = 1e-9}, zero);
        return (solution.x.reshaped() - expected).norm() / expected.norm();
    }

    static constexpr double kMass = 1e-9;
};

TEST(LinearSolvers, AreRightInDoubleWhereFloatsLoseTheMassesAndTheSystemSaysSo) {
    for (const Precision precision : {Precision::Float, Precision::Double}) {
        const LightBox problem(precision);
        const bool is_float = precision == Precision::Float;
        EXPECT_EQ(problem.system.has_lost_inertia(), is_float);
        const BlockVector<kDim> rest = at_dofs<kDim>(problem.box.dofs, problem.box.positions);
        std::vector<std::unique_ptr<LinearSolver<kDim>>> solvers;
        for (const PreconditionerKind kind :
             {PreconditionerKind::ColumnJacobi, PreconditionerKind::RigidModes}) {
            solvers.push_back(make_iterative_solver<kDim>(
                problem.workers, kernels<kDim>(best_isa()).blocks, kind,
                {.column_start = problem.box.dofs.column_start(), .rest = rest}));
        }
        solvers.push_back(make_direct_solver<kDim>(kernels<kDim>(best_isa()).blocks, rest));
        for (const auto& solver : solvers) {
            const double error = problem.error_of(*solver);
            EXPECT_TRUE(is_float ? !(error < 0.1) : error < 1e-5) << error;
        }
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
