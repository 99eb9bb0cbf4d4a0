#include "linear/conjugate_gradients.h"

#include "elastic_box.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace pent::simulator {
namespace {

using test::ElasticBox;

// Stiffness of a scrambled box plus a mass: symmetric positive definite.
template <typename Scalar>
BlockMatrix<4, Scalar> definite_matrix(const ElasticBox<4>& box, double mass) {
    BlockMatrix<4, Scalar> matrix(box.pattern);
    box.elements->add_hessian(Workers(1), kernels<4>(best_isa()), box.positions,
                              target_in(matrix, 1, Filter::Clamp));
    for (std::int64_t row = 0; row < matrix.rows(); ++row) {
        matrix.add_to_diagonal(row, static_cast<Scalar>(mass));
    }
    return matrix;
}

struct Problem {
    ElasticBox<4> box{{.lame = {.lambda = 2, .mu = 1}}};
    BlockVector<4> b;
    BlockVector<4> guess;

    Problem() {
        box.scramble(0.1, 1);
        std::mt19937 random(2);
        std::normal_distribution<double> normal;
        b = BlockVector<4>::NullaryExpr(4, box.pattern.rows(), [&]() { return normal(random); });
        guess.setZero(4, box.pattern.rows());
    }
};

template <typename Scalar>
LinearSolution<4> solve(const Problem& problem,
                        const BlockMatrix<4, Scalar>& A,
                        const Preconditioner<4>& preconditioner,
                        const LinearSolveOptions& options) {
    const Workers workers(1);
    ConjugateGradients<4> iteration(workers, kernels<4>(best_isa()).blocks);
    return iteration.solve(A, preconditioner, problem.b, options, problem.guess);
}

template <typename Scalar>
std::unique_ptr<Preconditioner<4>> columns_of(const Problem& problem,
                                              const BlockMatrix<4, Scalar>& A) {
    return column_jacobi(Workers(1), kernels<4>(best_isa()).blocks, A,
                         problem.box.dofs.column_start());
}

TEST(ConjugateGradients, FindTheSolutionOfTheDenseFactorization) {
    Problem problem;
    const BlockMatrix<4, double> A = definite_matrix<double>(problem.box, 0.01);
    const Workers workers(1);
    const auto preconditioner = columns_of(problem, A);
    const auto [x, report] = solve(problem, A, *preconditioner, {.tolerance = 1e-12});
    EXPECT_TRUE(report.has_converged);
    EXPECT_LE(report.residual, 1e-12);
    const Eigen::VectorXd expected =
        ElasticBox<4>::dense(A).ldlt().solve(problem.b.reshaped()).eval();
    // Condition about 1e4 times the residual.
    EXPECT_LT((x.reshaped() - expected).norm(), 1e-8 * expected.norm());
}

TEST(ConjugateGradients, ReachOneMillionthWithAFloatMatrix) {
    Problem problem;
    const BlockMatrix<4, float> A = definite_matrix<float>(problem.box, 0.01);
    const Workers workers(1);
    const auto [x, report] = solve(problem, A, *columns_of(problem, A), {.tolerance = 1e-6});
    EXPECT_TRUE(report.has_converged);
    const Eigen::VectorXd gap = problem.b.reshaped() - ElasticBox<4>::dense(A) * x.reshaped();
    EXPECT_NEAR(gap.norm() / problem.b.norm(), report.residual, 1e-12);
}

// In some rows b is a ten-thousandth of what it is in others: what is left of it there has to be as
// small a part in the norm that makes up for that, and is not in that of all rows alone.
TEST(ConjugateGradients, LeaveAsLittleInASecondNorm) {
    constexpr double kTolerance = 1e-6;
    Problem problem;
    const BlockMatrix<4, double> A = definite_matrix<double>(problem.box, 0.01);
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(problem.b.cols());
    for (Eigen::Index row = 0; row < weights.size(); row += 3) {
        problem.b.col(row) *= 1e-4;
        weights[row] = 1e8;
    }
    const auto left = [&](const BlockVector<4>& x, const Eigen::VectorXd& with) {
        const BlockVector<4> r =
            problem.b - (ElasticBox<4>::dense(A) * x.reshaped()).reshaped(4, x.cols());
        const auto norm = [&](const BlockVector<4>& of) {
            return std::sqrt(of.colwise().squaredNorm().dot(with));
        };
        return norm(r) / norm(problem.b);
    };
    const Workers workers(1);
    const auto preconditioner = columns_of(problem, A);
    const auto plain = solve(problem, A, *preconditioner, {.tolerance = kTolerance});
    EXPECT_GT(left(plain.x, weights), 10 * kTolerance);
    const auto even =
        solve(problem, A, *preconditioner, {.tolerance = kTolerance, .weights = {weights}});
    EXPECT_TRUE(even.report.has_converged);
    EXPECT_LE(left(even.x, weights), 1.001 * kTolerance);
    EXPECT_LE(left(even.x, Eigen::VectorXd::Ones(weights.size())), 1.001 * kTolerance);
    EXPECT_NEAR(left(even.x, weights), even.report.residual, 1e-3 * kTolerance);
}

TEST(ConjugateGradients, ReportAMatrixThatIsNotPositiveDefinite) {
    Problem problem;
    BlockMatrix<4, double> A = definite_matrix<double>(problem.box, 0.01);
    A.set_block(A.diagonal_of(3), -Eigen::Matrix4d::Identity());
    const Workers workers(1);
    const auto [x, report] = solve(problem, A, *columns_of(problem, A), {.tolerance = 1e-8});
    EXPECT_TRUE(report.has_broken_down);
    EXPECT_FALSE(report.has_converged);
}

TEST(ConjugateGradients, SayWhenIterationsRunOut) {
    Problem problem;
    const BlockMatrix<4, double> A = definite_matrix<double>(problem.box, 0.01);
    const Workers workers(1);
    const auto [x, report] =
        solve(problem, A, *columns_of(problem, A), {.tolerance = 1e-12, .max_iterations = 3});
    EXPECT_FALSE(report.has_converged);
    EXPECT_EQ(report.iterations, 3);
    EXPECT_GT(report.residual, 1e-12);
}

TEST(ConjugateGradients, TakeAnyMultipleOfTheSolutionForIt) {
    Problem problem;
    const BlockMatrix<4, double> A = definite_matrix<double>(problem.box, 0.01);
    const auto preconditioner = columns_of(problem, A);
    const BlockVector<4> solution = solve(problem, A, *preconditioner, {.tolerance = 1e-12}).x;
    for (const double factor : {1e-3, 2.0, -7.0, 1e6}) {
        problem.guess = factor * solution;
        const auto [x, report] = solve(problem, A, *preconditioner, {.tolerance = 1e-8});
        EXPECT_TRUE(report.has_converged) << factor;
        EXPECT_EQ(report.iterations, 0) << factor;
        EXPECT_LT((x - solution).norm(), 1e-8 * solution.norm()) << factor;
    }
}

// |x - A^-1 b|_A^2 is |x|_A^2 - 2 b x, and of 0 the same 0: a guess is taken so that this is the
// least of all its multiples, -(b x)^2 / |x|_A^2 of the guess.
TEST(ConjugateGradients, BeginAtTheMultipleOfTheGuessThatIsNearestInTheNormOfTheMatrix) {
    Problem problem;
    const BlockMatrix<4, double> A = definite_matrix<double>(problem.box, 0.01);
    const Workers workers(1);
    const auto times_A = [&](const BlockVector<4>& x) {
        BlockVector<4> product(4, x.cols());
        A.multiply(workers, kernels<4>(best_isa()).blocks, x, product);
        return product;
    };
    const auto inner = [](const BlockVector<4>& a, const BlockVector<4>& b) {
        return a.cwiseProduct(b).sum();
    };
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (const double size : {1e-6, 1.0, 1e6}) {
        problem.guess =
            BlockVector<4>::NullaryExpr(4, A.rows(), [&]() { return size * normal(random); });
        const auto [x, report] =
            solve(problem, A, *columns_of(problem, A), {.tolerance = 1e-12, .max_iterations = 0});
        EXPECT_EQ(report.iterations, 0);
        const double found = inner(x, times_A(x)) - 2 * inner(problem.b, x);
        const double along = inner(problem.b, problem.guess);
        const double least = -along * along / inner(problem.guess, times_A(problem.guess));
        EXPECT_NEAR(found, least, 1e-9 * std::abs(least)) << size;
        const double left = (problem.b - times_A(x)).norm() / problem.b.norm();
        EXPECT_NEAR(report.residual, left, 1e-9 * left) << size;
    }
}

TEST(ConjugateGradients, GiveZeroForZeroWithoutIterating) {
    Problem problem;
    const BlockMatrix<4, double> A = definite_matrix<double>(problem.box, 1);
    problem.b.setZero();
    problem.guess.setOnes();
    const Workers workers(1);
    const auto [x, report] = solve(problem, A, *columns_of(problem, A), {});
    EXPECT_TRUE(report.has_converged);
    EXPECT_EQ(report.iterations, 0);
    EXPECT_EQ(x.norm(), 0);
}

// What is left after so many iterations with nothing else to do.
double left_after(const Problem& problem,
                  const BlockMatrix<4, double>& A,
                  const Preconditioner<4>& preconditioner,
                  int iterations) {
    return solve(problem, A, preconditioner, {.tolerance = 1e-12, .max_iterations = iterations})
        .report.residual;
}

// At the first iteration from which more are left than anything else takes, at the rate of the last
// half as many, and so many times more before as many have been made: all from runs that were cut
// off there.
TEST(ConjugateGradients, EndWhereAnythingElseWouldTakeLess) {
    const Problem problem;
    const BlockMatrix<4, double> A = definite_matrix<double>(problem.box, 0.01);
    const auto preconditioner = columns_of(problem, A);
    const Workers workers(1);
    ConjugateGradients<4> iteration(workers, kernels<4>(best_isa()).blocks);
    const LinearSolution<4> whole = solve(problem, A, *preconditioner, {.tolerance = 1e-10});
    ASSERT_GT(whole.report.iterations, 24);
    int ended = 0;
    for (const double worth : {2.0, 8.0, 10.5, 16.0, 0.75 * whole.report.iterations, 1e9}) {
        int asked = 0;
        const LinearSolution<4> found = iteration.solve(
            A, *preconditioner, problem.b, {.tolerance = 1e-10}, problem.guess, {}, [&] {
                ++asked;
                return worth;
            });
        EXPECT_EQ(asked, 1);
        const auto is_over_at = [&](int spent) {
            const int last = std::min(spent, static_cast<int>(std::max(4.0, worth / 2)));
            const double left = left_after(problem, A, *preconditioner, spent);
            const double before = left_after(problem, A, *preconditioner, spent - last);
            const double falls_by = std::pow(left / before, 1.0 / last);  // in one iteration
            return spent >= 8
                   && left * std::pow(falls_by, worth * std::max(1.0, worth / spent)) > 0.95e-10;
        };
        int expected = 1;
        while (expected < whole.report.iterations && !is_over_at(expected)) {
            ++expected;
        }
        EXPECT_EQ(found.report.iterations, expected) << worth;
        EXPECT_EQ(found.report.is_slow, expected < whole.report.iterations) << worth;
        EXPECT_EQ(found.report.has_converged, !found.report.is_slow);
        const Eigen::VectorXd left =
            problem.b.reshaped() - ElasticBox<4>::dense(A) * found.x.reshaped();
        EXPECT_NEAR(found.report.residual, left.norm() / problem.b.norm(),
                    1e-9 * found.report.residual + 1e-14);
        ended += found.report.is_slow ? 1 : 0;
        if (!found.report.is_slow) {
            EXPECT_EQ(found.x, whole.x);
        }
    }
    EXPECT_GE(ended, 3);
    EXPECT_LT(ended, 6);
}

// Nor is anything asked for by what takes few iterations.
TEST(ConjugateGradients, ThinkOfNothingElseWhereTheyAreFewAnyway) {
    const Problem problem;
    const BlockMatrix<4, double> A = definite_matrix<double>(problem.box, 1e6);
    const auto preconditioner = columns_of(problem, A);
    const Workers workers(1);
    const LinearSolution<4> found =
        ConjugateGradients<4>(workers, kernels<4>(best_isa()).blocks)
            .solve(A, *preconditioner, problem.b, {.tolerance = 1e-4}, problem.guess, {}, [] {
                ADD_FAILURE();
                return 0.0;
            });
    EXPECT_TRUE(found.report.has_converged);
}

}  // namespace
}  // namespace pent::simulator
