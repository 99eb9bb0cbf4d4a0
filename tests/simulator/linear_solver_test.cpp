#include "linear/linear_solver.h"

#include "elastic_box.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace pent::simulator {
namespace {

using test::ElasticBox;

constexpr int kDim = 4;

// The system of a step of a scrambled box: its stiffness, masses, and a spring between two far corners,
// which share no cell.
struct SpringyBox {
    ElasticBox<kDim> box{{.lame = {.lambda = 2, .mu = 1}}, {3, 7}};
    Workers workers{2};
    Eigen::VectorXd masses;
    Positions<kDim> shift;
    BlockVector<kDim> b;
    std::array<std::uint32_t, 2> ends{};
    std::array<double, 2> weights = {1, -1};
    Eigen::Matrix4d spring = 3 * Eigen::Matrix4d::Identity();
    NewtonSystem<kDim> system;

    explicit SpringyBox(Precision precision, double mass = 0.01)
        : system(workers, box.dofs, box.pattern, precision) {
        box.scramble(0.1, 1);
        std::mt19937 random(2);
        std::normal_distribution<double> normal;
        const Eigen::Index total = box.mesh.vertex_count();
        masses.setConstant(total, mass);
        shift = Positions<kDim>::Zero(kDim, total);
        shift.col(3).setConstant(0.1);
        b = BlockVector<kDim>::NullaryExpr(kDim, box.pattern.rows(),
                                           [&] { return normal(random); });
        ends = {0, static_cast<std::uint32_t>(total - 1)};
        system.begin(b, shift);
        std::visit(
            [&](auto& matrix) {
                box.elements->add_hessian(workers, kernels<kDim>(best_isa()), box.positions, 1,
                                          Filter::Clamp, shift, matrix, system.right());
            },
            system.matrix());
        system.add_masses(2, masses);
        system.add_stencil({.vertices = ends.data(),
                            .weights = weights.data(),
                            .matrix = spring.data(),
                            .count = 2,
                            .stride = kDim});
        system.finish();
    }

    [[nodiscard]] Eigen::MatrixXd dense() const {
        return std::visit(
            [](const auto& matrix) {
                return Eigen::MatrixXd(ElasticBox<kDim>::dense(matrix)
                                       + ElasticBox<kDim>::dense(*matrix.coupling()));
            },
            system.matrix());
    }

