#include "linear/newton_system.h"

#include "springy_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

// A box at rest that is nowhere held, and what its elements alone make of it.
template <typename Scalar>
struct WeighedBox {
    ElasticBox<kDim> box{{.lame = {.lambda = 2, .mu = 1}}};
    Workers workers{1};
    BlockMatrix<kDim, Scalar> stiffness{box.pattern};
    NewtonSystem<kDim> system{workers, box.dofs, box.pattern,
                              sizeof(Scalar) == 4 ? Precision::Float : Precision::Double};

    WeighedBox() { add_elements(stiffness); }

    void add_elements(BlockMatrix<kDim, Scalar>& matrix) const {
        box.elements->add_hessian(workers, kernels<kDim>(best_isa()), box.positions,
                                  target_in(matrix, 1, Filter::Clamp));
    }

    // With these masses; up to what comes before finish().
    void weigh(const Eigen::VectorXd& masses) {
        system.begin(BlockVector<kDim>::Zero(kDim, box.pattern.rows()), 0 * box.positions);
        add_elements(std::get<BlockMatrix<kDim, Scalar>>(system.matrix()));
        system.add_masses(1, masses);
        system.weigh_masses();
    }

    // One that is so many times what rounding takes of the diagonal at its vertex, where others are
    // heavy; by how much of a mass rounding may be.
    [[nodiscard]] Eigen::VectorXd one_light(double times, double may_be, double rounding) const {
        constexpr std::uint32_t kLight = 5;
        const double diagonal =
            static_cast<double>(stiffness.diagonal(box.dofs.dof_of(kLight)).trace()) / kDim;
        Eigen::VectorXd masses = Eigen::VectorXd::Constant(box.mesh.vertex_count(), diagonal);
        masses[kLight] = times * diagonal * rounding / may_be;
        return masses;
    }
};

constexpr double kFloatRounding = static_cast<double>(std::numeric_limits<float>::epsilon());
constexpr double kDoubleRounding = std::numeric_limits<double>::epsilon();

// As weigh_masses() says: the rounding of its diagonal may be 4e-3 of a mass in floats, 1e-2 in
// doubles. A hundredth on either side is more than what the mass adds to the diagonal.
TEST(NewtonSystem, LosesTheMassOfAVertexWhereItIsLittleBesideTheRoundingThere) {
    for (const bool is_lost : {false, true}) {
        const double times = is_lost ? 0.99 : 1.01;
        WeighedBox<float> in_float;
        in_float.weigh(in_float.one_light(times, 4e-3, kFloatRounding));
        EXPECT_EQ(in_float.system.has_lost_inertia(), is_lost);
        WeighedBox<double> in_double;
        in_double.weigh(in_double.one_light(times, 4e-3, kFloatRounding));
        EXPECT_EQ(in_double.system.needs_double(), is_lost);
        EXPECT_FALSE(in_double.system.has_lost_inertia());
        in_double.weigh(in_double.one_light(times, 1e-2, kDoubleRounding));
        EXPECT_EQ(in_double.system.has_lost_inertia(), is_lost);
    }
}

TEST(NewtonSystem, HasNoMassToLoseWhereThereIsNone) {
    WeighedBox<float> in_float;
    in_float.weigh(in_float.one_light(0, 1, 1));
    EXPECT_FALSE(in_float.system.has_lost_inertia());
    WeighedBox<double> in_double;
    in_double.weigh(Eigen::VectorXd::Zero(in_double.box.mesh.vertex_count()));
    EXPECT_FALSE(in_double.system.needs_double());
    EXPECT_FALSE(in_double.system.has_lost_inertia());
}

