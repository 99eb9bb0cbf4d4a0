#include "linear/newton_system.h"

#include "springy_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pent::simulator {
namespace {

using test::ElasticBox;
using test::SpringyBox;

constexpr int kDim = test::kBoxDim;

TEST(NewtonSystem, IsTheSumOfItsPartsLessTheShareOfVerticesWithoutDofs) {
    const SpringyBox problem(Precision::Double);
    ElasticBox<kDim> free({.lame = {.lambda = 2, .mu = 1}});
    free.positions = problem.box.positions;
    const Eigen::MatrixXd by_dof = free.stiffness<double>(best_isa(), Filter::Clamp);
    const Eigen::Index total = free.mesh.vertex_count();
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(kDim * total, kDim * total);
    for (std::uint32_t a = 0; a < total; ++a) {
        for (std::uint32_t c = 0; c < total; ++c) {
            full.block<kDim, kDim>(kDim * a, kDim * c) =
                by_dof.block<kDim, kDim>(kDim * free.dofs.dof_of(a), kDim * free.dofs.dof_of(c));
        }
        full.diagonal().segment<kDim>(kDim * a).array() += 2 * problem.masses[a];
    }
    for (const int i : {0, 1}) {
        for (const int j : {0, 1}) {
            full.block<kDim, kDim>(kDim * problem.ends[static_cast<std::size_t>(i)],
                                   kDim * problem.ends[static_cast<std::size_t>(j)]) +=
                (i == j ? 1 : -1) * problem.spring;
        }
    }
    const Eigen::MatrixXd matrix = problem.dense();
    const DofMap& dofs = problem.box.dofs;
    BlockVector<kDim> right = problem.b;
    for (std::uint32_t row = 0; row < dofs.count(); ++row) {
        for (std::uint32_t vertex = 0; vertex < total; ++vertex) {
            const Eigen::Matrix4d block =
                full.block<kDim, kDim>(kDim * dofs.vertex_of(row), kDim * vertex);
            if (dofs.has_dof(vertex)) {
                EXPECT_LT((matrix.block<kDim, kDim>(kDim * row, kDim * dofs.dof_of(vertex)) - block)
                              .norm(),
                          1e-13 * full.norm());
            } else {
                right.col(row) -= block * problem.displacement.col(vertex);
            }
        }
    }
    EXPECT_LT((problem.system.right() - right).norm(), 1e-13 * right.norm());
    EXPECT_GT((problem.b - right).norm(), 1e-2 * right.norm());
}

// A stiffness strains no translation; that of floats does by its rounding, here some hundredth of
// the masses.
TEST(NewtonSystem, MassesAloneResistTranslationsWhereFloatsRoundTheStiffness) {
    ElasticBox<kDim> box({.lame = {.lambda = 2, .mu = 1}});
    box.scramble(0.1, 1);
    const Workers workers(2);
    NewtonSystem<kDim> system(workers, box.dofs, box.pattern, Precision::Float);
    system.begin(BlockVector<kDim>::Zero(kDim, box.pattern.rows()), 0 * box.positions);
    auto& matrix = std::get<BlockMatrix<kDim, float>>(system.matrix());
    box.elements->add_hessian(workers, kernels<kDim>(best_isa()), box.positions,
                              target_in(matrix, 1, Filter::Clamp));
    const double stiffness = ElasticBox<kDim>::dense(matrix).diagonal().maxCoeff();
    const double mass =
        stiffness * static_cast<double>(std::numeric_limits<float>::epsilon()) / 0.01;
    system.add_masses(2, Eigen::VectorXd::Constant(box.mesh.vertex_count(), mass));
    system.weigh_masses();
    ASSERT_FALSE(system.has_lost_inertia());
    system.finish();
    const Eigen::MatrixXd rounded = ElasticBox<kDim>::dense(matrix);
    const double total = 2 * mass * static_cast<double>(box.mesh.vertex_count());
    double off = 0;  // by the rounded blocks alone
    for (int axis = 0; axis < kDim; ++axis) {
        BlockVector<kDim> shift = BlockVector<kDim>::Zero(kDim, box.pattern.rows());
        shift.row(axis).setOnes();
        BlockVector<kDim> force(kDim, box.pattern.rows());
        matrix.multiply(workers, kernels<kDim>(best_isa()).blocks, shift, force);
        const Eigen::Vector4d sum = force.rowwise().sum();
        EXPECT_LT((sum - total * Eigen::Vector4d::Unit(axis)).norm(), 1e-9 * total);
        const Eigen::VectorXd moved = shift.reshaped();
        off = std::max(off, std::abs(moved.dot(rounded * moved) - total));
    }
    EXPECT_GT(off, 1e-4 * total);
}

TEST(NewtonSystem, SaysWhereMassesDrownInTheRoundingOfStiffness) {
    EXPECT_FALSE(SpringyBox(Precision::Float, 1e-3).system.has_lost_inertia());
    EXPECT_TRUE(SpringyBox(Precision::Float, 1e-9).system.has_lost_inertia());
    EXPECT_FALSE(SpringyBox(Precision::Double, 1e-9).system.has_lost_inertia());
}

TEST(NewtonSystem, WeighsTheSumOfAllMassesHoweverTheyAreAdded) {
    for (const double mass : {1e-3, 1e-9}) {
        SpringyBox problem(Precision::Float, mass);
        const bool has_lost_inertia = problem.system.has_lost_inertia();
        problem.system.add_masses(1e-9, problem.masses);
        problem.system.weigh_masses();
        EXPECT_EQ(problem.system.has_lost_inertia(), has_lost_inertia) << mass;
    }
}

}  // namespace
}  // namespace pent::simulator
