#include "linear/shared_coarse_solver.h"

#include "aggregate_levels.h"
#include "cut_matrix.h"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using test::CutMatrix;
using test::kModeCount;

// A chain of single vertices: translations are all that each has.
struct Chain {
    BlockPattern pattern;
    std::unique_ptr<BlockMatrix<4, double>> A;
    Eigen::MatrixXd dense;

    explicit Chain(std::uint32_t count) : dense(Eigen::MatrixXd::Zero(count, count)) {
        pattern.row_start.push_back(0);
        for (std::uint32_t row = 0; row < count; ++row) {
            pattern.columns.push_back(row);
            if (row + 1 < count) {
                pattern.columns.push_back(row + 1);
            }
            pattern.row_start.push_back(static_cast<std::int64_t>(pattern.columns.size()));
        }
        color_rows(pattern, count);
        A = std::make_unique<BlockMatrix<4, double>>(pattern);
        for (std::uint32_t row = 0; row < count; ++row) {
            for (std::int64_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
                const std::uint32_t column = pattern.columns[static_cast<std::size_t>(k)];
                const double value = column == row ? 2.1 : -1;
                A->set_block(k, value * Eigen::Matrix4d::Identity());
                dense(row, column) = value;
                dense(column, row) = value;
            }
        }
    }
};

// By all rows on every rank, and by a solver for rows that are spread where there are more than 64.
TEST(SharedCoarseSolver, SolvesForAllRanksHoweverManyRowsThereAre) {
    for (const std::uint32_t count : {30U, 70U}) {
        const Chain chain(count);
        std::vector<std::uint32_t> owners;
        for (std::uint32_t dof = 0; dof < count; ++dof) {
            owners.push_back(dof * dof % 5 % 3);
        }
        const Eigen::VectorXd r = Eigen::VectorXd::Random(count);
        const Eigen::VectorXd expected = chain.dense.llt().solve(r);
        test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
            const CutMatrix cut(*chain.A, owners, ranks);
            const auto rows = static_cast<std::uint32_t>(cut.A->rows());
            const Hierarchy hierarchy({test::by_number(rows, 1)}, cut.pattern, nullptr,
                                      {&cut.sharing, cut.exchange.get()}, cut.ghosts);
            const HierarchyLevel& level = hierarchy.levels[0];
            Positions<4> positions = Positions<4>::Zero(4, count);
            for (std::uint32_t column = 0; column < count; ++column) {
                positions(0, column) = cut.dofs[column];
            }
            const ChildPlaces<4> vertices(positions);
            const AggregatePlaces<4> places = places_of(Workers(1), level.aggregates, vertices);
            const auto A = galerkin_product(
                Workers(1), kernels<4>(Isa::Baseline).blocks, *cut.A, level.aggregates,
                arms_of(Workers(1), level.aggregates, vertices, places, cut.exchange.get()),
                level.pattern);
            const SharedCoarseSolver<4, double> solver(Workers(1), A, level, places, &cut.sharing);
            Eigen::VectorXd forces = Eigen::VectorXd::Zero(kModeCount * rows);
            for (std::uint32_t row = 0; row < rows; ++row) {
                forces[kModeCount * row + 2] = r[cut.dofs[row]];
            }
            Eigen::VectorXd z;
            solver.solve(Workers(1), forces, z);
            for (std::uint32_t row = 0; row < rows; ++row) {
                // 1e-10 is added to the diagonal.
                EXPECT_NEAR(z[kModeCount * row + 2], expected[cut.dofs[row]], 1e-8);
                EXPECT_EQ(z[kModeCount * row], 0);
            }
        });
    }
}

}  // namespace
}  // namespace pent::simulator
