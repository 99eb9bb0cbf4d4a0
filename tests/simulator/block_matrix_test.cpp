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

}  // namespace
}  // namespace pent::simulator
