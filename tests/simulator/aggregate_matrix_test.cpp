#include "linear/aggregate_matrix.h"

#include "aggregate_levels.h"
#include "elastic_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <vector>

namespace pent::simulator {
namespace {

using test::dense;
using test::dense_modes;
using test::kModeCount;
using test::TwoLevels;

TEST(GalerkinProduct, IsThatOfDenseMatricesOnEveryLevelSpringsIncludedOnEveryInstructionSet) {
    for (const Isa isa : test::supported_isas()) {
        const TwoLevels<double> levels(Precision::Double, 2, isa);
        const Eigen::MatrixXd P = dense_modes(levels.fine, levels.fine_arms, 4);
        const Eigen::MatrixXd Q = dense_modes(levels.coarse, levels.coarse_arms, kModeCount);
        const Eigen::MatrixXd first = P.transpose() * levels.problem.dense() * P;
        const Eigen::MatrixXd second = Q.transpose() * first * Q;
        // Sums of some hundred terms.
        EXPECT_LT((dense(levels.first) - first).norm(), 1e-13 * first.norm()) << isa_name(isa);
        EXPECT_LT((dense(levels.second) - second).norm(), 1e-13 * second.norm()) << isa_name(isa);
    }
}

// Sums of some hundred terms, in the precision of the blocks.
template <int Dim, typename Scalar>
void expect_product_of_the_dense_matrix(const AggregateMatrix<Dim, Scalar>& A, double tolerance) {
    using Vector = typename AggregateMatrix<Dim, Scalar>::Vector;
    const Vector r = Vector::Random(kModes<Dim> * A.pattern->rows());
    const Vector x = Vector::Random(r.size());
    const Eigen::VectorXd product = dense(A) * x.template cast<double>();
    typename AggregateMatrix<Dim, Scalar>::Shares shares;
    A.fit(shares);
    for (const Isa isa : test::supported_isas()) {
        Vector left;
        A.subtract_product(Workers(2), kernels<Dim>(isa).blocks, r, x, left, shares);
        EXPECT_LT((left.template cast<double>() - (r.template cast<double>() - product)).norm(),
                  tolerance * product.norm())
            << isa_name(isa);
    }
}

// What the modes do to all children, one mode at a time.
template <int Dim, int Rows>
Eigen::MatrixXd modes_of(const Aggregates& aggregates, const Arms<Dim>& arms) {
    using Modes = RigidModes<Dim, Rows>;
    constexpr int kSize = kModes<Dim>;
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(Rows * static_cast<Eigen::Index>(arms.size()),
                                              kSize * aggregates.count());
    for (std::size_t child = 0; child < arms.size(); ++child) {
        for (int mode = 0; mode < kSize; ++mode) {
            P.block<Rows, 1>(Rows * static_cast<Eigen::Index>(child),
                             kSize * aggregates.of_child()[child] + mode) =
                Modes::motion(Modes::Modes::Unit(mode), arms[child]);
        }
    }
    return P;
}

// Of numbers at random, none of which makes up for another: sums of some hundred terms.
template <int Dim, typename Scalar>
void expect_products_of_numbers_at_random(double tolerance) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    const auto arms_of = [&](std::size_t count) {
        Arms<Dim> arms(count);
        for (Arm<Dim>& arm : arms) {
            arm = {Eigen::Matrix<double, Dim, 1>::NullaryExpr([&] { return normal(random); }),
                   0.5 + std::abs(normal(random))};
        }
        return arms;
    };
    const test::ElasticBox<Dim> box({.lame = {.lambda = 1, .mu = 1}});
    BlockMatrix<Dim, Scalar> A(box.pattern);
    std::generate_n(A.values(), box.pattern.blocks() * Dim * Dim,
                    [&] { return static_cast<Scalar>(normal(random)); });
    for (std::int64_t row = 0; row < A.rows(); ++row) {
        const Eigen::Matrix<Scalar, Dim, Dim> block = A.diagonal(row);
        A.set_block(A.diagonal_of(row), block + block.transpose());
    }
    const Aggregates fine = test::stripes(static_cast<std::uint32_t>(A.rows()), 5);
    const Aggregates coarse = test::stripes(5, 2);
    const AggregatePattern fine_pattern = make_aggregate_pattern(fine, box.pattern, nullptr);
    const AggregatePattern coarse_pattern = make_aggregate_pattern(coarse, fine_pattern);
    const auto fine_arms = arms_of(static_cast<std::size_t>(A.rows()));
    const auto coarse_arms = arms_of(5);
    const Eigen::MatrixXd P = modes_of<Dim, Dim>(fine, fine_arms);
    const Eigen::MatrixXd Q = modes_of<Dim, kModes<Dim>>(coarse, coarse_arms);
    const Eigen::MatrixXd expected = P.transpose() * test::ElasticBox<Dim>::dense(A) * P;
    const Eigen::MatrixXd expected_next = Q.transpose() * expected * Q;
    for (const Isa isa : test::supported_isas()) {
        const BlockKernels& blocks = kernels<Dim>(isa).blocks;
        const auto first = galerkin_product(Workers(2), blocks, A, fine, fine_arms, fine_pattern);
        const auto second =
            galerkin_product(Workers(2), blocks, first, coarse, coarse_arms, coarse_pattern);
        EXPECT_LT((dense(first) - expected).norm(), tolerance * expected.norm()) << isa_name(isa);
        EXPECT_LT((dense(second) - expected_next).norm(), tolerance * expected_next.norm())
            << isa_name(isa);
        expect_product_of_the_dense_matrix(first, tolerance);
    }
}

TEST(GalerkinProduct, IsThatOfDenseMatricesInBothPrecisionsAndDimensions) {
    expect_products_of_numbers_at_random<3, float>(1e-6);
    expect_products_of_numbers_at_random<3, double>(1e-14);
    expect_products_of_numbers_at_random<4, float>(1e-6);
    expect_products_of_numbers_at_random<4, double>(1e-14);
}

TEST(GalerkinProduct, IsSymmetricToTheBitAndTheSameForAnyNumberOfThreads) {
    for (const Isa isa : test::supported_isas()) {
        const TwoLevels<float> one(Precision::Float, 1, isa);
        const Eigen::MatrixXd A = dense(one.second);
        EXPECT_EQ(A, A.transpose());
        for (const int threads : {2, 3}) {
            const TwoLevels<float> more(Precision::Float, threads, isa);
            EXPECT_EQ(dense(more.first), dense(one.first));
            EXPECT_EQ(dense(more.second), A);
        }
    }
}

TEST(AggregateMatrix, MultipliesAsItsDenseMatrixOnEveryInstructionSet) {
    expect_product_of_the_dense_matrix(TwoLevels<float>(Precision::Float).first, 1e-6);
    expect_product_of_the_dense_matrix(TwoLevels<double>(Precision::Double).first, 1e-14);
}

// What is stored of a block is each of its entries once.
template <int Size>
void expect_a_place_for_every_entry() {
    std::vector<int> uses(std::size_t{Size} * Size, 0);
    for (int row = 0; row < Size; ++row) {
        for (int column = 0; column < Size; ++column) {
            ++uses.at(static_cast<std::size_t>(mode_entry<Size>(row, column)));
        }
    }
    EXPECT_EQ(std::count(uses.begin(), uses.end(), 1), Size * Size);
}

TEST(AggregateMatrix, HasAPlaceForEveryEntryOfABlock) {
    expect_a_place_for_every_entry<kModes<3>>();
    expect_a_place_for_every_entry<kModes<4>>();
}

template <int Dim, typename Scalar>
void expect_blocks_plus_transposes() {
    constexpr int kSize = kModes<Dim>;
    using Block = Eigen::Matrix<Scalar, kSize, kSize>;
    const Block A = Block::Random();
    const Block B = Block::Random();
    std::vector<Scalar> stored(std::size_t{kSize} * kSize);
    write_modes<kSize>(B, stored.data());
    for (const Isa isa : test::supported_isas()) {
        std::vector<Scalar> sum(stored.size());
        write_modes<kSize>(A, sum.data());
        mode_kernels_of<Scalar>(kernels<Dim>(isa).blocks).add_transposed(stored.data(), sum.data());
        EXPECT_EQ(read_modes<kSize>(sum.data()), A + B.transpose()) << isa_name(isa);
    }
}

TEST(AggregateMatrix, AddsTransposedBlocksInBothPrecisionsAndDimensions) {
    expect_blocks_plus_transposes<3, float>();
    expect_blocks_plus_transposes<3, double>();
    expect_blocks_plus_transposes<4, float>();
    expect_blocks_plus_transposes<4, double>();
}

// Both triangles, each block of which once.
TEST(AggregatePattern, GoesOverTheBlocksOfRowsFromBothTriangles) {
    const TwoLevels<double> levels(Precision::Double);
    const AggregatePattern& pattern = levels.fine_pattern;
    const Eigen::MatrixXd full = dense(levels.first);
    Eigen::MatrixXd found = Eigen::MatrixXd::Zero(full.rows(), full.cols());
    std::vector<std::size_t> uses(pattern.columns.size(), 0);
    for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
        for_each_in_row(
            pattern, row, [&](std::uint32_t column, std::int64_t k, bool is_transposed) {
                const Eigen::MatrixXd block = levels.first.block(k);
                found.block<kModeCount, kModeCount>(kModeCount * row, kModeCount * column) +=
                    is_transposed ? block.transpose() : block;
                ++uses.at(static_cast<std::size_t>(k));
            });
    }
    EXPECT_EQ(found, full);
    EXPECT_EQ(std::count(uses.begin(), uses.end(), 1), pattern.rows());  // the diagonal
    EXPECT_EQ(std::count(uses.begin(), uses.end(), 2), std::ssize(uses) - pattern.rows());
}

