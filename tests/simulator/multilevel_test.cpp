#include "aggregate_levels.h"
#include "preconditioner_cases.h"

#include <Eigen/Cholesky>

#include <cmath>

namespace pent::simulator {
namespace {

using test::by_number;
using test::iterations;
using Fixture = test::ScrambledBox;

// A few vertices to an aggregate and three levels, whatever the size.
Hierarchy three_levels(const Fixture& f, std::uint32_t most) {
    std::vector<Aggregates> levels = {by_number(static_cast<std::uint32_t>(f.A.rows()), most)};
    for (const std::uint32_t children : {2U, 3U}) {
        levels.push_back(by_number(static_cast<std::uint32_t>(levels.back().count()), children));
    }
    return {levels, f.A.pattern()};
}

BlockVector<4> positions_of(const Fixture& f) {
    return at_dofs<4>(f.box.dofs, f.box.positions);
}

std::unique_ptr<Preconditioner<4>> multilevel_of(const Fixture& f,
                                                 const Hierarchy& hierarchy,
                                                 const BlockVector<4>& positions,
                                                 const Workers& workers) {
    const BlockKernels& blocks = kernels<4>(Isa::Baseline).blocks;
    return multilevel(workers, blocks, f.A, hierarchy, positions,
                      column_jacobi(workers, blocks, f.A, f.box.dofs.column_start()));
}

Eigen::MatrixXd dense_of(const Fixture& f, const Preconditioner<4>& preconditioner) {
    const Eigen::Index size = 4 * f.A.rows();
    Eigen::MatrixXd B(size, size);
    for (Eigen::Index k = 0; k < size; ++k) {
        BlockVector<4> unit = BlockVector<4>::Zero(4, f.A.rows());
        unit.reshaped()[k] = 1;
        BlockVector<4> z(4, f.A.rows());
        preconditioner.apply(f.workers, unit, z);
        B.col(k) = z.reshaped();
    }
    return B;
}

// Aggregates of 1 to 3 vertices have modes that are zero or say the same twice.
TEST(Multilevel, IsSymmetricAndPositiveDefiniteHoweverSmallAggregatesAre) {
    const Fixture f;
    for (const std::uint32_t most : {1U, 2U, 3U, 5U}) {
        const Hierarchy hierarchy = three_levels(f, most);
        const auto preconditioner = multilevel_of(f, hierarchy, positions_of(f), f.workers);
        const Eigen::MatrixXd B = dense_of(f, *preconditioner);
        // Dependent modes are separated at 1e-10 of their diagonal, which rounding meets there.
        EXPECT_LT((B - B.transpose()).norm(), 1e-6 * B.norm()) << most;
        const Eigen::MatrixXd symmetric = 0.5 * (B + B.transpose());
        EXPECT_EQ(symmetric.llt().info(), Eigen::Success) << most;
    }
}

// In a plane, on a line, in a point: rotations that do nothing, to every aggregate.
TEST(Multilevel, IsFiniteWhereVerticesLieInAPlaneOrOnALine) {
    const Fixture f;
    for (const int dimensions : {2, 1, 0}) {
        BlockVector<4> flat = positions_of(f);
        flat.bottomRows(4 - dimensions).setZero();
        const Hierarchy hierarchy = three_levels(f, 5);
        const auto preconditioner = multilevel_of(f, hierarchy, flat, f.workers);
        BlockVector<4> z(4, f.A.rows());
        preconditioner->apply(f.workers, f.r, z);
        EXPECT_TRUE(z.allFinite());
        EXPECT_GT(z.cwiseProduct(f.r).sum(), 0);
        EXPECT_LT(z.norm(), 1e3 * f.r.norm());  // the smallest eigenvalue of A is above 0.1
    }
}

// B A m = m for any rigid motion m of the coarsest aggregates: bodies that only move rigidly are
// solved for at once.
TEST(Multilevel, CorrectsRigidMotionsOfTheCoarsestAggregatesExactly) {
    const Fixture f;
    const Hierarchy hierarchy = three_levels(f, 5);
    const BlockVector<4> positions = positions_of(f);
    const auto preconditioner = multilevel_of(f, hierarchy, positions, f.workers);
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    BlockVector<4> motion(4, f.A.rows());
    const auto normal_matrix = [&] {
        return Eigen::Matrix4d(Eigen::Matrix4d::NullaryExpr([&] { return normal(random); }));
    };
    std::vector<Eigen::Matrix4d> spins;
    std::vector<Eigen::Vector4d> shifts;
    for (int a = 0; a < hierarchy.levels.back().aggregates.count(); ++a) {
        const Eigen::Matrix4d any = normal_matrix();
        spins.emplace_back(any - any.transpose());  // rotations in all six planes
        shifts.emplace_back(any.col(0));
    }
    for (std::uint32_t dof = 0; dof < f.A.rows(); ++dof) {
        std::uint32_t a = dof;
        for (const HierarchyLevel& level : hierarchy.levels) {
            a = level.aggregates.of_child()[a];
        }
        motion.col(dof) = spins[a] * positions.col(dof) + shifts[a];
    }
    BlockVector<4> image(4, f.A.rows());
    BlockVector<4> back = BlockVector<4>::Zero(4, f.A.rows());
    f.A.multiply(f.workers, kernels<4>(Isa::Baseline).blocks, motion, image);
    EXPECT_TRUE(preconditioner->correct(f.workers, image, back));
    EXPECT_LT((back - motion).norm(), 1e-7 * motion.norm());  // 1e-10 is added to the diagonal
}

TEST(Multilevel, ReturnsWhatItIsGivenTimesWhatItMakesOfIt) {
    const Fixture f;
    for (const std::uint32_t most : {1U, 2U, 5U}) {
        const Hierarchy hierarchy = three_levels(f, most);
        BlockVector<4> z(4, f.A.rows());
        const double product =
            multilevel_of(f, hierarchy, positions_of(f), f.workers)->apply(f.workers, f.r, z);
        EXPECT_NEAR(product, f.r.cwiseProduct(z).sum(), 1e-12 * f.r.norm() * z.norm());
    }
}

// Forces of any size, though levels below the first are in float: a power of two changes no bit.
TEST(Multilevel, IsAsExactHoweverSmallForcesAreAndGivesZeroForZero) {
    const Fixture f;
    BlockMatrix<4, float> A(f.A.pattern());
    A.add_scaled(f.workers, 1, f.A);
    const Hierarchy hierarchy = three_levels(f, 3);
    const BlockKernels& blocks = kernels<4>(Isa::Baseline).blocks;
    const auto preconditioner =
        multilevel(f.workers, blocks, A, hierarchy, positions_of(f),
                   column_jacobi(f.workers, blocks, A, f.box.dofs.column_start()));
    BlockVector<4> expected(4, A.rows());
    const double product = preconditioner->apply(f.workers, f.r, expected);
    for (const int power : {-300, -130, -10, 10, 130, 300}) {
        const double factor = std::ldexp(1.0, power);
        BlockVector<4> z(4, A.rows());
        EXPECT_EQ(preconditioner->apply(f.workers, factor * f.r, z), factor * factor * product);
        EXPECT_EQ(z, factor * expected) << power;
    }
    BlockVector<4> z(4, A.rows());
    EXPECT_EQ(preconditioner->apply(f.workers, 0 * f.r, z), 0);
    EXPECT_TRUE(z.isZero(0));
}

TEST(Multilevel, GivesTheSameBitsForAnyNumberOfThreads) {
    const Fixture f;
    const Hierarchy hierarchy = three_levels(f, 3);
    BlockVector<4> expected(4, f.A.rows());
    const double product =
        multilevel_of(f, hierarchy, positions_of(f), f.workers)->apply(f.workers, f.r, expected);
    for (const int threads : {2, 3}) {
        const Workers workers(threads);
        BlockVector<4> z(4, f.A.rows());
        EXPECT_EQ(multilevel_of(f, hierarchy, positions_of(f), workers)->apply(workers, f.r, z),
                  product);
        EXPECT_EQ(z, expected);
    }
}

TEST(Multilevel, KeepsIterationsFlatWithin30PercentOverTheAspectOfLayers) {
    const int cubes = iterations(PreconditionerKind::RigidModes, {});
    EXPECT_LE(iterations(PreconditionerKind::RigidModes, {.thickness = 0.08}), 1.3 * cubes);
    EXPECT_LE(iterations(PreconditionerKind::RigidModes, {.thickness = 0.04}), 1.3 * cubes);
    EXPECT_LT(cubes, iterations(PreconditionerKind::BlockJacobi, {}) / 2);
}

// Without columns and with crooked cells: a mesh like any other.
TEST(Multilevel, TakesAtMostTwiceTheIterationsOfASoftBodyHoweverStiffItIs) {
    const auto of = [](PreconditionerKind kind, double young) {
        return iterations(kind, {.young = young, .has_columns = false, .unrest = 0.01});
    };
    const int soft = of(PreconditionerKind::RigidModes, 1e5);
    for (const double young : {1e6, 1e7, 1e8, 1e9}) {
        EXPECT_LE(of(PreconditionerKind::RigidModes, young), 2 * soft) << young;
    }
    EXPECT_GT(of(PreconditionerKind::BlockJacobi, 1e8), 6 * soft);
}

}  // namespace
}  // namespace pent::simulator
