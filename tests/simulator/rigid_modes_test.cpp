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
    Arms<kDim> arms = random_arms(1, 3);
    Eigen::MatrixXd T = dense_modes(stripes(1, 1), arms, Rows);
};

TEST(RigidModes, MoveVerticesAsTheMotionThatTheyAre) {
    const Arms<4> arms = random_arms(1, 3);
    const Aggregates one = stripes(1, 1);
    const Eigen::VectorXd c = Eigen::VectorXd::Random(kModeCount);
    const Eigen::VectorXd vertex = dense_modes(one, arms, 4) * c;
    const Eigen::VectorXd child = dense_modes(one, arms, kModeCount) * c;
    EXPECT_LT((RigidModes<4, 4>::motion(c, arms[0]) - vertex).norm(), 1e-14);
    EXPECT_LT((RigidModes<4, kModeCount>::motion(c, arms[0]) - child).norm(), 1e-14);
}

template <int Rows>
void expect_force_is_the_transpose_of_motion() {
    const OneChild<Rows> child;
    const Eigen::VectorXd r = Eigen::VectorXd::Random(Rows);
    const Eigen::VectorXd force = OneChild<Rows>::Modes::force(r, child.arms[0]);
    EXPECT_LT((force - child.T.transpose() * r).norm(), 1e-14);
}

TEST(RigidModes, HaveForcesThatAreTheTransposeOfMotionsForVerticesAndForAggregates) {
    expect_force_is_the_transpose_of_motion<kDim>();
    expect_force_is_the_transpose_of_motion<kModeCount>();
}

// Of an aggregate of every other one of nine vertices.
template <int Dim>
void expect_kernels_sum_over_children() {
    using Modes = RigidModes<Dim, Dim>;
    const std::vector<std::uint32_t> members = {1, 3, 5, 7};
    Arms<Dim> arms(members.size());
    for (Arm<Dim>& arm : arms) {
        arm.x.setRandom();
        arm.ratio = 0;
    }
    const BlockVector<Dim> r = BlockVector<Dim>::Random(Dim, 9);
    const typename Modes::Modes motion = Modes::Modes::Random();
    typename Modes::Modes expected_force = Modes::Modes::Zero();
    BlockVector<Dim> expected = r;
    for (std::size_t i = 0; i < members.size(); ++i) {
        expected_force += Modes::force(r.col(members[i]), arms[i]);
        expected.col(members[i]) += Modes::motion(motion, arms[i]);
    }
    for (const Isa isa : test::supported_isas()) {
        const BlockKernels& blocks = kernels<Dim>(isa).blocks;
        typename Modes::Modes force;
        blocks.sum_forces(children_of<Dim>(members, arms.data()), r.data(), force.data());
        EXPECT_LT((force - expected_force).norm(), 1e-14) << isa_name(isa);
        BlockVector<Dim> x = r;
        blocks.add_motions(children_of<Dim>(members, arms.data()), motion.data(), x.data());
        EXPECT_LT((x - expected).norm(), 1e-14) << isa_name(isa);
    }
}

TEST(RigidModes, AreSummedOverChildrenByKernelsOfEveryInstructionSet) {
    expect_kernels_sum_over_children<3>();
    expect_kernels_sum_over_children<4>();
}

}  // namespace
}  // namespace pent::simulator
