// The preconditioner on ranks that are threads of this process, beside dense matrices made from its
// definition.

#include "aggregate_levels.h"
#include "cut_matrix.h"
#include "elastic_box.h"
#include "linear/aggregate_places.h"
#include "linear/gauss_seidel.h"
#include "linear/preconditioner.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace pent::simulator {
namespace {

using test::by_number;
using test::CutMatrix;
using test::ElasticBox;
using test::kModeCount;

const BlockKernels& blocks() {
    return kernels<4>(Isa::Baseline).blocks;
}

// A matrix over 81 dofs, shared out to three ranks.
struct SharedBox {
    ElasticBox<4> box{pent::test::kuhn_box<4>({2, 2, 2, 2}, {1, 1.2, 1.4, 1.6}),
                      {.lame = {.lambda = 2, .mu = 1}},
                      ElementKind::Linear};
    BlockMatrix<4, double> A{box.pattern};
    BlockVector<4> positions;
    std::vector<std::uint32_t> owners;

    // By parts that lie one beside the other; or mixed, so that most neighbors of every vertex are
    // of others, and with a term |sum of its vertices|^2 for each cell, which couples them as
    // elasticity does not: what one rank does against it the others do once more.
    explicit SharedBox(bool is_mixed) {
        box.scramble(0.05, 1);
        box.elements->add_hessian(Workers(1), kernels<4>(Isa::Baseline), box.positions,
                                  target_in(A, 1, Filter::Clamp));
        for (std::int64_t row = 0; row < A.rows(); ++row) {
            A.add_to_diagonal(row, 0.1);
        }
        positions = at_dofs<4>(box.dofs, box.positions);
        for (std::uint32_t dof = 0; dof < A.rows(); ++dof) {
            owners.push_back(is_mixed ? dof % 3 : dof / 27);
        }
        if (is_mixed) {
            add_sums();
        }
    }

    void add_sums() {
        for (const auto cell : box.mesh.cells.colwise()) {
            for (const std::uint32_t v : cell) {
                for (const std::uint32_t w : cell) {
                    const std::uint32_t i = box.dofs.dof_of(v);
                    const std::uint32_t j = box.dofs.dof_of(w);
                    if (i <= j) {
                        A.add_to_block(box.pattern.find(i, j), Eigen::Matrix4d::Identity());
                    }
                }
            }
        }
    }
};

// So many vertices to an aggregate, then 2 and 3 of these.
std::vector<Aggregates> three_levels(std::uint32_t rows, std::uint32_t most) {
    std::vector<Aggregates> levels = {by_number(rows, most)};
    for (const std::uint32_t children : {2U, 3U}) {
        levels.push_back(by_number(static_cast<std::uint32_t>(levels.back().count()), children));
    }
    return levels;
}

// What a rank has of the box.
struct Part {
    CutMatrix cut;
    BlockVector<4> positions;  // of all columns
    Hierarchy hierarchy;

    Part(const SharedBox& of, std::uint32_t most, const std::shared_ptr<const Ranks>& ranks)
        : cut(of.A, of.owners, ranks),
          positions(4, of.positions.cols()),
          hierarchy(three_levels(static_cast<std::uint32_t>(cut.A->rows()), most),
                    cut.pattern,
                    nullptr,
                    {&cut.sharing, cut.exchange.get()},
                    cut.ghosts) {
        for (Eigen::Index column = 0; column < positions.cols(); ++column) {
            positions.col(column) = of.positions.col(cut.dofs[static_cast<std::size_t>(column)]);
        }
    }

    [[nodiscard]] std::unique_ptr<Preconditioner<4>> preconditioner(const Workers& workers) const {
        return multilevel(workers, blocks(), *cut.A, hierarchy, positions,
                          column_jacobi(workers, blocks(), *cut.A, cut.column_start));
    }
};

// What the ranks make of every unit vector, in the order of the whole.
Eigen::MatrixXd dense_of(const SharedBox& of, std::uint32_t most) {
    const Eigen::Index size = 4 * of.A.rows();
    Eigen::MatrixXd B(size, size);
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        const Part part(of, most, ranks);
        const auto preconditioner = part.preconditioner(Workers(1));
        for (Eigen::Index k = 0; k < size; ++k) {
            BlockVector<4> unit = BlockVector<4>::Zero(4, of.A.rows());
            unit.reshaped()[k] = 1;
            BlockVector<4> z(4, of.A.rows());
            preconditioner->apply(Workers(1), part.cut.part(unit), z);
            for (Eigen::Index row = 0; row < part.cut.A->rows(); ++row) {
                B.block<4, 1>(4 * part.cut.dofs[static_cast<std::size_t>(row)], k) = z.col(row);
            }
        }
    });
    return B;
}

