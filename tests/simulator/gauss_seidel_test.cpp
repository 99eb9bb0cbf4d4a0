#include "linear/gauss_seidel.h"

#include "aggregate_levels.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using test::dense;
using test::kModeCount;
using test::TwoLevels;

constexpr int kRows = 9;
constexpr int kSize = kModeCount * kRows;

const BlockKernels& blocks() {
    return kernels<4>(best_isa()).blocks;
}

// Aggregates of one or two vertices have modes that do nothing: made definite.
AggregateMatrix<4, double> definite(const TwoLevels<double>& levels) {
    AggregateMatrix<4, double> A = levels.first;
    for (const std::int64_t block : A.pattern->diagonal) {
        A.block(block).diagonal().array() += 0.1;
    }
    return A;
}

// L + D of a matrix of 9 aggregates.
Eigen::MatrixXd lower_of(const Eigen::MatrixXd& A) {
    Eigen::MatrixXd lower = A;
    for (Eigen::Index row = 0; row < kRows; ++row) {
        const Eigen::Index behind = kModeCount * (row + 1);
        lower.block(kModeCount * row, behind, kModeCount, kSize - behind).setZero();
    }
    return lower;
}

TEST(GaussSeidel, SolvesWithTheLowerAndThenWithTheUpperTriangle) {
    const TwoLevels<double> levels(Precision::Double);
    const AggregateMatrix<4, double> matrix = definite(levels);
    const GaussSeidel<4, double> smoother(Workers(2), matrix);
    const Eigen::MatrixXd A = dense(matrix);
    const Eigen::MatrixXd lower = lower_of(A);
    const Eigen::VectorXd r = Eigen::VectorXd::Random(kSize);
    Eigen::VectorXd z;
    Eigen::VectorXd left;
    smoother.sweep_forth(Workers(2), blocks(), r, z, left);
    // 1e-10 of the diagonals is added to them.
    const Eigen::VectorXd first = lower.partialPivLu().solve(r);
    EXPECT_LT((z - first).norm(), 1e-6 * first.norm());
    EXPECT_LT((left - (r - A * z)).norm(), 1e-8 * r.norm());
    smoother.sweep_back(Workers(2), blocks(), r, z);
    const Eigen::VectorXd second =
        first + lower.transpose().partialPivLu().solve(Eigen::VectorXd(r - A * first));
    EXPECT_LT((z - second).norm(), 1e-6 * second.norm());
}

// There and back again are B with 0 < B A <= 1: no error grows, whatever the matrix. Damped Jacobi
// would amplify where D^-1 A has eigenvalues above twice its damping.
TEST(GaussSeidel, MakesNoErrorGrow) {
    const TwoLevels<double> levels(Precision::Double);
    const AggregateMatrix<4, double> matrix = definite(levels);
    const GaussSeidel<4, double> smoother(Workers(1), matrix);
    Eigen::MatrixXd B(kSize, kSize);
    for (Eigen::Index k = 0; k < kSize; ++k) {
        const Eigen::VectorXd unit = Eigen::VectorXd::Unit(kSize, k);
        Eigen::VectorXd z;
        Eigen::VectorXd left;
        smoother.sweep_forth(Workers(1), blocks(), unit, z, left);
        smoother.sweep_back(Workers(1), blocks(), unit, z);
        B.col(k) = z;
    }
    EXPECT_LT((B - B.transpose()).norm(), 1e-8 * B.norm());
    const Eigen::VectorXd spectrum = (B * dense(matrix)).eval().eigenvalues().real();
    EXPECT_GT(spectrum.minCoeff(), 0);
    EXPECT_LT(spectrum.maxCoeff(), 1 + 1e-8);
}

TEST(GaussSeidel, GivesTheSameBitsForAnyNumberOfThreads) {
    const TwoLevels<float> levels(Precision::Float);
    const Eigen::VectorXf r = Eigen::VectorXf::Random(kSize);
    const auto smoothed = [&](const Workers& workers) {
        const GaussSeidel<4, float> smoother(workers, levels.first);
        Eigen::VectorXf z;
        Eigen::VectorXf left;
        smoother.sweep_forth(workers, blocks(), r, z, left);
        smoother.sweep_back(workers, blocks(), r, z);
        return z;
    };
    const Eigen::VectorXf expected = smoothed(Workers(1));
    for (const int threads : {2, 3}) {
        EXPECT_EQ(smoothed(Workers(threads)), expected);
    }
}

}  // namespace
}  // namespace pent::simulator