    [[nodiscard]] std::unique_ptr<LinearSolver<kDim>> iterative(PreconditionerKind kind) const {
        return make_iterative_solver<kDim>(
            workers, kernels<kDim>(best_isa()).blocks, kind,
            {.column_start = box.dofs.column_start(),
             .rest = at_dofs<kDim>(box.dofs, box.mesh.positions),
             .bodies = std::vector<std::uint32_t>(box.dofs.count(), 0)});
    }
    [[nodiscard]] LinearSolution<kDim> solve(LinearSolver<kDim>& solver, double tolerance) const {
        return solver.solve(system, at_dofs<kDim>(box.dofs, box.positions),
                            {.tolerance = tolerance},
                            BlockVector<kDim>::Zero(kDim, box.pattern.rows()));
    }
};

// M + K + spring with the parts of vertices without dofs on the right, put together from the
// stiffness of the box in which every vertex has a dof.
TEST(NewtonSystem, IsTheSumOfItsPartsLessTheShareOfVerticesWithoutDofs) {
    const SpringyBox problem(Precision::Double);
    ElasticBox<kDim> free({.lame = {.lambda = 2, .mu = 1}});
    free.positions = problem.box.positions;
    const Eigen::MatrixXd by_dof = free.stiffness<double>(best_isa(), Filter::Clamp);
    const Eigen::Index total = free.mesh.vertex_count();
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(kDim * total, kDim * total);
    for (std::uint32_t a = 0; a < total; ++a) {
        for (std::uint32_t c = 0; c < total; ++c) {
            full.block<kDim, kDim>(kDim * a, kDim * c) =
                by_dof.block<kDim, kDim>(kDim * free.dofs.dof_of(a), kDim * free.dofs.dof_of(c));
        }
        full.diagonal().segment<kDim>(kDim * a).array() += 2 * problem.masses[a];
    }
    for (const int i : {0, 1}) {
        for (const int j : {0, 1}) {
            full.block<kDim, kDim>(kDim * problem.ends[static_cast<std::size_t>(i)],
                                   kDim * problem.ends[static_cast<std::size_t>(j)]) +=
                (i == j ? 1 : -1) * problem.spring;
        }
    }
    const Eigen::MatrixXd matrix = problem.dense();
    const DofMap& dofs = problem.box.dofs;
    BlockVector<kDim> right = problem.b;
    for (std::uint32_t row = 0; row < dofs.count(); ++row) {
        for (std::uint32_t vertex = 0; vertex < total; ++vertex) {
            const Eigen::Matrix4d block =
                full.block<kDim, kDim>(kDim * dofs.vertex_of(row), kDim * vertex);
            if (dofs.has_dof(vertex)) {
                EXPECT_LT((matrix.block<kDim, kDim>(kDim * row, kDim * dofs.dof_of(vertex)) - block)
                              .norm(),
                          1e-13 * full.norm());
            } else {
                right.col(row) -= block * problem.shift.col(vertex);
            }
        }
    }
    EXPECT_LT((problem.system.right() - right).norm(), 1e-13 * right.norm());
    EXPECT_GT((problem.b - right).norm(), 1e-2 * right.norm());
}

TEST(NewtonSystem, SaysWhereMassesDrownInTheRoundingOfStiffness) {
    EXPECT_FALSE(SpringyBox(Precision::Float, 1e-3).system.has_lost_inertia());
    EXPECT_TRUE(SpringyBox(Precision::Float, 1e-9).system.has_lost_inertia());
    EXPECT_FALSE(SpringyBox(Precision::Double, 1e-9).system.has_lost_inertia());
}

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
    const LinearSolution<kDim> direct = problem.solve(*make_direct_solver<kDim>(), 1e-12);
    EXPECT_TRUE(direct.report.has_converged);
    EXPECT_LT((direct.x.reshaped() - expected).norm(), 1e-11 * expected.norm());
}

TEST(DirectSolver, LeavesTheResidualOfRoundingWhateverBlocksAreStoredIn) {
    for (const Precision precision : {Precision::Float, Precision::Double}) {
        const SpringyBox problem(precision);
        const LinearSolution<kDim> solution = problem.solve(*make_direct_solver<kDim>(), 0.5);
        // Backward stable: the solution of a matrix a few roundings in double away.
        const double roundings = 4 * std::numeric_limits<double>::epsilon();
        EXPECT_LT(solution.report.residual * problem.system.right().norm(),
                  roundings * problem.dense().norm() * solution.x.norm());
    }
}

TEST(LinearSolvers, ReportAMatrixThatIsNotPositiveDefinite) {
    SpringyBox problem(Precision::Double);
    auto& matrix = std::get<BlockMatrix<kDim, double>>(problem.system.matrix());
    matrix.diagonal(3).setZero();
    matrix.diagonal(3).diagonal().setConstant(-1);
    std::vector<std::unique_ptr<LinearSolver<kDim>>> solvers;
    solvers.push_back(problem.iterative(PreconditionerKind::ColumnJacobi));
    solvers.push_back(make_direct_solver<kDim>());
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
    solvers.push_back(make_direct_solver<kDim>());
    for (const auto& solver : solvers) {
        const LinearSolution<kDim> solution = problem.solve(*solver, 1e-8);
        EXPECT_TRUE(solution.report.has_converged);
        EXPECT_EQ(solution.x.norm(), 0);
    }
}

}  // namespace
}  // namespace pent::simulator
