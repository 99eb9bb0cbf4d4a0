#include "theory/eigen_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

// The oracle shares no formula with the eigensystems; here it is held against what is known of each
// function by hand.

namespace pent::simulator {
namespace {

using Eigen::MatrixXd;

MatrixXd random_matrix(int n, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    return MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
}

TEST(EigenOracle, OfTheSecondInvariantIsTwiceTheIdentity) {
    for (int n = 2; n <= 5; ++n) {
        const MatrixXd F = random_matrix(n, 1);
        const MatrixXd q = random_matrix(n, 2);
        EXPECT_LT((*hessian_product(Invariant::I2, F, q) - 2 * q).norm(), 1e-12 * q.norm());
        EXPECT_NEAR(hessian_trace(Invariant::I2, F), 2.0 * n * n, 1e-12 * n * n);
    }
}

// det in the plane is bilinear: H q is the cofactor of q, whatever F.
TEST(EigenOracle, OfTheDeterminantInThePlaneIsTheCofactor) {
    const MatrixXd q = random_matrix(2, 3);
    MatrixXd cofactor(2, 2);
    cofactor << q(1, 1), -q(1, 0), -q(0, 1), q(0, 0);
    for (const MatrixXd& F : {random_matrix(2, 4), MatrixXd(MatrixXd::Zero(2, 2))}) {
        EXPECT_LT((*hessian_product(Invariant::I3, F, q) - cofactor).norm(), 1e-12 * q.norm());
    }
    EXPECT_NEAR(hessian_trace(Invariant::I3, q), 0, 1e-12);
}

// tr S changes at second order by turns alone: stretching a stretched body leaves its slope.
TEST(EigenOracle, OfTheFirstInvariantIsZeroAlongStretches) {
    const MatrixXd F = Eigen::Vector3d(1, 2, 3).asDiagonal();
    const MatrixXd stretch = Eigen::Vector3d(3, -1, 2).asDiagonal();
    EXPECT_LT(hessian_product(Invariant::I1, F, stretch)->norm(), 1e-12);
    // Along the turn of two axes it is 2 / (sigma_i + sigma_j).
    MatrixXd twist = MatrixXd::Zero(3, 3);
    twist(0, 1) = -std::numbers::sqrt2 / 2;
    twist(1, 0) = std::numbers::sqrt2 / 2;
    EXPECT_LT((*hessian_product(Invariant::I1, F, twist) - 2.0 / 3 * twist).norm(), 1e-12);
    // Where two singular values add up to 0 there is no derivative along it.
    const MatrixXd singular = Eigen::Vector3d(1, -1, 3).asDiagonal();
    EXPECT_FALSE(hessian_product(Invariant::I1, singular, twist).has_value());
}

TEST(EigenOracle, IsSymmetricAndLinearForEveryFunction) {
    for (const EigenFunction& function : eigen_functions()) {
        for (const int n : {2, 3, 4}) {
            const MatrixXd F = MatrixXd::Identity(n, n) + 0.2 * random_matrix(n, 5);
            const MatrixXd p = random_matrix(n, 6);
            const MatrixXd q = random_matrix(n, 7);
            const MatrixXd Hp = *hessian_product(function, F, p);
            const MatrixXd Hq = *hessian_product(function, F, q);
            const double size = Hp.norm() * q.norm() + 1;
            EXPECT_NEAR(Hp.cwiseProduct(q).sum(), Hq.cwiseProduct(p).sum(), 1e-11 * size)
                << eigen_function_name(function) << n;
            EXPECT_LT((*hessian_product(function, F, p - 3 * q) - (Hp - 3 * Hq)).norm(),
                      1e-11 * size);
            double trace = 0;
            for (int i = 0; i < n * n; ++i) {
                MatrixXd unit = MatrixXd::Zero(n, n);
                unit(i / n, i % n) = 1;
                trace += (*hessian_product(function, F, unit))(i / n, i % n);
            }
            EXPECT_NEAR(hessian_trace(function, F), trace, 1e-11 * (std::abs(trace) + 1));
        }
    }
}

}  // namespace
}  // namespace pent::simulator
