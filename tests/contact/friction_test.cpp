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
    static constexpr double kE = 1e-3;  // m

    Vector<kSpace> vector(double size = 1) {
        return Vector<kSpace>::NullaryExpr([&] { return size * coordinate_(random_); });
    }
    static FrictionResponse<kSpace> at(const Vector<kSpace>& normal, const Vector<kSpace>& slip) {
        return friction_response<kSpace>(normal, 3, slip, kE, FrictionLaw::Energy);
    }

    std::mt19937 random_{5};
    std::uniform_real_distribution<double> coordinate_{-1, 1};
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(FrictionTest, Dimensions);

TYPED_TEST(FrictionTest, HasDerivativesThatAreCentralDifferences) {
    constexpr int kDim = TypeParam::value;
    const Vector<kDim> normal = this->vector().normalized();
    for (const double size : {1e-5, 3e-4, 0.9e-3, 2e-3, 0.1}) {
        const Vector<kDim> slip = this->vector(size);
        const FrictionResponse<kDim> response = this->at(normal, slip);
        const double h = 1e-4 * size;
        for (int i = 0; i < kDim; ++i) {
            const Vector<kDim> step = h * Vector<kDim>::Unit(i);
            const FrictionResponse<kDim> plus = this->at(normal, slip + step);
            const FrictionResponse<kDim> minus = this->at(normal, slip - step);
            // Truncation (h / size)^2 = 1e-8; rounding 1e-16 / h of the energy.
            EXPECT_NEAR(response.gradient[i], (plus.energy - minus.energy) / (2 * h), 1e-6);
            EXPECT_LT((response.hessian.col(i) - (plus.gradient - minus.gradient) / (2 * h)).norm(),
                      1e-6 * response.hessian.norm());
        }
    }
}

TYPED_TEST(FrictionTest, IsCoulombsWhereItSlipsAndLessWhereItSticks) {
    constexpr int kDim = TypeParam::value;
    const Vector<kDim> normal = this->vector().normalized();
    Vector<kDim> slip = this->vector();
    slip -= normal.dot(slip) * normal;
    slip.normalize();
    EXPECT_NEAR(this->at(normal, 0.5 * slip).gradient.norm(), 3, 1e-12);
    EXPECT_NEAR(this->at(normal, 1e-3 * slip).gradient.norm(), 3, 1e-12);
    EXPECT_NEAR(this->at(normal, 0.5e-3 * slip).gradient.norm(), 3 * 0.75, 1e-12);  // 2 y - y^2
    EXPECT_EQ(this->at(normal, 0 * slip).gradient.norm(), 0);
    EXPECT_EQ(this->at(normal, 0 * slip).energy, 0);
}

TYPED_TEST(FrictionTest, ActsInTheTangentSpaceAndAgainstTheSlip) {
    constexpr int kDim = TypeParam::value;
    for (int k = 0; k < 50; ++k) {
        const Vector<kDim> normal = this->vector().normalized();
        const Vector<kDim> slip = this->vector(k % 2 == 0 ? 1e-3 : 1);
        const FrictionResponse<kDim> response = this->at(normal, slip);
        EXPECT_NEAR(response.gradient.dot(normal), 0, 1e-12);
        EXPECT_GT(response.gradient.dot(slip), 0);  // the force is its negative: energy is lost
        EXPECT_LT((response.hessian * normal).norm(), 1e-9 * response.hessian.norm());
        const FrictionResponse<kDim> lifted = this->at(normal, slip + 0.3 * normal);
        EXPECT_LT((lifted.gradient - response.gradient).norm(), 1e-12);
    }
}

TYPED_TEST(FrictionTest, HessianIsPositiveSemidefinite) {
    constexpr int kDim = TypeParam::value;
    for (const double size : {0.0, 1e-6, 0.99e-3, 1.01e-3, 1.0}) {
        const Vector<kDim> normal = this->vector().normalized();
        const FrictionResponse<kDim> response = this->at(normal, this->vector(size));
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kDim, kDim>> solver(
            response.hessian);
        EXPECT_GE(solver.eigenvalues().minCoeff(), -1e-9 * response.hessian.norm());
    }
}

