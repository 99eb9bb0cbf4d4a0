#include "linear/preconditioner.h"

#include "elastic_box.h"
#include "model/rotation.h"
#include "scenes.h"

#include <pent/simulator/simulation.h>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <random>

namespace pent::simulator {
namespace {

using test::ElasticBox;

// Gives zero, to look at the coarse space alone.
class Nothing final : public Preconditioner<4> {
public:
    void apply(const Workers& /*workers*/,
               const BlockVector<4>& r,
               BlockVector<4>& z) const override {
        z = BlockVector<4>::Zero(4, r.cols());
    }
};

struct Fixture {
    ElasticBox<4> box{{.lame = {.lambda = 2, .mu = 1}}};
    BlockMatrix<4, double> A{box.pattern};
    Workers workers{1};
    BlockVector<4> r;

    Fixture() {
        box.scramble(0.05, 1);
        box.elements->add_hessian(workers, kernels<4>(Isa::Baseline), box.positions,
                                  target_in(A, 1, Filter::Clamp));
        for (std::int64_t row = 0; row < A.rows(); ++row) {
            A.diagonal(row).diagonal().array() += 0.1;
        }
        std::mt19937 random(2);
        std::normal_distribution<double> normal;
        r = BlockVector<4>::NullaryExpr(4, A.rows(), [&]() { return normal(random); });
    }
};

// Columns of neighboring unknowns: the preconditioner must solve with the dense matrix of each.
TEST(ColumnJacobi, SolvesWithTheBandOfBlocksOfEveryColumn) {
    const Fixture f;
    const auto n = static_cast<std::uint32_t>(f.A.rows());
    const std::vector<std::uint32_t> columns = {0, 1, 4, 9, 10, n};
    const auto preconditioner = column_jacobi(f.workers, f.A, columns);
    BlockVector<4> z(4, f.A.rows());
    preconditioner->apply(f.workers, f.r, z);
    Eigen::MatrixXd part = ElasticBox<4>::dense(f.A);
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const auto column_of = [&](std::uint32_t k) {
                return std::upper_bound(columns.begin(), columns.end(), k) - columns.begin();
            };
            if (column_of(i) != column_of(j) || i > j + 2 || j > i + 2) {
                part.block<4, 4>(4 * i, 4 * j).setZero();
            }
        }
    }
    ASSERT_EQ(part.llt().info(), Eigen::Success);
    const Eigen::VectorXd expected = part.llt().solve(f.r.reshaped());
    // Factors are kept in float.
    EXPECT_LT((z.reshaped() - expected).norm(), 1e-5 * expected.norm());
}

// The columns of an extruded box couple only layers that are neighbors, or, with quadratic
// elements, two apart: nothing is left out, and the preconditioner solves a single column exactly.
TEST(ColumnJacobi, LeavesNothingOfAColumnOutForAnyElements) {
    for (const ElementKind kind :
         {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic}) {
        SimplexMesh<4> mesh = pent::test::quadratic_kuhn_box<4>({1, 1, 1, 3}, {1, 1, 1, 0.1});
        std::vector<bool> is_held(static_cast<std::size_t>(mesh.vertex_count()), false);
        Columns columns;
        for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
            columns.columns.push_back(v % 27);
            columns.layers.push_back(v / 27);
            is_held[v] = v % 27 != 13;  // all but one column
        }
        mesh.columns = columns.columns;
        mesh.layers = columns.layers;
        ElasticBox<4> box(mesh, {.lame = {.lambda = 2, .mu = 1}}, kind, is_held);
        ASSERT_EQ(box.dofs.count(), 7);
        BlockMatrix<4, double> A(box.pattern);
        box.elements->add_hessian(Workers(1), kernels<4>(Isa::Baseline), box.positions,
                                  target_in(A, 1, Filter::Clamp));
        const BlockVector<4> r = BlockVector<4>::Random(4, 7);
        BlockVector<4> z(4, 7);
        column_jacobi(Workers(1), A, {0, 7})->apply(Workers(1), r, z);
        const Eigen::VectorXd expected = ElasticBox<4>::dense(A).llt().solve(r.reshaped());
        EXPECT_LT((z.reshaped() - expected).norm(), 1e-5 * expected.norm());  // kept in float
    }
}

TEST(ColumnJacobi, IsTheInverseOfTheDiagonalForSingleVertices) {
    const Fixture f;
    std::vector<std::uint32_t> columns(static_cast<std::size_t>(f.A.rows()) + 1);
    std::iota(columns.begin(), columns.end(), 0U);
    BlockVector<4> z(4, f.A.rows());
    column_jacobi(f.workers, f.A, columns)->apply(f.workers, f.r, z);
    for (std::int64_t row = 0; row < f.A.rows(); ++row) {
        const Eigen::Vector4d back = f.A.diagonal(row) * z.col(row);
        EXPECT_LT((back - f.r.col(row)).norm(), 1e-5 * f.r.col(row).norm());
    }
}