// Each mass alone, by the first diagonal entry of the spring: 12, and 48 at its other end, whose
// mass holds.
TEST(NewtonSystem, LosesMassesBesideSpringsThatAreToBeChecked) {
    const std::array<std::uint32_t, 2> ends = {2, 9};
    const std::array<double, 2> weights = {2, -4};
    const Eigen::Matrix4d K = Eigen::Vector4d(1, 0, 0, 0).asDiagonal();
    WeighedBox<double> problem;
    const auto weigh = [&](double mass, bool is_checked) {
        problem.system.begin(BlockVector<kDim>::Zero(kDim, problem.box.pattern.rows()),
                             0 * problem.box.positions);
        Eigen::VectorXd masses = Eigen::VectorXd::Constant(problem.box.mesh.vertex_count(), 1e30);
        masses[ends[0]] = mass;
        problem.system.add_masses(1, masses);
        problem.system.add_stencil({.vertices = ends.data(),
                                    .weights = weights.data(),
                                    .numbers = K.data(),
                                    .count = 2,
                                    .stride = kDim,
                                    .scale = 3,
                                    .is_checked = is_checked});
        problem.system.weigh_masses();
    };
    for (const bool is_lost : {false, true}) {
        const double times = is_lost ? 0.99 : 1.01;
        weigh(times * 12 * kFloatRounding / 2e-3, true);  // nothing makes up for it in floats
        EXPECT_EQ(problem.system.needs_double(), is_lost);
        EXPECT_FALSE(problem.system.has_lost_inertia());
        weigh(times * 12 * kDoubleRounding / 1e-2, true);
        EXPECT_EQ(problem.system.has_lost_inertia(), is_lost);
        weigh(times * 12 * kDoubleRounding / 1e-2, false);
        EXPECT_FALSE(problem.system.has_lost_inertia());
        EXPECT_FALSE(problem.system.needs_double());
    }
    weigh(0, true);
    EXPECT_FALSE(problem.system.has_lost_inertia());
}

// What is made up for is in no block: a product shows it.
template <typename Scalar>
bool is_made_up_for(const Eigen::VectorXd& masses) {
    WeighedBox<Scalar> problem;
    problem.weigh(masses);
    problem.system.finish();
    for (std::uint32_t dof = 0; dof < problem.box.dofs.count(); ++dof) {
        problem.stiffness.add_to_diagonal(
            dof, static_cast<Scalar>(masses[problem.box.dofs.vertex_of(dof)]));
    }
    const auto times_ones = [&](const BlockMatrix<kDim, Scalar>& matrix) {
        BlockVector<kDim> result(kDim, matrix.rows());
        matrix.multiply(problem.workers, kernels<kDim>(best_isa()).blocks,
                        BlockVector<kDim>::Ones(kDim, matrix.rows()), result);
        return result;
    };
    return times_ones(std::get<BlockMatrix<kDim, Scalar>>(problem.system.matrix()))
           != times_ones(problem.stiffness);
}

// Floats alone, where their rounding is more than 2e-3 of a mass.
TEST(NewtonSystem, MakesUpForRoundingWhereAMassShowsIt) {
    const WeighedBox<float> box;
    EXPECT_FALSE(is_made_up_for<float>(box.one_light(1.01, 2e-3, kFloatRounding)));
    EXPECT_TRUE(is_made_up_for<float>(box.one_light(0.99, 2e-3, kFloatRounding)));
    EXPECT_FALSE(is_made_up_for<double>(box.one_light(0.99, 2e-3, kFloatRounding)));
    EXPECT_FALSE(is_made_up_for<float>(box.one_light(0, 1, 1)));
}

TEST(NewtonSystem, BeginsWithNothingOfWhatWasThere) {
    for (const Precision precision : {Precision::Float, Precision::Double}) {
        SpringyBox problem(precision, 1e-19);
        EXPECT_TRUE(problem.system.has_lost_inertia());
        const Eigen::Index rows = problem.box.pattern.rows();
        problem.system.begin(problem.b, 0 * problem.displacement);
        EXPECT_FALSE(problem.system.has_lost_inertia());
        EXPECT_FALSE(problem.system.needs_double());
        EXPECT_FALSE(problem.system.has_stencils());
        std::visit(
            [&](const auto& matrix) {
                BlockVector<kDim> product(kDim, rows);
                matrix.multiply(problem.workers, kernels<kDim>(best_isa()).blocks, problem.b,
                                product);
                EXPECT_TRUE(product.isZero(0));
            },
            problem.system.matrix());
    }
}

}  // namespace
}  // namespace pent::simulator