void make_definite(Eigen::MatrixXd& A) {
    A.diagonal() *= 1 + 1e-10;
}

// All levels of all ranks as dense matrices: aggregates of rank 0, then those of rank 1 and so on.
struct DenseLevels {
    struct Level {
        Aggregates aggregates;
        std::vector<std::uint32_t> owners;  // of the aggregates
        std::vector<Eigen::Vector4d> middles;
        std::vector<double> sizes;
        Eigen::MatrixXd P;
        Eigen::MatrixXd A;
    };
    std::vector<Level> levels;

    DenseLevels(const SharedBox& of, std::uint32_t most) {
        std::vector<std::vector<Aggregates>> of_rank;
        for (std::uint32_t rank = 0; rank < 3; ++rank) {
            of_rank.push_back(three_levels(27, most));
        }
        // The dofs of each aggregate of the whole, level by level.
        Level before;
        before.owners = of.owners;
        before.A = ElasticBox<4>::dense(of.A);
        for (Eigen::Index dof = 0; dof < of.A.rows(); ++dof) {
            before.middles.emplace_back(of.positions.col(dof));
            before.sizes.push_back(0);
        }
        std::vector<double> counts(before.sizes.size(), 1);
        for (std::size_t l = 0; l < 3; ++l) {
            Level level = join(of_rank, l, before.owners);
            const std::vector<double> sums = place(level, before, counts);
            Arms<4> arms;
            for (std::size_t child = 0; child < before.sizes.size(); ++child) {
                const std::uint32_t a = level.aggregates.of_child()[child];
                arms.push_back({(before.middles[child] - level.middles[a]) / level.sizes[a],
                                before.sizes[child] / level.sizes[a]});
            }
            level.P = test::dense_modes(level.aggregates, arms, l == 0 ? 4 : kModeCount);
            level.A = level.P.transpose() * before.A * level.P;
            counts = sums;
            before = level;
            levels.push_back(std::move(level));
        }
    }

    // Children of each rank in their order are those of the whole in theirs.
    static Level join(const std::vector<std::vector<Aggregates>>& of_rank,
                      std::size_t l,
                      const std::vector<std::uint32_t>& owners) {
        Level level;
        std::vector<std::uint32_t> of_child(owners.size());
        for (std::uint32_t rank = 0; rank < of_rank.size(); ++rank) {
            const auto first = static_cast<std::uint32_t>(level.owners.size());
            const Aggregates& own = of_rank[rank][l];
            level.owners.resize(first + static_cast<std::size_t>(own.count()), rank);
            std::uint32_t place = 0;
            for (std::uint32_t child = 0; child < owners.size(); ++child) {
                if (owners[child] == rank) {
                    of_child[child] = first + own.of_child()[place++];
                }
            }
        }
        level.aggregates = {std::move(of_child), level.owners.size()};
        return level;
    }

    static std::vector<double> place(Level& level,
                                     const Level& children,
                                     const std::vector<double>& counts) {
        std::vector<double> sums;
        for (std::size_t a = 0; a < level.owners.size(); ++a) {
            const auto members = level.aggregates.members(a);
            double count = 0;
            Eigen::Vector4d middle = Eigen::Vector4d::Zero();
            for (const std::uint32_t child : members) {
                count += counts[child];
                middle += counts[child] * children.middles[child];
            }
            middle /= count;
            double spread = 0;
            for (const std::uint32_t child : members) {
                spread += counts[child] / count
                          * ((children.middles[child] - middle).squaredNorm()
                             + std::pow(children.sizes[child], 2));
            }
            sums.push_back(count);
            level.middles.push_back(middle);
            level.sizes.push_back(std::sqrt(spread));
        }
        return sums;
    }

