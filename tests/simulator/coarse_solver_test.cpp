#include "linear/coarse_solver.h"

#include "aggregate_levels.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using test::dense;
using test::kModeCount;

// A chain of single vertices, some links of which are missing: each component on its own.
struct Chain {
    BlockPattern pattern;
    Aggregates aggregates;
    AggregatePattern coarse_pattern;
    AggregateMatrix<4, double> A;

    explicit Chain(std::uint32_t count, std::uint32_t cut_after) {
        for (std::uint32_t row = 0; row < count; ++row) {
            pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
            pattern.columns.push_back(row);
            if (row + 1 < count && row != cut_after) {
                pattern.columns.push_back(row + 1);
            }
        }
        pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
        aggregates = test::by_number(count, 1);
        BlockMatrix<4, double> matrix(pattern);
        for (std::int64_t k = 0; k < pattern.blocks(); ++k) {
            matrix.set_block(k, -Eigen::Matrix4d::Identity());
        }
        for (std::uint32_t row = 0; row < count; ++row) {
            matrix.set_block(matrix.diagonal_of(row), 2.1 * Eigen::Matrix4d::Identity());
        }
        coarse_pattern = make_aggregate_pattern(aggregates, pattern, nullptr);
        A = galerkin_product(Workers(1), kernels<4>(Isa::Baseline).blocks, matrix, aggregates,
                             Arms<4>(count, {Eigen::Vector4d::Zero(), 0}), coarse_pattern);
    }

    // What the solver makes of A, on the translations, which are all that a vertex has.
    [[nodiscard]] Eigen::MatrixXd solved() const {
        const CoarseSolver<4, double> solver(Workers(2), A);
        const Eigen::MatrixXd full = dense(A);
        const Eigen::Index count = A.pattern->rows();
        Eigen::MatrixXd B(count, count);
        for (Eigen::Index i = 0; i < count; ++i) {
            Eigen::VectorXd z;
            solver.solve(Workers(2), full.col(kModeCount * i), z);
            for (Eigen::Index j = 0; j < count; ++j) {
                B(j, i) = z[kModeCount * j];
            }
        }
        return B;
    }
};

TEST(CoarseSolver, SolvesExactlyForEveryComponentThatIsNotTooLarge) {
    const Eigen::MatrixXd B = Chain(80, 30).solved();                 // 31 and 49 aggregates
    EXPECT_LT((B - Eigen::MatrixXd::Identity(80, 80)).norm(), 1e-7);  // 1e-10 is added
}

TEST(CoarseSolver, ApproximatesTheInverseOfAnythingLargerFromBelow) {
    const Eigen::MatrixXd B = Chain(80, 100).solved();  // not cut
    const Eigen::VectorXd spectrum = B.eigenvalues().real();
    EXPECT_GT(spectrum.minCoeff(), 0);
    EXPECT_LE(spectrum.maxCoeff(), 1);
}

}  // namespace
}  // namespace pent::simulator
