#include "compare.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pent::study {
namespace {

TEST(RmsDistance, WeighsByMass) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(4, 2);
    Eigen::MatrixXd b = a;
    b(0, 0) = 3;  // one vertex is 3 away, the other 1
    b(3, 1) = 1;
    EXPECT_DOUBLE_EQ(rms_distance(a, b, Eigen::Vector2d(1, 8)), std::sqrt((9.0 + 8.0) / 9.0));
    EXPECT_EQ(rms_distance(a, a, Eigen::Vector2d(1, 8)), 0);
}

// Two masses m at +-r along axis i that move at +-v along axis j: 2 m r v in plane ij, 0 in others.
TEST(AngularMomentum, OfASpinInOnePlaneIsInThatPlaneAlone) {
    for (int dim = 3; dim <= 4; ++dim) {
        int plane = 0;
        for (int i = 0; i < dim; ++i) {
            for (int j = i + 1; j < dim; ++j, ++plane) {
                Moment moment;
                // Far from the origin, and in motion some other way.
                moment.positions = Eigen::VectorXd::LinSpaced(dim, 5, 9).replicate(1, 2);
                moment.velocities = Eigen::VectorXd::LinSpaced(dim, 7, -1).replicate(1, 2);
                moment.positions(i, 0) += 2;
                moment.positions(i, 1) -= 2;
                moment.velocities(j, 0) += 3;
                moment.velocities(j, 1) -= 3;
                Eigen::VectorXd expected = Eigen::VectorXd::Zero(dim * (dim - 1) / 2);
                expected[plane] = 2 * 10 * 2 * 3;
                EXPECT_LT((angular_momentum(moment, Eigen::Vector2d(10, 10)) - expected).norm(),
                          1e-12);
            }
        }
    }
}

// Whatever the axes: with v = S x, S symmetric, all r_i v_j = r_j v_i where masses are alike in all
// directions.
TEST(AngularMomentum, OfAStretchIsNone) {
    for (int dim = 3; dim <= 4; ++dim) {
        Moment moment;
        moment.positions.resize(dim, 2 * dim);
        moment.positions << Eigen::MatrixXd::Identity(dim, dim),
            -Eigen::MatrixXd::Identity(dim, dim);
        const Eigen::MatrixXd any = Eigen::MatrixXd::Random(dim, dim);
        const Eigen::VectorXd masses = Eigen::VectorXd::Constant(2 * dim, 3.0);
        moment.velocities = (any + any.transpose()) * moment.positions;
        EXPECT_LT(angular_momentum(moment, masses).norm(), 1e-14);
        moment.velocities = (any - any.transpose()) * moment.positions;
        EXPECT_GT(angular_momentum(moment, masses).norm(), 1);
    }
}

// Two bodies that meet and part put in and take out 3 J; then one comes to rest on 2 J, by way
// of 5.
TEST(ContactWork, IsTheSumOfAllRisesOfTheEnergyInContacts) {
    std::vector<StepRecord> steps;
    for (const double energy : {0.0, 1.0, 3.0, 2.0, 0.0, 0.0, 5.0, 1.0, 2.0, 2.0}) {
        steps.push_back({.contact_energy = energy});
    }
    EXPECT_DOUBLE_EQ(contact_work(steps), 3 + 5 + 1);
    steps.front().contact_energy = 4;  // there from the first step on: put in during that step
    EXPECT_DOUBLE_EQ(contact_work(steps), 4 + 2 + 5 + 1);
    EXPECT_EQ(contact_work({}), 0);
}

TEST(Convergence, OfErrorsThatFallAsAPowerGivesTheOrderAndTheErrorOfTheFinest) {
    for (const double order : {1.0, 2.0, 3.5}) {
        const auto error = [&](int level) { return 0.4 * std::pow(0.5, order * level); };
        const Convergence result = convergence_of(error(0) - error(1), error(1) - error(2));
        EXPECT_TRUE(result.is_converged);
        EXPECT_NEAR(result.order, order, 1e-12);
        EXPECT_NEAR(result.error_bar, error(2), 1e-12);
    }
}

TEST(Convergence, IsDeniedWhereDifferencesDoNotFall) {
    EXPECT_FALSE(convergence_of(0.1, 0.1).is_converged);
    EXPECT_FALSE(convergence_of(0.1, 0.3).is_converged);
    EXPECT_EQ(convergence_of(0.1, 0.3).error_bar, 0.3);
    EXPECT_FALSE(convergence_of(0.1, 0.1 * std::exp2(-0.4)).is_converged);
    EXPECT_TRUE(convergence_of(0.1, 0.1 * std::exp2(-0.6)).is_converged);
}

TEST(Convergence, IsGrantedWhereEveryStepIsExact) {
    EXPECT_TRUE(convergence_of(0, 0).is_converged);
    EXPECT_EQ(convergence_of(0, 0).error_bar, 0);
    EXPECT_TRUE(convergence_of(0.5, 1e-13).is_converged);
    EXPECT_FALSE(convergence_of(2, 1e-13).is_converged);  // more than all motion: by accident
}

}  // namespace
}  // namespace pent::study
