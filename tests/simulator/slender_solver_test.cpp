#include "elastic_box.h"
#include "linear/linear_solver.h"
#include "support/kuhn_box.h"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <array>

namespace pent::simulator {
namespace {

using test::ElasticBox;

// A chain of cells, or a box, held at one end and bent by a force on everything.
template <int Dim>
struct Chain {
    ElasticBox<Dim> box;
    Workers workers;
    NewtonSystem<Dim> system;

    Chain(const std::array<int, Dim>& cells, double stiffness, Precision precision, int threads)
        : Chain(pent::test::kuhn_box<Dim>(cells, sizes(cells)), stiffness, precision, threads) {}

    Chain(const SimplexMesh<Dim>& mesh, double stiffness, Precision precision, int threads)
        : box(mesh,
              {.lame = {.lambda = 2 * stiffness, .mu = stiffness}},
              ElementKind::Linear,
              at_one_end(mesh)),
          workers(threads),
          system(workers, box.dofs, box.pattern, precision) {
        BlockVector<Dim> b = BlockVector<Dim>::Zero(Dim, box.pattern.rows());
        b.row(1).setOnes();
        system.begin(b, Positions<Dim>::Zero(Dim, box.mesh.vertex_count()));
        std::visit(
            [&](auto& matrix) {
                box.elements->add_hessian(workers, kernels<Dim>(best_isa()), box.positions,
                                          target_in(matrix, 1, Filter::Clamp));
            },
            system.matrix());
        system.add_masses(1, Eigen::VectorXd::Constant(box.mesh.vertex_count(), 1));
        system.weigh_masses();
        system.finish();
    }

    static std::array<double, Dim> sizes(const std::array<int, Dim>& cells) {
        std::array<double, Dim> size{};
        for (std::size_t axis = 0; axis < size.size(); ++axis) {
            size[axis] = cells[axis];
        }
        return size;
    }
    static std::vector<bool> at_one_end(const SimplexMesh<Dim>& mesh) {
        std::vector<bool> held;
        for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
            held.push_back(mesh.positions(0, v) > -0.5 && mesh.positions(0, v) < 0.5);
        }
        return held;
    }

    [[nodiscard]] LinearSolution<Dim> solve(LinearSolver<Dim>& solver, double tolerance) const {
        return solver.solve(system, at_dofs<Dim>(box.dofs, box.positions), {.tolerance = tolerance},
                            BlockVector<Dim>::Zero(Dim, box.pattern.rows()));
    }
    [[nodiscard]] LinearSolution<Dim> solve(PreconditionerKind kind, double tolerance) const {
        const auto solver =
            make_iterative_solver<Dim>(workers, kernels<Dim>(best_isa()).blocks, kind,
                                       {.column_start = box.dofs.column_start(),
                                        .rest = at_dofs<Dim>(box.dofs, box.mesh.positions)});
        return solve(*solver, tolerance);
    }
    // What a product with the matrix finds is left of the right hand side.
    [[nodiscard]] double left_by(const LinearSolution<Dim>& solution) const {
        BlockVector<Dim> product(Dim, box.pattern.rows());
        std::visit(
            [&](const auto& A) {
                A.multiply(workers, kernels<Dim>(Isa::Baseline).blocks, solution.x, product);
            },
            system.matrix());
        return (system.right() - product).norm() / system.right().norm();
    }
};

// What is left is what rounding in double leaves, of blocks of both precisions, whose rounding may
// matter, and for any threads.
template <int Dim>
void expect_factors_of_a_chain(const std::array<int, Dim>& cells, double stiffness) {
    for (const Precision precision : {Precision::Float, Precision::Double}) {
        const Chain<Dim> chain(cells, stiffness, precision, 1);
        const LinearSolution<Dim> slow = chain.solve(PreconditionerKind::ColumnJacobi, 1e-4);
        const LinearSolution<Dim> found = chain.solve(PreconditionerKind::RigidModes, 1e-4);
        ASSERT_TRUE(found.report.has_converged);
        EXPECT_FALSE(found.report.is_slow);
        EXPECT_GT(chain.left_by(slow), 1e-6);  // they end where they may
        EXPECT_LT(10 * found.report.iterations, slow.report.iterations);
        EXPECT_LT(found.report.iterations, 40);
        EXPECT_LT(chain.left_by(found), 1e-10);
        const auto direct =
            make_direct_solver<Dim>(kernels<Dim>(best_isa()).blocks,
                                    at_dofs<Dim>(chain.box.dofs, chain.box.mesh.positions));
        const LinearSolution<Dim> factored = chain.solve(*direct, 1e-4);
        EXPECT_LT(chain.left_by(factored), 1e-10);
        const LinearSolution<Dim> by_three =
            Chain<Dim>(cells, stiffness, precision, 3).solve(PreconditionerKind::RigidModes, 1e-4);
        EXPECT_EQ(by_three.x, found.x);
        EXPECT_EQ(by_three.report.iterations, found.report.iterations);
    }
}

TEST(SlenderSolver, FactorsAChainThatIterationsTakeLongFor) {
    expect_factors_of_a_chain<3>({120, 1, 1}, 300);
    expect_factors_of_a_chain<3>({120, 1, 1}, 1e4);
    expect_factors_of_a_chain<4>({120, 1, 1, 1}, 1e4);
}

// A cell apart whose matrix is negative, and which nothing pulls at, so that no direction of
// iterations has a part of it: they go on where factors have a pivot that is not positive.
TEST(SlenderSolver, GoesOnByIterationsWhereAPivotIsNotPositive) {
    constexpr std::array kCells = {80, 1, 1};
    SimplexMesh<3> mesh = pent::test::kuhn_box<3>(kCells, Chain<3>::sizes(kCells));
    const auto count = static_cast<std::uint32_t>(mesh.vertex_count());
    mesh.positions.conservativeResize(3, count + 4);
    mesh.positions.rightCols(4).setZero();
    mesh.positions.rightCols(3).setIdentity();
    mesh.positions.rightCols(4).row(0).array() -= 10;
    mesh.cells.conservativeResize(4, mesh.cells.cols() + 1);
    mesh.cells.rightCols(1) << count, count + 1, count + 2, count + 3;
    Chain<3> chain(mesh, 300, Precision::Double, 1);
    auto& A = std::get<BlockMatrix<3, double>>(chain.system.matrix());
    for (std::uint32_t v = count; v < count + 4; ++v) {
        const std::uint32_t dof = chain.box.dofs.dof_of(v);
        A.add_to_diagonal(dof, -1e6);
        chain.system.right().col(dof).setZero();
    }
    const LinearSolution<3> found = chain.solve(PreconditionerKind::RigidModes, 1e-4);
    EXPECT_TRUE(found.report.has_converged);
    EXPECT_FALSE(found.report.is_slow);
    EXPECT_LE(chain.left_by(found), 1e-4);
    EXPECT_GT(chain.left_by(found), 1e-8);
    EXPECT_GT(found.report.iterations, 30);
}

// Where iterations are few they end at the tolerance as they always did, and so do those of bodies
// whose factors are large.
TEST(SlenderSolver, LeavesOthersToIterations) {
    const Chain<3> soft({120, 1, 1}, 0.1, Precision::Float, 1);
    const Chain<3> thick({7, 7, 7}, 1e4, Precision::Float, 1);
    for (const Chain<3>* box : {&soft, &thick}) {
        const LinearSolution<3> found = box->solve(PreconditionerKind::RigidModes, 1e-4);
        EXPECT_TRUE(found.report.has_converged);
        EXPECT_GT(found.report.residual, 1e-7);
    }
}

}  // namespace
}  // namespace pent::simulator