// The coarse space is exact on what it holds: B A m = m for any rigid motion m of the aggregates,
// and symmetric: a . B b = b . B a.
TEST(RigidModes, SolveExactlyForRigidMotionsOfEveryAggregate) {
    const Fixture f;
    Aggregates aggregates;
    aggregates.members.resize(2);
    for (std::uint32_t unknown = 0; unknown < f.A.rows(); ++unknown) {
        const std::uint32_t piece =
            f.box.mesh.positions(0, f.box.dofs.vertex_of(unknown)) > 0.6 ? 1 : 0;
        aggregates.of_unknown.push_back(piece);
        aggregates.members[piece].push_back(unknown);
    }
    BlockVector<4> positions(4, f.A.rows());
    for (std::uint32_t unknown = 0; unknown < f.A.rows(); ++unknown) {
        positions.col(unknown) = f.box.positions.col(f.box.dofs.vertex_of(unknown));
    }
    const auto coarse =
        with_rigid_modes(f.workers, f.A, aggregates, positions,
                         std::unique_ptr<Preconditioner<4>>(std::make_unique<Nothing>()));
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    BlockVector<4> motion(4, f.A.rows());
    for (const std::vector<std::uint32_t>& members : aggregates.members) {
        const Eigen::Matrix4d any = Eigen::Matrix4d::NullaryExpr([&]() { return normal(random); });
        const Eigen::Matrix4d spin = any - any.transpose();  // rotations in all six planes
        const Eigen::Vector4d shift =
            Eigen::Vector4d::NullaryExpr([&]() { return normal(random); });
        for (const std::uint32_t unknown : members) {
            motion.col(unknown) = spin * positions.col(unknown) + shift;
        }
    }
    BlockVector<4> image(4, f.A.rows());
    BlockVector<4> back(4, f.A.rows());
    f.A.multiply(f.workers, kernels<4>(Isa::Baseline).blocks, motion, image);
    coarse->apply(f.workers, image, back);
    EXPECT_LT((back - motion).norm(), 1e-7 * motion.norm());  // 1e-10 is added to the diagonal

    BlockVector<4> Br(4, f.A.rows());
    coarse->apply(f.workers, f.r, Br);
    EXPECT_NEAR(image.cwiseProduct(Br).sum(), back.cwiseProduct(f.r).sum(), 1e-9 * image.norm());
}

TEST(MakeAggregates, PartitionsTheUnknownsOfEachBodyIntoPiecesOfBoundedSize) {
    const SimplexMesh<4> mesh = pent::test::kuhn_box<4>({20, 4, 4, 4}, {20, 4, 4, 4});
    std::vector<std::uint32_t> bodies(static_cast<std::size_t>(mesh.vertex_count()), 0);
    std::fill(bodies.begin() + 1000, bodies.end(), 1U);
    const Aggregates aggregates = make_aggregates<4>(mesh.positions, bodies);
    std::size_t total = 0;
    for (std::uint32_t piece = 0; piece < aggregates.members.size(); ++piece) {
        const auto& members = aggregates.members[piece];
        total += members.size();
        EXPECT_LE(members.size(), 550U);
        for (const std::uint32_t unknown : members) {
            EXPECT_EQ(aggregates.of_unknown[unknown], piece);
            EXPECT_EQ(bodies[unknown], bodies[members[0]]);
        }
    }
    EXPECT_EQ(total, bodies.size());
}

// One linear step of a stiff bar; cells as thick along w as along x, or a tenth of that.
int iterations(PreconditionerKind kind, double thickness) {
    Scene scene = test::box_scene<4>();
    scene.bodies[0].material.lame = lame_from_young(4, 1e7, 0.28);
    scene.gravity[1] = -9.8;
    scene.constraints = {test::hold(
        HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6}, test::still(4))};
    scene.solver.preconditioner = kind;
    scene.solver.tolerance = 1e-3;
    SimplexMesh<4> mesh = pent::test::kuhn_box<4>({16, 4, 4, 4}, {1.6, 0.4, 0.4, thickness});
    const std::uint32_t base = 17 * 5 * 5;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        mesh.columns.push_back(v % base);
        mesh.layers.push_back(v / base);
    }
    Simulation<4> simulation(scene, {mesh});
    const StepReport report = simulation.step();
    EXPECT_TRUE(report.is_accepted);
    return report.iterations;
}

TEST(RigidModes, KeepIterationsFlatWithin30PercentOverTheAspectOfLayers) {
    const int cubes = iterations(PreconditionerKind::RigidModes, 0.4);
    EXPECT_LE(iterations(PreconditionerKind::RigidModes, 0.08), 1.3 * cubes);
    EXPECT_LE(iterations(PreconditionerKind::RigidModes, 0.04), 1.3 * cubes);
    EXPECT_LT(cubes, iterations(PreconditionerKind::BlockJacobi, 0.4) / 2);
}

TEST(ColumnJacobi, TakesThinLayersBetterThanBlockJacobi) {
    EXPECT_LT(iterations(PreconditionerKind::ColumnJacobi, 0.04),
              iterations(PreconditionerKind::BlockJacobi, 0.04) / 2);
}

}  // namespace
}  // namespace pent::simulator
