#include <pent/contact/friction.h>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <random>

namespace pent::contact {
namespace {

template <typename T>
class FrictionTest : public testing::Test {
protected:
    static constexpr int kSpace = T::value;
    static constexpr double kStep = 0.01;
    static constexpr Friction kFriction{.coefficient = 0.5, .slip_speed = 0.1};  // e = 1e-3 m

    Vector<kSpace> vector(double size = 1) {
        return Vector<kSpace>::NullaryExpr([&] { return size * coordinate_(random_); });
    }
    FrictionContact<kSpace> contact() {
        FrictionContact<kSpace> contact;
        contact.weights.setOnes();
        contact.normal = vector().normalized();
        contact.force = 3;
        return contact;
    }
    static Response<kSpace> at(const FrictionContact<kSpace>& contact, const Vector<kSpace>& slip) {
        return friction_response<kSpace>(contact, slip, kFriction, kStep, FrictionLaw::Energy);
    }

    std::mt19937 random_{5};
    std::uniform_real_distribution<double> coordinate_{-1, 1};
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(FrictionTest, Dimensions);

TYPED_TEST(FrictionTest, HasDerivativesThatAreCentralDifferences) {
    constexpr int kDim = TypeParam::value;
    const FrictionContact<kDim> contact = this->contact();
    for (const double size : {1e-5, 3e-4, 0.9e-3, 2e-3, 0.1}) {
        const Vector<kDim> slip = this->vector(size);
        const Response<kDim> response = this->at(contact, slip);
        const double h = 1e-4 * size;
        for (int i = 0; i < kDim; ++i) {
            const Vector<kDim> step = h * Vector<kDim>::Unit(i);
            const Response<kDim> plus = this->at(contact, slip + step);
            const Response<kDim> minus = this->at(contact, slip - step);
            // Truncation (h / size)^2 = 1e-8; rounding 1e-16 / h of the energy.
            EXPECT_NEAR(response.gradient[i], (plus.energy - minus.energy) / (2 * h), 1e-6);
            EXPECT_LT((response.hessian.col(i) - (plus.gradient - minus.gradient) / (2 * h)).norm(),
                      1e-6 * response.hessian.norm());
        }
    }
}

TYPED_TEST(FrictionTest, IsCoulombsWhereItSlipsAndLessWhereItSticks) {
    constexpr int kDim = TypeParam::value;
    const FrictionContact<kDim> contact = this->contact();
    Vector<kDim> slip = this->vector();
    slip -= contact.normal.dot(slip) * contact.normal;
    slip.normalize();
    EXPECT_NEAR(this->at(contact, 0.5 * slip).gradient.norm(), 3, 1e-12);
    EXPECT_NEAR(this->at(contact, 1e-3 * slip).gradient.norm(), 3, 1e-12);
    EXPECT_NEAR(this->at(contact, 0.5e-3 * slip).gradient.norm(), 3 * 0.75, 1e-12);  // 2 y - y^2
    EXPECT_EQ(this->at(contact, 0 * slip).gradient.norm(), 0);
    EXPECT_EQ(this->at(contact, 0 * slip).energy, 0);
}

TYPED_TEST(FrictionTest, ActsInTheTangentSpaceAndAgainstTheSlip) {
    constexpr int kDim = TypeParam::value;
    for (int k = 0; k < 50; ++k) {
        const FrictionContact<kDim> contact = this->contact();
        const Vector<kDim> slip = this->vector(k % 2 == 0 ? 1e-3 : 1);
        const Response<kDim> response = this->at(contact, slip);
        EXPECT_NEAR(response.gradient.dot(contact.normal), 0, 1e-12);
        EXPECT_GT(response.gradient.dot(slip), 0);  // the force is its negative: energy is lost
        EXPECT_LT((response.hessian * contact.normal).norm(), 1e-9 * response.hessian.norm());
        const Response<kDim> lifted = this->at(contact, slip + 0.3 * contact.normal);
        EXPECT_LT((lifted.gradient - response.gradient).norm(), 1e-12);
    }
}

TYPED_TEST(FrictionTest, HessianIsPositiveSemidefinite) {
    constexpr int kDim = TypeParam::value;
    for (const double size : {0.0, 1e-6, 0.99e-3, 1.01e-3, 1.0}) {
        const FrictionContact<kDim> contact = this->contact();
        const Response<kDim> response = this->at(contact, this->vector(size));
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kDim, kDim>> solver(
            response.hessian);
        EXPECT_GE(solver.eigenvalues().minCoeff(), -1e-9 * response.hessian.norm());
    }
}

TYPED_TEST(FrictionTest, SecantIsTheResistanceThatGivesTheSameForce) {
    constexpr int kDim = TypeParam::value;
    const FrictionContact<kDim> contact = this->contact();
    for (const double size : {1e-4, 1e-2}) {
        const Vector<kDim> slip = this->vector(size);
        const Response<kDim> secant = friction_response<kDim>(contact, slip, this->kFriction,
                                                              this->kStep, FrictionLaw::Secant);
        EXPECT_LT((secant.gradient - this->at(contact, slip).gradient).norm(), 1e-12);
        EXPECT_LT((secant.hessian * slip - secant.gradient).norm(), 1e-12);
    }
}

}  // namespace
}  // namespace pent::contact