// As long as they can be: the first row of each is linked to one of the batch before.
TEST(AggregatePattern, HasBatchesOfRowsThatShareNoBlock) {
    const TwoLevels<double> levels(Precision::Double);
    for (const AggregatePattern* pattern : {&levels.fine_pattern, &levels.coarse_pattern}) {
        ASSERT_EQ(pattern->batches.front(), 0);
        ASSERT_EQ(pattern->batches.back(), pattern->rows());
        for (std::size_t i = 0; i + 1 < pattern->batches.size(); ++i) {
            const std::int64_t begin = pattern->batches[i];
            const std::int64_t end = pattern->batches[i + 1];
            ASSERT_LT(begin, end);
            const auto is_linked = [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                const auto at = static_cast<std::size_t>(row);
                return std::any_of(pattern->columns.begin() + pattern->row_start[at],
                                   pattern->columns.begin() + pattern->row_start[at + 1],
                                   [&](std::uint32_t column) {
                                       return column != row && column >= first && column < last;
                                   });
            };
            for (std::int64_t row = begin; row < end; ++row) {
                EXPECT_FALSE(is_linked(row, begin, end));
            }
            EXPECT_TRUE(i == 0 || is_linked(begin, pattern->batches[i - 1], begin));
        }
    }
}

// More children than are told to kernels at a time: 4096. Nothing couples them, so that every block
// is a sum over the members of its aggregate alone.
TEST(GalerkinProduct, HasThePlaceOfEveryChildHoweverManyThereAre) {
    constexpr std::uint32_t kChildren = 9001;
    BlockPattern pattern;
    for (std::uint32_t row = 0; row < kChildren; ++row) {
        pattern.row_start.push_back(row);
        pattern.columns.push_back(row);
    }
    pattern.row_start.push_back(kChildren);
    color_rows(pattern, kChildren);
    BlockMatrix<4, double> A(pattern);
    for (std::uint32_t row = 0; row < kChildren; ++row) {
        A.set_block(row, (1 + row % 5) * Eigen::Matrix4d::Identity());
    }
    const Aggregates aggregates = test::by_number(kChildren, 6);
    const Arms<4> arms = test::random_arms(kChildren, 3);
    const AggregatePattern blocks = make_aggregate_pattern(aggregates, pattern, nullptr);
    const auto product =
        galerkin_product(Workers(2), kernels<4>(best_isa()).blocks, A, aggregates, arms, blocks);
    for (std::uint32_t a = 0; a < static_cast<std::uint32_t>(aggregates.count()); ++a) {
        Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(kModeCount, kModeCount);
        for (const std::uint32_t child : aggregates.members(a)) {
            const Eigen::MatrixXd P = dense_modes(test::by_number(1, 1), {arms[child]}, 4);
            expected += (1 + child % 5) * P.transpose() * P;
        }
        const Eigen::MatrixXd found = product.block(blocks.diagonal[a]);
        ASSERT_LT((found - expected).norm(), 1e-13 * expected.norm()) << a;
    }
}

}  // namespace
}  // namespace pent::simulator