TYPED_TEST(FrictionTest, SecantIsTheResistanceThatGivesTheSameForce) {
    constexpr int kDim = TypeParam::value;
    const Vector<kDim> normal = this->vector().normalized();
    for (const double size : {1e-4, 1e-2}) {
        const Vector<kDim> slip = this->vector(size);
        const FrictionResponse<kDim> secant =
            friction_response<kDim>(normal, 3, slip, this->kE, FrictionLaw::Secant);
        EXPECT_LT((secant.gradient - this->at(normal, slip).gradient).norm(), 1e-12);
        EXPECT_LT((secant.hessian * slip - secant.gradient).norm(), 1e-12);
    }
}

// As f1 is concave: so a step with it in place of the Hessian never leads up.
TYPED_TEST(FrictionTest, SecantIsNowhereBelowTheHessian) {
    constexpr int kDim = TypeParam::value;
    const Vector<kDim> normal = this->vector().normalized();
    for (const double size : {1e-5, 3e-4, 0.9e-3, 2e-3, 0.1}) {
        const Vector<kDim> slip = this->vector(size);
        const FrictionResponse<kDim> secant =
            friction_response<kDim>(normal, 3, slip, this->kE, FrictionLaw::Secant);
        const Block<kDim> more = secant.hessian - this->at(normal, slip).hessian;
        const Eigen::SelfAdjointEigenSolver<Block<kDim>> solver(more);
        EXPECT_GE(solver.eigenvalues().minCoeff(), -1e-12 * secant.hessian.norm());
        EXPECT_GT(solver.eigenvalues().maxCoeff(), 0);
    }
}

template <typename T>
class LaggedFrictionTest : public FrictionTest<T> {
protected:
    static constexpr int kSpace = T::value;
    static constexpr double kStep = 0.01;
    inline static const Friction kFriction{.coefficient = 0.5, .slip_speed = 0.1};  // e = 1e-3 m

    // Contacts of random vertices, one of them with an obstacle and one without a force.
    void SetUp() override {
        positions_ = Positions<kSpace>::NullaryExpr(kSpace, 9, [&] { return this->vector()[0]; });
        for (std::uint32_t k = 0; k < 6; ++k) {
            Contact<kSpace> contact;
            contact.count = k == 5 ? 1 : kSpace + 1;
            for (std::uint32_t i = 0; i <= kSpace; ++i) {
                contact.vertices[i] = (k + 2 * i) % 9;
                contact.weights[i] = this->vector()[0];
            }
            contact.direction = this->vector().normalized();
            contact.slope = k == 0 ? 0 : -2.0 * k;
            contacts_.push_back(contact);
        }
    }

    [[nodiscard]] Positions<kSpace> near(double size) {
        return positions_ + Positions<kSpace>::NullaryExpr(kSpace, 9, [&] {
                   return size * this->vector()[0];
               });
    }
    static double energy(const LaggedFriction<kSpace>& friction, const Positions<kSpace>& x) {
        Positions<kSpace> unused = Positions<kSpace>::Zero(kSpace, x.cols());
        return friction.add_gradient(x, unused);
    }
    static Positions<kSpace> gradient(const LaggedFriction<kSpace>& friction,
                                      const Positions<kSpace>& x) {
        Positions<kSpace> gradient = Positions<kSpace>::Zero(kSpace, x.cols());
        friction.add_gradient(x, gradient);
        return gradient;
    }
    static Positions<kSpace> product(LaggedFriction<kSpace>& friction,
                                     const Positions<kSpace>& x,
                                     const Positions<kSpace>& way) {
        Positions<kSpace> product = Positions<kSpace>::Zero(kSpace, x.cols());
        for (const WeightedHessian<kSpace>& hessian : friction.hessians(x).weighted) {
            Vector<kSpace> sum = Vector<kSpace>::Zero();
            for (int i = 0; i < hessian.count; ++i) {
                sum += hessian.weights[i] * way.col(hessian.vertices[i]);
            }
            for (int i = 0; i < hessian.count; ++i) {
                product.col(hessian.vertices[i]) += hessian.weights[i] * hessian.block * sum;
            }
        }
        return product;
    }

