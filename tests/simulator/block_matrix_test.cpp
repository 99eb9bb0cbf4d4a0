#include "linear/block_matrix.h"

#include "elastic_box.h"

#include <gtest/gtest.h>

#include <random>

namespace pent::simulator {
namespace {

using test::ElasticBox;

template <int Dim, typename Scalar>
void expect_product_matches_dense() {
    ElasticBox<Dim> box({.lame = {.lambda = 1, .mu = 1}}, {2});
    BlockMatrix<Dim, Scalar> matrix(box.pattern);
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (std::int64_t k = 0; k < box.pattern.blocks() * Dim * Dim; ++k) {
        matrix.values()[k] = static_cast<Scalar>(normal(random));
    }
    for (std::int64_t row = 0; row < matrix.rows(); ++row) {
        const Eigen::Matrix<Scalar, Dim, Dim> block = matrix.diagonal(row);
        matrix.diagonal(row) = block + block.transpose();
    }
    const BlockVector<Dim> x =
        BlockVector<Dim>::NullaryExpr(Dim, matrix.rows(), [&]() { return normal(random); });
    const Eigen::VectorXd expected = ElasticBox<Dim>::dense(matrix) * x.reshaped();
    for (const Isa isa : test::supported_isas()) {
        BlockVector<Dim> y(Dim, matrix.rows());
        matrix.multiply(Workers(2), kernels<Dim>(isa).blocks, x, y);
        EXPECT_LT((y.reshaped() - expected).norm(), 1e-13 * expected.norm()) << isa_name(isa);
    }
}

TEST(BlockMatrix, MultipliesAsTheDenseMatrixDoes) {
    expect_product_matches_dense<3, float>();
    expect_product_matches_dense<3, double>();
    expect_product_matches_dense<4, float>();
    expect_product_matches_dense<4, double>();
}

TEST(BlockPattern, HoldsEveryPairOfFreeVerticesOfACellOnceAndInOrder) {
    ElasticBox<4> box({.lame = {.lambda = 1, .mu = 1}}, {5, 6});
    const BlockPattern& pattern = box.pattern;
    EXPECT_EQ(pattern.rows(), box.mesh.vertex_count() - 2);
    for (std::int64_t row = 0; row < pattern.rows(); ++row) {
        const auto r = static_cast<std::size_t>(row);
        EXPECT_EQ(pattern.columns[static_cast<std::size_t>(pattern.row_start[r])], row);
        for (std::int64_t k = pattern.row_start[r] + 1; k < pattern.row_start[r + 1]; ++k) {
            const auto i = static_cast<std::size_t>(k);
            EXPECT_GT(pattern.columns[i], pattern.columns[i - 1]);
        }
    }
    for (Eigen::Index cell = 0; cell < box.mesh.cell_count(); ++cell) {
        for (int a = 0; a <= 4; ++a) {
            for (int b = 0; b <= 4; ++b) {
                const auto row = box.dofs.rank_of(box.mesh.cells(a, cell));
                const auto column = box.dofs.rank_of(box.mesh.cells(b, cell));
                if (row <= column && column < box.dofs.count()) {
                    const auto at = static_cast<std::size_t>(pattern.find(row, column));
                    EXPECT_EQ(pattern.columns[at], column);
                    EXPECT_LT(at, static_cast<std::size_t>(pattern.row_start[row + 1]));
                }
            }
        }
    }
}

}  // namespace
}  // namespace pent::simulator
