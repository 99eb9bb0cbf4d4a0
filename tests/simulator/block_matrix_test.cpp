#include "linear/block_matrix.h"

#include "cut_matrix.h"
#include "elastic_box.h"

#include <gtest/gtest.h>

#include <random>

namespace pent::simulator {
namespace {

using test::CutMatrix;
using test::ElasticBox;

template <int Dim, typename Scalar>
BlockMatrix<Dim, Scalar> random_matrix(const BlockPattern& pattern) {
    BlockMatrix<Dim, Scalar> matrix(pattern);
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (std::int64_t k = 0; k < pattern.blocks() * Dim * Dim; ++k) {
        matrix.values()[k] = static_cast<Scalar>(normal(random));
    }
    for (std::int64_t row = 0; row < matrix.rows(); ++row) {
        const Eigen::Matrix<Scalar, Dim, Dim> block = matrix.diagonal(row);
        matrix.set_block(matrix.diagonal_of(row), block + block.transpose());
    }
    return matrix;
}

template <int Dim>
BlockVector<Dim> random_vector(Eigen::Index columns) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    return BlockVector<Dim>::NullaryExpr(Dim, columns, [&]() { return normal(random); });
}

template <int Dim, typename Scalar>
void expect_product_matches_dense() {
    ElasticBox<Dim> box({.lame = {.lambda = 1, .mu = 1}}, {2});
    const auto matrix = random_matrix<Dim, Scalar>(box.pattern);
    const BlockVector<Dim> x = random_vector<Dim>(matrix.rows());
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

// Numbers of a block one by one: each entry has a place of its own, whichever it is.
template <int Dim>
void expect_blocks_as_they_were_set() {
    using Block = Eigen::Matrix<double, Dim, Dim>;
    const ElasticBox<Dim> box({.lame = {.lambda = 1, .mu = 1}});
    BlockMatrix<Dim, double> matrix(box.pattern);
    const Block block = Block::Random();
    const std::int64_t last = matrix.pattern().blocks() - 1;
    matrix.set_block(0, block);
    matrix.add_to_block(last, block);
    matrix.add_to_block(last, block);
    matrix.add_to_diagonal(0, 3);
    EXPECT_EQ(matrix.diagonal(0), block + Block(3 * Block::Identity()));
    EXPECT_EQ(matrix.block(last), 2 * block);
    const Eigen::Map<const Eigen::VectorXd> numbers(matrix.values(), Dim * Dim);
    // At most 16 numbers of size 1 to 4 in another order: 64 roundings of 2e-16.
    EXPECT_NEAR(numbers.sum(), block.sum() + 3 * Dim, 1e-13);
    EXPECT_EQ(matrix.block(1), Block::Zero());
}

TEST(BlockMatrix, HasEveryEntryOfABlockThatWasSet) {
    expect_blocks_as_they_were_set<3>();
    expect_blocks_as_they_were_set<4>();
}

// Row sums by the dense matrix: of the symmetric part, as what is added stays symmetric.
template <int Dim, typename Scalar>
void expect_compensation_of_row_sums() {
    ElasticBox<Dim> box({.lame = {.lambda = 1, .mu = 1}});
    box.pattern.is_cut[1] = true;
    auto matrix = random_matrix<Dim, Scalar>(box.pattern);
    const std::int64_t rows = matrix.rows();
    const Eigen::VectorXd masses = random_vector<Dim>(rows).row(0);
    Eigen::MatrixXd expected = ElasticBox<Dim>::dense(matrix);
    for (Eigen::Index row = 0; row < rows; ++row) {
        Eigen::Matrix<double, Dim, Dim> sum = Eigen::Matrix<double, Dim, Dim>::Zero();
        for (Eigen::Index column = 0; column < rows; ++column) {
            sum += expected.block<Dim, Dim>(Dim * row, Dim * column);
        }
        if (row != 1) {
            expected.block<Dim, Dim>(Dim * row, Dim * row) -= 0.5 * (sum + sum.transpose());
            expected.diagonal().segment<Dim>(Dim * row).array() += masses[row];
        }
    }
    const BlockVector<Dim> x = random_vector<Dim>(rows);
    BlockVector<Dim> y(Dim, rows);
    matrix.compensate(Workers(2), masses);
    matrix.multiply(Workers(2), kernels<Dim>(best_isa()).blocks, x, y);
    EXPECT_LT((y.reshaped() - expected * x.reshaped()).norm(), 1e-13 * expected.norm() * x.norm());
    matrix.set_zero(Workers(2));
    matrix.multiply(Workers(2), kernels<Dim>(best_isa()).blocks, x, y);
    EXPECT_EQ(y.norm(), 0);
}

TEST(BlockMatrix, CompensationMakesRowsAddUpToMasses) {
    expect_compensation_of_row_sums<3, float>();
    expect_compensation_of_row_sums<3, double>();
    expect_compensation_of_row_sums<4, float>();
    expect_compensation_of_row_sums<4, double>();
}

TEST(BlockMatrix, IsCompensatedToTheBitByAnyNumberOfThreads) {
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({40, 4, 4, 4}, {10, 1, 1, 1});
    const ElasticBox<4> box(mesh, {.lame = {.lambda = 1, .mu = 1}}, ElementKind::Linear);
    ASSERT_GT(box.pattern.chunks, 4);
    auto matrix = random_matrix<4, float>(box.pattern);
    const Eigen::VectorXd masses = random_vector<4>(matrix.rows()).row(0);
    const BlockVector<4> x = random_vector<4>(matrix.rows());
    const auto product = [&](int threads) {
        BlockVector<4> y(4, matrix.rows());
        matrix.compensate(Workers(threads), masses);
        matrix.multiply(Workers(threads), kernels<4>(best_isa()).blocks, x, y);
        return y;
    };
    const BlockVector<4> by_one = product(1);
    EXPECT_EQ(product(2), by_one);
    EXPECT_EQ(product(3), by_one);
}

// A rank has all blocks of its rows, those of others' columns as well.
TEST(BlockMatrix, RanksCompensateTheirRowsAsOneProcessDoes) {
    const ElasticBox<4> box({.lame = {.lambda = 1, .mu = 1}});
    auto whole = random_matrix<4, double>(box.pattern);
    const Eigen::VectorXd masses = random_vector<4>(whole.rows()).row(0);
    const BlockVector<4> x = random_vector<4>(whole.rows());
    std::vector<std::uint32_t> owners(static_cast<std::size_t>(whole.rows()));
    for (std::size_t dof = 0; dof < owners.size(); ++dof) {
        owners[dof] = static_cast<std::uint32_t>(dof * dof % 3);
    }
    const BlockMatrix<4, double> rounded = whole;
    BlockVector<4> expected(4, whole.rows());
    whole.compensate(Workers(1), masses);
    whole.multiply(Workers(1), kernels<4>(best_isa()).blocks, x, expected);
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        const CutMatrix part(rounded, owners, ranks);
        BlockVector<4> own_x(4, x.cols());
        Eigen::VectorXd own_masses(part.A->rows());
        for (Eigen::Index column = 0; column < x.cols(); ++column) {
            own_x.col(column) = x.col(part.dofs[static_cast<std::size_t>(column)]);
        }
        for (Eigen::Index row = 0; row < own_masses.size(); ++row) {
            own_masses[row] = masses[part.dofs[static_cast<std::size_t>(row)]];
        }
        BlockVector<4> y(4, x.cols());
        part.A->compensate(Workers(1), own_masses);
        part.A->multiply(Workers(1), kernels<4>(best_isa()).blocks, own_x, y);
        for (Eigen::Index row = 0; row < own_masses.size(); ++row) {
            EXPECT_LT((y.col(row) - expected.col(part.dofs[static_cast<std::size_t>(row)])).norm(),
                      1e-12 * expected.norm());
        }
    });
}

}  // namespace
}  // namespace pent::simulator
