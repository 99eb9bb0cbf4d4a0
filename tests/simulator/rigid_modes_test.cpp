#include "linear/rigid_modes.h"

#include "aggregate_levels.h"

#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using test::dense_modes;
using test::kModeCount;
using test::random_arms;
using test::stripes;

constexpr int kDim = 4;

template <int Rows>
struct OneChild {
    using Modes = RigidModes<kDim, Rows>;
    std::vector<Arm<kDim>> arms = random_arms(1, 3);
    Eigen::MatrixXd T = dense_modes(stripes(1, 1), arms, Rows);
};

TEST(RigidModes, MoveVerticesAsTheMotionThatTheyAre) {
    const std::vector<Arm<4>> arms = random_arms(1, 3);
    const Aggregates one = stripes(1, 1);
    const Eigen::VectorXd c = Eigen::VectorXd::Random(kModeCount);
    const Eigen::VectorXd vertex = dense_modes(one, arms, 4) * c;
    const Eigen::VectorXd child = dense_modes(one, arms, kModeCount) * c;
    EXPECT_LT((RigidModes<4, 4>::motion(c, arms[0]) - vertex).norm(), 1e-14);
    EXPECT_LT((RigidModes<4, kModeCount>::motion(c, arms[0]) - child).norm(), 1e-14);
}

// Force is the transpose of motion, and the two products are those of the matrix of both.
template <int Rows>
void expect_products_of_the_matrix() {
    const OneChild<Rows> child;
    using Modes = typename OneChild<Rows>::Modes;
    const Eigen::VectorXd r = Eigen::VectorXd::Random(Rows);
    EXPECT_LT((Modes::force(r, child.arms[0]) - child.T.transpose() * r).norm(), 1e-14);
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(Rows, Rows);
    const typename Modes::Product product = Modes::times(A, child.arms[0]);
    EXPECT_LT((product - A * child.T).norm(), 1e-13);
    typename Modes::Square sum = Modes::Square::Ones();
    Modes::add_transposed_times(product, child.arms[0], sum);
    const Eigen::MatrixXd expected = child.T.transpose() * A * child.T;
    EXPECT_LT((sum - Modes::Square::Ones() - expected).norm(), 1e-12);
}

TEST(RigidModes, GiveTheProductsOfTheirMatrixForVerticesAndForAggregates) {
    expect_products_of_the_matrix<kDim>();
    expect_products_of_the_matrix<kModeCount>();
}

}  // namespace
}  // namespace pent::simulator
