#include "linear/factorization.h"

#include "springy_box.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace pent::simulator {
namespace {

using test::SpringyBox;

constexpr int kDim = test::kBoxDim;

Links links_of(const SpringyBox& problem) {
    return std::visit(
        [](const auto& matrix) {
            return join(link_dofs(matrix.pattern()), link_dofs(matrix.coupling()->pattern()));
        },
        problem.system.matrix());
}

// Whatever the order of elimination, and with what couples far corners: the solution of Eigen's
// dense L L^T, up to the condition of the matrix, about 1e4, times roundings.
TEST(Factorization, SolvesAsTheDenseOneInEveryOrder) {
    for (const Precision precision : {Precision::Float, Precision::Double}) {
        const SpringyBox problem(precision);
        const Eigen::VectorXd expected = problem.dense().llt().solve(problem.b.reshaped());
        const Links links = links_of(problem);
        std::vector<std::uint32_t> order(links.size());
        std::iota(order.begin(), order.end(), 0U);
        std::mt19937 random(4);
        std::vector<Elimination> eliminations = {
            eliminate(links, at_dofs<kDim>(problem.box.dofs, problem.box.mesh.positions))};
        for (int i = 0; i < 4; ++i) {
            eliminations.push_back(eliminate(links, order));
            std::shuffle(order.begin(), order.end(), random);
        }
        for (const Elimination& elimination : eliminations) {
            for (const Isa isa : test::supported_isas()) {
                std::visit(
                    [&](const auto& matrix) {
                        const auto factors = Factorization<kDim>::make(kernels<kDim>(isa).blocks,
                                                                       matrix, elimination);
                        ASSERT_TRUE(factors.has_value());
                        const BlockVector<kDim> x = factors->solve(problem.b);
                        EXPECT_LT((x.reshaped() - expected).norm(), 1e-11 * expected.norm());
                    },
                    problem.system.matrix());
            }
        }
    }
}

// One of its eigenvalues below zero is enough, in whichever block.
TEST(Factorization, IsNoneOfAMatrixThatIsNotPositiveDefinite) {
    SpringyBox problem(Precision::Double);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(problem.dense());
    const Elimination elimination =
        eliminate(links_of(problem), at_dofs<kDim>(problem.box.dofs, problem.box.mesh.positions));
    auto& matrix = std::get<BlockMatrix<kDim, double>>(problem.system.matrix());
    const auto is_definite = [&] {
        const BlockKernels& blocks = kernels<kDim>(best_isa()).blocks;
        return Factorization<kDim>::make(blocks, matrix, elimination).has_value();
    };
    const auto lower_all_by = [&](double amount) {
        for (std::int64_t row = 0; row < matrix.rows(); ++row) {
            matrix.add_to_diagonal(row, -amount);
        }
    };
    const double lowest = parts.eigenvalues()[0];
    lower_all_by(0.99 * lowest);
    EXPECT_TRUE(is_definite());
    lower_all_by(0.02 * lowest);
    EXPECT_FALSE(is_definite());
}

}  // namespace
}  // namespace pent::simulator
