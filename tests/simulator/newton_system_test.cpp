#include "linear/newton_system.h"

#include "springy_box.h"

#include <gtest/gtest.h>

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

TEST(NewtonSystem, SaysWhereMassesDrownInTheRoundingOfStiffness) {
    EXPECT_FALSE(SpringyBox(Precision::Float, 1e-3).system.has_lost_inertia());
    EXPECT_TRUE(SpringyBox(Precision::Float, 1e-9).system.has_lost_inertia());
    EXPECT_FALSE(SpringyBox(Precision::Double, 1e-9).system.has_lost_inertia());
}

}  // namespace
}  // namespace pent::simulator