    Positions<kSpace> positions_;
    std::vector<Contact<kSpace>> contacts_;
};
TYPED_TEST_SUITE(LaggedFrictionTest, Dimensions);

TYPED_TEST(LaggedFrictionTest, HasDerivativesThatAreCentralDifferences) {
    constexpr int kDim = TypeParam::value;
    LaggedFriction<kDim> friction(this->kFriction);
    for (const double size : {2e-4, 0.1}) {  // sticks, slips
        friction.begin_step(this->contacts_, this->positions_, nullptr, this->kStep);
        EXPECT_EQ(friction.size(), 5U);  // one has no force
        const Positions<kDim> x = this->near(size);
        const Positions<kDim> way = this->near(1) - this->positions_;
        const double h = 1e-4 * size;
        const Positions<kDim> gradient = this->gradient(friction, x);
        // Truncation (h / size)^2 = 1e-8; rounding 1e-16 / h.
        EXPECT_NEAR(
            gradient.cwiseProduct(way).sum(),
            (this->energy(friction, x + h * way) - this->energy(friction, x - h * way)) / (2 * h),
            1e-5 * gradient.norm() * way.norm());
        const Positions<kDim> product = this->product(friction, x, way);
        EXPECT_LT((product
                   - (this->gradient(friction, x + h * way) - this->gradient(friction, x - h * way))
                         / (2 * h))
                      .norm(),
                  1e-5 * product.norm());
    }
}

// Where the slip has turned around, for some times, or until the next step.
TYPED_TEST(LaggedFrictionTest, HasTheSecantForItsHessianOnceTheSlipHasTurned) {
    constexpr int kDim = TypeParam::value;
    LaggedFriction<kDim> friction(this->kFriction);
    const Positions<kDim> way = this->near(1) - this->positions_;
    const auto at = [&](double t) { return Positions<kDim>(this->positions_ + t * way); };
    const auto start = [&] {
        friction.begin_step(this->contacts_, this->positions_, nullptr, this->kStep);
    };
    // Along the slip the Hessian is 0 beyond e, and the secant gives the force.
    const auto of_slip = [&](double t) {
        return Positions<kDim>(t * this->product(friction, at(t), way));
    };
    start();
    const double scale = this->gradient(friction, at(1)).norm();
    EXPECT_LT(of_slip(1).norm(), 1e-12 * scale);
    EXPECT_LT(of_slip(0.5).norm(), 1e-12 * scale);
    for (const double t : {-1.0, -2.0, 3.0}) {
        EXPECT_LT((of_slip(t) - this->gradient(friction, at(t))).norm(), 1e-12 * scale) << t;
    }
    int secants = 0;
    while (of_slip(3).norm() > 1e-12 * scale) {
        ASSERT_LT(++secants, 100);
    }
    EXPECT_GT(secants, 3);
    start();
    EXPECT_LT(of_slip(1).norm(), 1e-12 * scale);
}

TYPED_TEST(LaggedFrictionTest, OfBodiesWithTheirOwnIsThatOfTheGeometricMean) {
    constexpr int kDim = TypeParam::value;
    Friction own = this->kFriction;
    own.of_bodies = {0.2, 0.8, 0};
    const auto body = [](std::uint32_t i) { return Collider{Collider::Kind::Body, i}; };
    const Collider obstacle{Collider::Kind::Obstacle, 1};
    EXPECT_DOUBLE_EQ(own.between(body(0), body(1)), 0.4);
    EXPECT_EQ(own.between(body(1), body(1)), 0.8);
    EXPECT_EQ(own.between(body(0), body(2)), 0);
    EXPECT_DOUBLE_EQ(own.between(body(0), obstacle), std::sqrt(0.2 * own.coefficient));
    // A body without any is not looked at.
    for (Contact<kDim>& contact : this->contacts_) {
        contact.first = body(2);
    }
    LaggedFriction<kDim> friction(own);
    friction.begin_step(this->contacts_, this->positions_, nullptr, this->kStep);
    EXPECT_EQ(friction.size(), 0U);
}

