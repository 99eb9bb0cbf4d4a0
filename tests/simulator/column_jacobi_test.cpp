#include "preconditioner_cases.h"

#include <Eigen/Cholesky>

#include <numeric>

namespace pent::simulator {
namespace {

using test::ElasticBox;
using test::iterations;
using Fixture = test::ScrambledBox;

// Columns of neighboring unknowns: the preconditioner must solve with the dense matrix of each.
TEST(ColumnJacobi, SolvesWithTheBandOfBlocksOfEveryColumn) {
    const Fixture f;
    const auto n = static_cast<std::uint32_t>(f.A.rows());
    const std::vector<std::uint32_t> columns = {0, 1, 4, 9, 10, n};
    const auto preconditioner = column_jacobi(f.workers, f.A, columns);
    BlockVector<4> z(4, f.A.rows());
    preconditioner->apply(f.workers, f.r, z);
    Eigen::MatrixXd part = ElasticBox<4>::dense(f.A);
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const auto column_of = [&](std::uint32_t k) {
                return std::upper_bound(columns.begin(), columns.end(), k) - columns.begin();
            };
            if (column_of(i) != column_of(j) || i > j + 2 || j > i + 2) {
                part.block<4, 4>(4 * i, 4 * j).setZero();
            }
        }
    }
    ASSERT_EQ(part.llt().info(), Eigen::Success);
    const Eigen::VectorXd expected = part.llt().solve(f.r.reshaped());
    // Factors are kept in float.
    EXPECT_LT((z.reshaped() - expected).norm(), 1e-5 * expected.norm());
}

// The columns of an extruded box couple only layers that are neighbors, or, with quadratic
// elements, two apart: nothing is left out, and the preconditioner solves a single column exactly.
TEST(ColumnJacobi, LeavesNothingOfAColumnOutForAnyElements) {
    for (const ElementKind kind :
         {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic}) {
        SimplexMesh<4> mesh = pent::test::quadratic_kuhn_box<4>({1, 1, 1, 3}, {1, 1, 1, 0.1});
        std::vector<bool> is_held(static_cast<std::size_t>(mesh.vertex_count()), false);
        Columns columns;
        for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
            columns.columns.push_back(v % 27);
            columns.layers.push_back(v / 27);
            is_held[v] = v % 27 != 13;  // all but one column
        }
        mesh.columns = columns.columns;
        mesh.layers = columns.layers;
        ElasticBox<4> box(mesh, {.lame = {.lambda = 2, .mu = 1}}, kind, is_held);
        ASSERT_EQ(box.dofs.count(), 7);
        BlockMatrix<4, double> A(box.pattern);
        box.elements->add_hessian(Workers(1), kernels<4>(Isa::Baseline), box.positions,
                                  target_in(A, 1, Filter::Clamp));
        const BlockVector<4> r = BlockVector<4>::Random(4, 7);
        BlockVector<4> z(4, 7);
        column_jacobi(Workers(1), A, {0, 7})->apply(Workers(1), r, z);
        const Eigen::VectorXd expected = ElasticBox<4>::dense(A).llt().solve(r.reshaped());
        EXPECT_LT((z.reshaped() - expected).norm(), 1e-5 * expected.norm());  // kept in float
    }
}

TEST(ColumnJacobi, IsTheInverseOfTheDiagonalForSingleVertices) {
    const Fixture f;
    std::vector<std::uint32_t> columns(static_cast<std::size_t>(f.A.rows()) + 1);
    std::iota(columns.begin(), columns.end(), 0U);
    BlockVector<4> z(4, f.A.rows());
    column_jacobi(f.workers, f.A, columns)->apply(f.workers, f.r, z);
    for (std::int64_t row = 0; row < f.A.rows(); ++row) {
        const Eigen::Vector4d back = f.A.diagonal(row) * z.col(row);
        EXPECT_LT((back - f.r.col(row)).norm(), 1e-5 * f.r.col(row).norm());
    }
}

TEST(ColumnJacobi, TakesThinLayersBetterThanBlockJacobi) {
    EXPECT_LT(iterations(PreconditionerKind::ColumnJacobi, {.thickness = 0.04}),
              iterations(PreconditionerKind::BlockJacobi, {.thickness = 0.04}) / 2);
}

}  // namespace
}  // namespace pent::simulator