    // What a rank sweeps with, L + (1 + t) D; with t = 0 unless it is damped.
    [[nodiscard]] Eigen::MatrixXd sweep(const Level& level, bool is_damped) const {
        constexpr Eigen::Index kSize = kModeCount;
        const auto count = static_cast<Eigen::Index>(level.owners.size());
        const auto root = [&](Eigen::Index i) {
            Eigen::MatrixXd D = level.A.block(kSize * i, kSize * i, kSize, kSize);
            make_definite(D);
            return Eigen::MatrixXd(D.llt().matrixL());
        };
        Eigen::MatrixXd M = Eigen::MatrixXd::Zero(level.A.rows(), level.A.cols());
        for (Eigen::Index i = 0; i < count; ++i) {
            double sum = 0;
            for (Eigen::Index j = 0; j < count; ++j) {
                const Eigen::MatrixXd block = level.A.block(kSize * i, kSize * j, kSize, kSize);
                if (level.owners[static_cast<std::size_t>(i)]
                    == level.owners[static_cast<std::size_t>(j)]) {
                    if (j <= i) {
                        M.block(kSize * i, kSize * j, kSize, kSize) = block;
                    }
                } else {
                    const Eigen::MatrixXd scaled =
                        root(i).inverse() * block * root(j).inverse().transpose();
                    sum +=
                        std::pow(scaled.jacobiSvd().singularValues().array().pow(8).sum(), 1.0 / 8);
                }
            }
            Eigen::MatrixXd D = level.A.block(kSize * i, kSize * i, kSize, kSize);
            make_definite(D);
            M.block(kSize * i, kSize * i, kSize, kSize) =
                D * (is_damped ? 1 + std::max(0.0, sum - 0.5) / 2 : 1);
        }
        return M;
    }

    // The W-cycle from a level downward.
    [[nodiscard]] Eigen::MatrixXd cycle(std::size_t l) const {
        const Level& level = levels[l];
        const auto identity = Eigen::MatrixXd::Identity(level.A.rows(), level.A.cols());
        if (l + 1 == levels.size()) {
            Eigen::MatrixXd A = level.A;
            make_definite(A);
            return A.llt().solve(identity);
        }
        const Level& next = levels[l + 1];
        Eigen::MatrixXd coarse = cycle(l + 1);
        if (l + 2 < levels.size()) {
            coarse = (2 * coarse - coarse * next.A * coarse).eval();
        }
        const Eigen::MatrixXd forth = sweep(level, true).inverse();
        Eigen::MatrixXd C = forth;
        C += 1.8 * next.P * coarse * next.P.transpose() * (identity - level.A * C).eval();
        C += forth.transpose() * (identity - level.A * C).eval();
        return C;
    }
};

TEST(SharedMultilevel, IsTheDenseMatrixOfItsDefinition) {
    for (const bool is_mixed : {false, true}) {
        const SharedBox of(is_mixed);
        const DenseLevels dense(of, 7);
        Eigen::MatrixXd expected =
            dense.levels[0].P * dense.cycle(0) * dense.levels[0].P.transpose();
        for (std::int64_t row = 0; row < of.A.rows(); ++row) {
            expected.block<4, 4>(4 * row, 4 * row) += of.A.diagonal(row).inverse();
        }
        // The inverses of the smoother are floats.
        EXPECT_LT((dense_of(of, 7) - expected).norm(), 1e-6 * expected.norm());
    }
}

// Aggregates of 1 to 3 vertices have modes that are zero or say the same twice.
TEST(SharedMultilevel, IsSymmetricAndPositiveDefiniteHoweverRanksAreMixed) {
    for (const bool is_mixed : {false, true}) {
        const SharedBox of(is_mixed);
        for (const std::uint32_t most : {1U, 3U, 5U}) {
            const Eigen::MatrixXd B = dense_of(of, most);
            // Dependent modes are separated at 1e-10 of their diagonal, which rounding meets there.
            EXPECT_LT((B - B.transpose()).norm(), 1e-6 * B.norm()) << most;
            EXPECT_EQ(Eigen::MatrixXd(0.5 * (B + B.transpose())).llt().info(), Eigen::Success)
                << most;
        }
    }
}