TYPED_TEST(LaggedFrictionTest, IsNothingWhereTheStepStarts) {
    constexpr int kDim = TypeParam::value;
    LaggedFriction<kDim> friction(this->kFriction);
    friction.begin_step(this->contacts_, this->positions_, nullptr, this->kStep);
    EXPECT_EQ(this->energy(friction, this->positions_), 0);
    EXPECT_EQ(this->gradient(friction, this->positions_).norm(), 0);
}

// What slips is the body on the obstacle: where both have gone the same way nothing does, and where
// the obstacle alone has, as where the body has gone back.
TYPED_TEST(LaggedFrictionTest, IsThatOfTheWayRelativeToAnObstacleThatMoves) {
    constexpr int kDim = TypeParam::value;
    std::uint32_t vertex = 0;
    for (Contact<kDim>& contact : this->contacts_) {
        contact.count = 1;
        contact.vertices[0] = vertex++;  // the first has no force
        contact.weights[0] = 1;
        contact.second = {Collider::Kind::Obstacle, 0};
    }
    const Positions<kDim> velocities = this->near(1) - this->positions_;
    for (const double size : {2e-4, 0.1}) {  // sticks, slips
        const Vector<kDim> carried = this->vector(size);
        const auto start = [&](const Positions<kDim>* v, const Vector<kDim>& way) {
            LaggedFriction<kDim> friction(this->kFriction);
            friction.begin_step(this->contacts_, this->positions_, v, this->kStep,
                                [&](const Contact<kDim>&) { return way; });
            return friction;
        };
        const Positions<kDim> along = this->positions_.colwise() + carried;
        const Positions<kDim> x = this->near(size);
        EXPECT_LT(this->gradient(start(nullptr, carried), along).norm(), 1e-9);
        const Positions<kDim> moved = this->gradient(start(nullptr, carried), x);
        const Positions<kDim> still =
            this->gradient(start(nullptr, Vector<kDim>::Zero()), x.colwise() - carried);
        EXPECT_LT((moved - still).norm(), 1e-9 * still.norm());
        for (Eigen::Index v = 0; v < moved.cols(); ++v) {
            EXPECT_EQ(moved.col(v).norm() > 0, v >= 1 && v <= 5) << v;
        }
        // In a linear step the resistance is that of the relative velocities, too.
        const Positions<kDim> relative = velocities.colwise() - carried / this->kStep;
        const Positions<kDim> linear = this->gradient(start(&velocities, carried), x);
        const Positions<kDim> linear_still =
            this->gradient(start(&relative, Vector<kDim>::Zero()), x.colwise() - carried);
        EXPECT_LT((linear - linear_still).norm(), 1e-9 * linear_still.norm());
        // Bodies among themselves are carried by nothing.
        for (Contact<kDim>& contact : this->contacts_) {
            contact.second = {Collider::Kind::Body, 1};
        }
        EXPECT_EQ(this->gradient(start(nullptr, carried), this->positions_).norm(), 0);
        for (Contact<kDim>& contact : this->contacts_) {
            contact.second = {Collider::Kind::Obstacle, 0};
        }
    }
}

// For a single linear solve: the resistance is that of the slip at the velocities of the start,
// held.
TYPED_TEST(LaggedFrictionTest, OfALinearStepIsLinearAndRightAtTheVelocitiesOfTheStart) {
    constexpr int kDim = TypeParam::value;
    const Positions<kDim> velocities = this->near(1) - this->positions_;
    LaggedFriction<kDim> linear(this->kFriction);
    linear.begin_step(this->contacts_, this->positions_, &velocities, this->kStep);
    LaggedFriction<kDim> exact(this->kFriction);
    exact.begin_step(this->contacts_, this->positions_, nullptr, this->kStep);
    const auto at = [&](double times) -> Positions<kDim> {
        return this->positions_ + times * this->kStep * velocities;
    };
    const Positions<kDim> whole = this->gradient(linear, at(1));
    EXPECT_LT((whole - this->gradient(exact, at(1))).norm(), 1e-10 * whole.norm());
    EXPECT_LT((2 * whole - this->gradient(linear, at(2))).norm(), 1e-10 * whole.norm());
    EXPECT_LT((this->product(linear, at(0), velocities) * this->kStep - whole).norm(),
              1e-10 * whole.norm());
}

}  // namespace
}  // namespace pent::contact
