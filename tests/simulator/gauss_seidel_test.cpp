#include "linear/gauss_seidel.h"

#include "aggregate_levels.h"
#include "elastic_box.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <iterator>

namespace pent::simulator {
namespace {

using test::dense;
using test::kModeCount;
using test::TwoLevels;

constexpr int kSize = 9 * kModeCount;

// What sweeps make of r.
template <int Dim, typename Scalar>
struct Swept {
    using Vector = typename AggregateMatrix<Dim, Scalar>::Vector;

    Vector forth;
    Vector left;
    Vector back;

    Swept(const Workers& workers, const AggregateMatrix<Dim, Scalar>& A, const Vector& r, Isa isa) {
        const BlockKernels& blocks = kernels<Dim>(isa).blocks;
        const GaussSeidel<Dim, Scalar> smoother(workers, A);
        typename AggregateMatrix<Dim, Scalar>::Shares shares;
        A.fit(shares);
        smoother.sweep_forth(workers, blocks, r, forth, left, shares);
        back = forth;
        smoother.sweep_back(workers, blocks, r, back, shares);
    }
};

// Aggregates of one or two vertices have modes that do nothing: made definite.
template <typename Scalar>
AggregateMatrix<4, Scalar> definite(const TwoLevels<Scalar>& levels) {
    AggregateMatrix<4, Scalar> A = levels.first;
    for (const std::int64_t k : A.pattern->diagonal) {
        typename AggregateMatrix<4, Scalar>::Block block = A.block(k);
        block.diagonal().array() += Scalar(0.1);
        A.set_block(k, block);
    }
    return A;
}

// L + D of a matrix of aggregates.
Eigen::MatrixXd lower_of(const Eigen::MatrixXd& A, Eigen::Index size) {
    Eigen::MatrixXd lower = A;
    for (Eigen::Index begin = 0; begin < A.rows(); begin += size) {
        lower.block(begin, begin + size, size, A.cols() - begin - size).setZero();
    }
    return lower;
}

// Of a matrix whose diagonal blocks are much larger than the others: errors are those of rounding.
//
// @param tolerance  Of some hundred terms, in the precision of the blocks.
template <int Dim, typename Scalar>
void expect_sweeps_of_numbers_at_random(double tolerance) {
    constexpr int kOfDim = kModes<Dim>;
    const test::ElasticBox<Dim> box({.lame = {.lambda = 1, .mu = 1}});
    const auto count = static_cast<std::uint32_t>(box.pattern.rows());
    const Aggregates aggregates = test::stripes(count, 5);
    const AggregatePattern pattern = make_aggregate_pattern(aggregates, box.pattern, nullptr);
    AggregateMatrix<Dim, Scalar> A;
    A.pattern = &pattern;
    A.values.resize(pattern.columns.size() * A.kEntries);
    using Block = typename AggregateMatrix<Dim, Scalar>::Block;
    for (std::int64_t k = 0; k < std::ssize(pattern.columns); ++k) {
        A.set_block(k, Block::Random());
    }
    for (const std::int64_t k : pattern.diagonal) {
        const Block block = A.block(k);
        A.set_block(k, block + block.transpose() + 40 * Block::Identity());
    }
    const Eigen::MatrixXd full = dense(A);
    const Eigen::MatrixXd lower = lower_of(full, kOfDim);
    using Vector = typename AggregateMatrix<Dim, Scalar>::Vector;
    const Vector r = Vector::Random(full.rows());
    const Eigen::VectorXd right = r.template cast<double>();
    const Eigen::VectorXd forth = lower.partialPivLu().solve(right);
    const Eigen::VectorXd left = right - full * forth;
    const Eigen::VectorXd back = forth + lower.transpose().partialPivLu().solve(left);
    const auto expect_near = [&](const Vector& found, const Eigen::VectorXd& expected, Isa isa) {
        EXPECT_LT((found.template cast<double>() - expected).norm(), tolerance * expected.norm())
            << isa_name(isa);
    };
    for (const Isa isa : test::supported_isas()) {
        const Swept<Dim, Scalar> swept(Workers(2), A, r, isa);
        expect_near(swept.forth, forth, isa);
        expect_near(swept.left, left, isa);
        expect_near(swept.back, back, isa);
    }
}

// 2e-6 and 1e-10 of the diagonals are added to them.
TEST(GaussSeidel, SolvesWithTheLowerAndThenWithTheUpperTriangleInBothPrecisionsAndDimensions) {
    expect_sweeps_of_numbers_at_random<3, float>(1e-5);
    expect_sweeps_of_numbers_at_random<3, double>(1e-9);
    expect_sweeps_of_numbers_at_random<4, float>(1e-5);
    expect_sweeps_of_numbers_at_random<4, double>(1e-9);
}

TEST(GaussSeidel, SolvesWithTheLowerAndThenWithTheUpperTriangleOfAnElasticBox) {
    const TwoLevels<double> levels(Precision::Double);
    const AggregateMatrix<4, double> matrix = definite(levels);
    const Eigen::MatrixXd A = dense(matrix);
    const Eigen::MatrixXd lower = lower_of(A, kModeCount);
    const Eigen::VectorXd r = Eigen::VectorXd::Random(kSize);
    const Swept<4, double> swept(Workers(2), matrix, r, best_isa());
    // 1e-10 of the diagonals is added to them.
    const Eigen::VectorXd first = lower.partialPivLu().solve(r);
    EXPECT_LT((swept.forth - first).norm(), 1e-6 * first.norm());
    EXPECT_LT((swept.left - (r - A * swept.forth)).norm(), 1e-8 * r.norm());
    const Eigen::VectorXd second =
        first + lower.transpose().partialPivLu().solve(Eigen::VectorXd(r - A * first));
    EXPECT_LT((swept.back - second).norm(), 1e-6 * second.norm());
}

// There and back again are B with 0 < B A <= 1: no error grows, whatever the matrix. Damped Jacobi
// would amplify where D^-1 A has eigenvalues above twice its damping.
TEST(GaussSeidel, MakesNoErrorGrow) {
    const TwoLevels<double> levels(Precision::Double);
    const AggregateMatrix<4, double> matrix = definite(levels);
    Eigen::MatrixXd B(kSize, kSize);
    for (Eigen::Index k = 0; k < kSize; ++k) {
        const Eigen::VectorXd unit = Eigen::VectorXd::Unit(kSize, k);
        B.col(k) = Swept<4, double>(Workers(1), matrix, unit, best_isa()).back;
    }
    EXPECT_LT((B - B.transpose()).norm(), 1e-8 * B.norm());
    const Eigen::VectorXd spectrum = (B * dense(matrix)).eval().eigenvalues().real();
    EXPECT_GT(spectrum.minCoeff(), 0);
    EXPECT_LT(spectrum.maxCoeff(), 1 + 1e-8);
}

TEST(GaussSeidel, GivesTheSameBitsForAnyNumberOfThreads) {
    const TwoLevels<float> levels(Precision::Float);
    const Eigen::VectorXf r = Eigen::VectorXf::Random(kSize);
    for (const Isa isa : test::supported_isas()) {
        const Swept<4, float> expected(Workers(1), levels.first, r, isa);
        for (const int threads : {2, 3}) {
            const Swept<4, float> swept(Workers(threads), levels.first, r, isa);
            EXPECT_EQ(swept.forth, expected.forth);
            EXPECT_EQ(swept.left, expected.left);
            EXPECT_EQ(swept.back, expected.back);
        }
    }
}

}  // namespace
}  // namespace pent::simulator