TEST(SharedMultilevel, IsOnOneRankToTheBitWhatItIsAlone) {
    const SharedBox of(false);
    const Workers workers(2);
    const auto rows = static_cast<std::uint32_t>(of.A.rows());
    const Hierarchy alone(three_levels(rows, 3), of.A.pattern());
    const BlockVector<4> r = BlockVector<4>::Random(4, rows);
    BlockVector<4> expected(4, rows);
    std::vector<std::uint32_t> columns(rows + 1);
    std::iota(columns.begin(), columns.end(), 0U);
    const double product = multilevel(workers, blocks(), of.A, alone, of.positions,
                                      column_jacobi(workers, blocks(), of.A, columns))
                               ->apply(workers, r, expected);
    test::on_ranks(1, [&](const std::shared_ptr<const Ranks>& ranks) {
        SharedBox own(false);
        own.owners.assign(rows, 0);
        const Part part(own, 3, ranks);
        BlockVector<4> z(4, rows);
        EXPECT_EQ(part.preconditioner(workers)->apply(workers, r, z), product);
        EXPECT_EQ(z, expected);
    });
}

TEST(SharedMultilevel, GivesTheSameBitsForAnyNumberOfThreads) {
    const SharedBox of(true);
    const BlockVector<4> r = BlockVector<4>::Random(4, of.A.rows());
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        const Part part(of, 3, ranks);
        const auto apply = [&](int threads) {
            const Workers workers(threads);
            BlockVector<4> z = BlockVector<4>::Zero(4, of.A.rows());
            part.preconditioner(workers)->apply(workers, part.cut.part(r), z);
            return z;
        };
        EXPECT_EQ(apply(1), apply(3));
    });
}

// There and back again, each rank over its own: B with 0 < B A <= 1. Without damping errors do grow
// where ranks are mixed.
TEST(SharedGaussSeidel, MakesNoErrorGrow) {
    const SharedBox of(true);
    const DenseLevels dense(of, 7);
    const DenseLevels::Level& level = dense.levels[0];
    const auto smallest = [&](const Eigen::MatrixXd& M) {
        const Eigen::MatrixXd less = M + M.transpose() - level.A;
        return less.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
    };
    EXPECT_LT(smallest(dense.sweep(level, false)), 0);
    EXPECT_GT(smallest(dense.sweep(level, true)), 0);
    Eigen::MatrixXd B(level.A.rows(), level.A.cols());
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        const Part part(of, 7, ranks);
        const HierarchyLevel& made = part.hierarchy.levels[0];
        const ChildPlaces<4> vertices(part.positions);
        const AggregatePlaces<4> places = places_of(Workers(1), made.aggregates, vertices);
        auto A = galerkin_product(
            Workers(1), blocks(), *part.cut.A, made.aggregates,
            arms_of(Workers(1), made.aggregates, vertices, places, part.cut.exchange.get()),
            made.pattern);
        A.ghosts = made.exchange.get();
        const GaussSeidel<4, double> smoother(Workers(1), A);
        AggregateMatrix<4, double>::Shares shares;
        A.fit(shares);
        const Eigen::Index rows = kModeCount * A.pattern->rows();  // as many on every rank
        const Eigen::Index first = rows * ranks->rank();
        for (Eigen::Index k = 0; k < B.cols(); ++k) {
            const Eigen::VectorXd unit = Eigen::VectorXd::Unit(B.rows(), k).segment(first, rows);
            Eigen::VectorXd z;
            Eigen::VectorXd left;
            smoother.sweep_forth(Workers(1), blocks(), unit, z, left, shares);
            smoother.sweep_back(Workers(1), blocks(), unit, z, shares);
            B.col(k).segment(first, rows) = z.head(rows);
        }
    });
    EXPECT_LT((B - B.transpose()).norm(), 1e-8 * B.norm());
    const Eigen::VectorXd spectrum = (B * level.A).eval().eigenvalues().real();
    EXPECT_GT(spectrum.minCoeff(), 0);
    EXPECT_LT(spectrum.maxCoeff(), 1 + 1e-8);
}

}  // namespace
}  // namespace pent::simulator
