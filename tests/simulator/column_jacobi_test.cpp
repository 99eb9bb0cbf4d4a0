#include "preconditioner_cases.h"

#include <Eigen/Cholesky>

#include <limits>
#include <numeric>

namespace pent::simulator {
namespace {

using test::ElasticBox;
using test::iterations;
using Fixture = test::ScrambledBox;

BlockVector<4> solved(const BlockMatrix<4, double>& A,
                      const std::vector<std::uint32_t>& columns,
                      const BlockVector<4>& r,
                      Isa isa) {
    const Workers workers(1);
    BlockVector<4> z(4, A.rows());
    column_jacobi(workers, kernels<4>(isa).blocks, A, columns)->apply(workers, r, z);
    return z;
}

// Columns of neighboring dofs: the preconditioner must solve with the dense matrix of each.
TEST(ColumnJacobi, SolvesWithTheBandOfBlocksOfEveryColumnOnEveryInstructionSet) {
    const Fixture f;
    const auto n = static_cast<std::uint32_t>(f.A.rows());
    const std::vector<std::uint32_t> columns = {0, 1, 4, 9, 10, n};
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
    for (const Isa isa : test::supported_isas()) {
        const BlockVector<4> z = solved(f.A, columns, f.r, isa);
        // Factors are kept in float.
        EXPECT_LT((z.reshaped() - expected).norm(), 1e-5 * expected.norm()) << isa_name(isa);
    }
}

TEST(ColumnJacobi, ReturnsWhatItIsGivenTimesWhatItMakesOfIt) {
    const Fixture f;
    const auto n = static_cast<std::uint32_t>(f.A.rows());
    std::vector<std::uint32_t> columns(n + 1);
    std::iota(columns.begin(), columns.end(), 0U);
    for (const int threads : {1, 3}) {
        const Workers workers(threads);
        BlockVector<4> z(4, f.A.rows());
        const double product = column_jacobi(workers, kernels<4>(best_isa()).blocks, f.A, columns)
                                   ->apply(workers, f.r, z);
        EXPECT_NEAR(product, f.r.cwiseProduct(z).sum(), 1e-14 * f.r.norm() * z.norm());
    }
}

// It is solved by its diagonal blocks; the columns beside it, in the lanes of the same vectors, are
// none the worse.
TEST(ColumnJacobi, TakesAColumnThatIsNotPositiveDefiniteApart) {
    const Fixture f;
    BlockMatrix<4, double> A = f.A;
    const BlockPattern& pattern = A.pattern();
    std::uint32_t row = 1;  // coupled with the next
    while (pattern.columns[static_cast<std::size_t>(pattern.row_start[row]) + 1] != row + 1) {
        ++row;
    }
    A.set_block(pattern.row_start[row] + 1, Eigen::Matrix4d::Constant(1e3));
    const std::vector<std::uint32_t> columns = {0, row, row + 2, row + 3};
    const std::vector<std::uint32_t> cut = {0, row, row + 1, row + 2, row + 3};
    const Eigen::Index solved_for = row + 3;
    for (const Isa isa : test::supported_isas()) {
        const BlockVector<4> z = solved(A, columns, f.r, isa).leftCols(solved_for);
        const BlockVector<4> expected = solved(A, cut, f.r, isa).leftCols(solved_for);
        // Factors are kept in float.
        EXPECT_LT((z - expected).norm(), 1e-6 * expected.norm()) << isa_name(isa);
    }
}

// One column of two dofs among single ones: it is found wherever it is.
TEST(ColumnJacobi, SolvesForAPairAmongSingleVertices) {
    const Fixture f;
    const Eigen::MatrixXd whole = ElasticBox<4>::dense(f.A);
    const auto n = static_cast<std::uint32_t>(f.A.rows());
    for (std::uint32_t pair = 0; pair + 1 < n; ++pair) {
        std::vector<std::uint32_t> columns;
        for (std::uint32_t dof = 0; dof <= n; ++dof) {
            if (dof != pair + 1) {
                columns.push_back(dof);
            }
        }
        const BlockVector<4> z = solved(f.A, columns, f.r, Isa::Baseline);
        const Eigen::VectorXd expected =
            whole.block<8, 8>(4 * pair, 4 * pair).llt().solve(f.r.middleCols<2>(pair).reshaped());
        // Factors are kept in float.
        EXPECT_LT((z.middleCols<2>(pair).reshaped() - expected).norm(), 1e-5 * expected.norm());
    }
}

// A diagonal block that is no better alone: what it is given is left to it, and the columns on both
// sides are solved for as ever.
TEST(ColumnJacobi, LeavesAVertexWhoseBlockIsNotPositiveDefiniteAsItIs) {
    const Fixture f;
    const auto n = static_cast<std::uint32_t>(f.A.rows());
    const std::vector<std::uint32_t> columns = {0, 4, 8, 12, n};
    const std::vector<std::uint32_t> cut = {0, 4, 5, 6, 7, 8, 12, n};
    const BlockVector<4> expected = solved(f.A, cut, f.r, Isa::Baseline);
    BlockMatrix<4, double> A = f.A;
    for (const double value : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
        A.set_block(A.diagonal_of(5), value * Eigen::Matrix4d::Identity());
        for (const Isa isa : test::supported_isas()) {
            const BlockVector<4> z = solved(A, columns, f.r, isa);
            EXPECT_EQ(z.col(5), f.r.col(5));
            for (std::uint32_t dof = 0; dof < n; ++dof) {
                if (dof != 5) {
                    // Factors are kept in float.
                    EXPECT_LT((z.col(dof) - expected.col(dof)).norm(),
                              1e-5 * expected.col(dof).norm())
                        << isa_name(isa) << ", " << dof;
                }
            }
        }
    }
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
        const BlockVector<4> z = solved(A, {0, 7}, r, Isa::Baseline);
        const Eigen::VectorXd expected = ElasticBox<4>::dense(A).llt().solve(r.reshaped());
        EXPECT_LT((z.reshaped() - expected).norm(), 1e-5 * expected.norm());  // kept in float
    }
}

TEST(ColumnJacobi, IsTheInverseOfTheDiagonalForSingleVertices) {
    const Fixture f;
    std::vector<std::uint32_t> columns(static_cast<std::size_t>(f.A.rows()) + 1);
    std::iota(columns.begin(), columns.end(), 0U);
    const BlockVector<4> z = solved(f.A, columns, f.r, Isa::Baseline);
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
