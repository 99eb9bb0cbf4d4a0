#include "linear/shared_coarse_solver.h"

#include "aggregate_levels.h"
#include "cut_matrix.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

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

// A rank that keeps what it is asked to make a solver for, and makes none.
class KeepingRank final : public Ranks {
public:
    KeepingRank(std::shared_ptr<const Ranks> ranks, SpreadMatrix& kept)
        : ranks_(std::move(ranks)), kept_(&kept) {}

    [[nodiscard]] int count() const override { return ranks_->count(); }
    [[nodiscard]] int rank() const override { return ranks_->rank(); }
    [[nodiscard]] std::vector<double> gather(std::span<const double> own,
                                             std::span<const std::int64_t> sizes) const override {
        return ranks_->gather(own, sizes);
    }
    [[nodiscard]] std::unique_ptr<GhostExchange> make_exchange(
        const Ghosts& ghosts) const override {
        return ranks_->make_exchange(ghosts);
    }
    [[nodiscard]] std::unique_ptr<SpreadSolver> make_solver(
        const SpreadMatrix& matrix) const override {
        *kept_ = matrix;
        return nullptr;
    }
    [[nodiscard]] RankTraffic take_traffic() const override { return ranks_->take_traffic(); }

private:
    std::shared_ptr<const Ranks> ranks_;
    SpreadMatrix* kept_;
};

// A body that is nowhere held has no stiffness against rigid motions: aggregates, of five vertices
// or of one, have none either, moved as their part of one.
TEST(SharedCoarseSolver, TellsTheRigidMotionsThatItsMatrixHasNoStiffnessAgainst) {
    constexpr int kRanks = 3;
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>({6, 4, 3, 2}, {3, 2, 1.5, 1});
    mesh.positions += 0.05 * Positions<4>::Random(4, mesh.vertex_count());
    const test::ElasticBox<4> box(mesh, {.lame = {.lambda = 2, .mu = 1}}, ElementKind::Linear);
    BlockMatrix<4, double> whole(box.pattern);
    const Workers workers(1);
    box.elements->add_hessian(workers, kernels<4>(Isa::Baseline), box.positions,
                              target_in(whole, 1, Filter::Clamp));
    std::vector<std::uint32_t> owners;
    for (std::uint32_t dof = 0; dof < whole.rows(); ++dof) {
        owners.push_back(dof * dof % 7 % kRanks);
    }
    for (const std::uint32_t most : {1U, 5U}) {
        std::array<SpreadMatrix, kRanks> kept;
        test::on_ranks(kRanks, [&](const std::shared_ptr<const Ranks>& ranks) {
            const auto rank = static_cast<std::size_t>(ranks->rank());
            const CutMatrix cut(whole, owners, std::make_shared<KeepingRank>(ranks, kept[rank]));
            const auto rows = static_cast<std::uint32_t>(cut.A->rows());
            const Hierarchy hierarchy({test::by_number(rows, most)}, cut.pattern, nullptr,
                                      {&cut.sharing, cut.exchange.get()}, cut.ghosts);
            const HierarchyLevel& level = hierarchy.levels[0];
            Positions<4> positions(4, whole.rows());
            for (std::uint32_t column = 0; column < positions.cols(); ++column) {
                positions.col(column) = box.positions.col(box.dofs.vertex_of(cut.dofs[column]));
            }
            const ChildPlaces<4> vertices(positions);
            const AggregatePlaces<4> places = places_of(workers, level.aggregates, vertices);
            const auto A = galerkin_product(
                workers, kernels<4>(Isa::Baseline).blocks, *cut.A, level.aggregates,
                arms_of(workers, level.aggregates, vertices, places, cut.exchange.get()),
                level.pattern);
            const SharedCoarseSolver<4, double> solver(workers, A, level, places, &cut.sharing);
        });
        const std::int64_t count = kept.back().first_row + kept.back().rows();
        ASSERT_GT(count, 64) << "too few for rows to be spread";
        Eigen::MatrixXd motions(kModeCount * count, kModeCount);
        for (const SpreadMatrix& own : kept) {
            ASSERT_EQ(own.block_size, kModeCount);
            motions.middleRows(kModeCount * own.first_row, own.near_kernel.rows()) =
                own.near_kernel;
        }
        Eigen::MatrixXd image = Eigen::MatrixXd::Zero(motions.rows(), kModeCount);
        Eigen::VectorXd squares = Eigen::VectorXd::Zero(motions.rows());  // of the rows of A
        for (const SpreadMatrix& own : kept) {
            for (std::int64_t i = 0; i < own.rows(); ++i) {
                const Eigen::Index row = kModeCount * (own.first_row + i);
                for (std::int64_t k = own.row_start[static_cast<std::size_t>(i)];
                     k < own.row_start[static_cast<std::size_t>(i) + 1]; ++k) {
                    using Block = Eigen::Matrix<double, kModeCount, kModeCount, Eigen::RowMajor>;
                    const Block block =
                        Eigen::Map<const Block>(own.values.data() + k * Block::SizeAtCompileTime);
                    image.middleRows<kModeCount>(row) +=
                        block
                        * motions.middleRows<kModeCount>(
                            kModeCount * own.columns[static_cast<std::size_t>(k)]);
                    squares.segment<kModeCount>(row) += block.rowwise().squaredNorm();
                }
            }
        }
        for (Eigen::Index row = 0; row < image.rows(); ++row) {
            if (squares[row] == 1) {  // of a rotation of a single vertex, which moves none
                image.row(row).setZero();
            }
        }
        // 1e-10 is added to the diagonal.
        EXPECT_LT(image.norm(), 1e-9 * std::sqrt(squares.sum()) * motions.norm());
        EXPECT_GT(motions.jacobiSvd().singularValues().minCoeff(), 1e-2 * motions.norm());
    }
}

}  // namespace
}  // namespace pent::simulator
