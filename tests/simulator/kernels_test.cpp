#include "kernels.h"

#include "elastic_box.h"

#include <pent/simulator/energy.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using Eigen::MatrixXd;
using test::ElasticBox;
using test::supported_isas;

constexpr std::array kAllModels = {Model::StableNeoHookean, Model::Arap, Model::StVenantKirchhoff,
                                   Model::Linear};

Material soft(Model model) {
    return {.model = model, .lame = {.lambda = 1.3, .mu = 0.7}};
}

// Energy, forces and stiffness element by element from energy.h: slow and plain.
template <int Dim>
struct Reference {
    double energy = 0;
    Positions<Dim> forces;
    MatrixXd stiffness;

    Reference(const ElasticBox<Dim>& box, const Material& material, Filter filter) {
        const SimplexMesh<Dim>& mesh = box.mesh;
        const auto unknowns = static_cast<Eigen::Index>(box.numbering.free_count());
        forces.setZero(Dim, mesh.vertex_count());
        stiffness.setZero(Dim * unknowns, Dim * unknowns);
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            MatrixXd Dm(Dim, Dim);
            MatrixXd Ds(Dim, Dim);
            for (int a = 0; a < Dim; ++a) {
                const auto corner = mesh.cells(a + 1, cell);
                const auto origin = mesh.cells(0, cell);
                Dm.col(a) = mesh.positions.col(corner) - mesh.positions.col(origin);
                Ds.col(a) = box.positions.col(corner) - box.positions.col(origin);
            }
            MatrixXd gradients(Dim + 1, Dim);  // row a: rest gradient of corner a
            gradients.bottomRows(Dim) = Dm.inverse();
            gradients.row(0) = -gradients.bottomRows(Dim).colwise().sum();
            const MatrixXd F = Ds * gradients.bottomRows(Dim);
            const double volume = cell_volume<Dim>(mesh.positions, mesh.cells, cell);
            energy += volume * energy_density(material, F);
            const MatrixXd P = stress(material, F);
            const HessianFrame H = filtered(hessian(material, F), filter);
            for (int a = 0; a <= Dim; ++a) {
                const auto vertex_a = mesh.cells(a, cell);
                forces.col(vertex_a) -= volume * P * gradients.row(a).transpose();
                for (int b = 0; b <= Dim; ++b) {
                    add_block(box, H, gradients, volume, vertex_a, mesh.cells(b, cell), a, b);
                }
            }
        }
    }

    void add_block(const ElasticBox<Dim>& box,
                   const HessianFrame& H,
                   const MatrixXd& gradients,
                   double volume,
                   std::uint32_t vertex_a,
                   std::uint32_t vertex_b,
                   int a,
                   int b) {
        if (!box.numbering.is_free(vertex_a) || !box.numbering.is_free(vertex_b)) {
            return;
        }
        const Eigen::Index row = Dim * box.numbering.unknown_of_vertex[vertex_a];
        const Eigen::Index column = Dim * box.numbering.unknown_of_vertex[vertex_b];
        for (int j = 0; j < Dim; ++j) {
            const MatrixXd dF = MatrixXd::Identity(Dim, Dim).col(j) * gradients.row(b);
            stiffness.block(row, column + j, Dim, 1) +=
                volume * apply(H, dF) * gradients.row(a).transpose();
        }
    }
};

template <int Dim>
void expect_kernels_match_reference(const Material& material, double scramble) {
    const std::vector<std::uint32_t> held = {0, 3};
    ElasticBox<Dim> box(material, held);
    box.scramble(scramble, 7);
    for (const Filter filter : {Filter::Clamp, Filter::Absolute, Filter::None}) {
        const Reference<Dim> reference(box, material, filter);
        const double stiff = reference.stiffness.norm();
        for (const Isa isa : supported_isas()) {
            Positions<Dim> forces;
            const RunEnergy run = box.forces(isa, box.positions, forces);
            // Double kernels agree to rounding, amplified where singular values nearly coincide.
            EXPECT_NEAR(run.energy, reference.energy, 1e-12 * (1 + reference.energy));
            EXPECT_LT((forces - reference.forces).norm(), 1e-11 * (1 + reference.forces.norm()));
            const MatrixXd K = box.template stiffness<double>(isa, filter);
            EXPECT_LT((K - reference.stiffness).norm(), 1e-9 * stiff) << isa_name(isa);
            // Float: 24 bits, some tens of operations; arap amplifies by 1 / (sigma_i + sigma_j).
            const MatrixXd Kf = box.template stiffness<float>(isa, filter);
            EXPECT_LT((Kf - reference.stiffness).norm(), 2e-4 * stiff) << isa_name(isa);
        }
    }
}

class KernelModels : public testing::TestWithParam<Model> {};
INSTANTIATE_TEST_SUITE_P(All, KernelModels, testing::ValuesIn(kAllModels));

TEST_P(KernelModels, MatchTheReferenceNearRest) {
    expect_kernels_match_reference<3>(soft(GetParam()), 0.02);
    expect_kernels_match_reference<4>(soft(GetParam()), 0.02);
}

TEST_P(KernelModels, MatchTheReferenceWithInvertedElements) {
    expect_kernels_match_reference<3>(soft(GetParam()), 0.4);
    expect_kernels_match_reference<4>(soft(GetParam()), 0.4);
}

TEST_P(KernelModels, MatchTheReferenceExactlyAtRest) {
    expect_kernels_match_reference<3>(soft(GetParam()), 0);
    expect_kernels_match_reference<4>(soft(GetParam()), 0);
}

// A body pressed flat has det F = 0 everywhere: singular vectors of the zero value are made up.
TEST(FlattenedBody, HasTheHessianOfTheReference) {
    for (const Model model :
         {Model::StableNeoHookean, Model::StVenantKirchhoff, Model::Linear, Model::Arap}) {
        ElasticBox<4> box(soft(model));
        box.scramble(0.05, 3);
        box.positions.row(3).setZero();
        const Reference<4> reference(box, soft(model), Filter::Clamp);
        for (const Isa isa : supported_isas()) {
            const MatrixXd K = box.stiffness<double>(isa, Filter::Clamp);
            EXPECT_LT((K - reference.stiffness).norm(), 1e-9 * reference.stiffness.norm());
            const MatrixXd Kf = box.stiffness<float>(isa, Filter::Clamp);
            EXPECT_LT((Kf - reference.stiffness).norm(), 2e-4 * reference.stiffness.norm());
        }
    }
}

TEST_P(KernelModels, AreFiniteInACollapsedBody) {
    ElasticBox<4> box(soft(GetParam()));
    box.positions.setZero();
    for (const Isa isa : supported_isas()) {
        Positions<4> forces;
        EXPECT_TRUE(std::isfinite(box.forces(isa, box.positions, forces).energy));
        EXPECT_TRUE(forces.allFinite());
        EXPECT_TRUE(box.stiffness<float>(isa, Filter::Clamp).allFinite());
        EXPECT_TRUE(box.stiffness<double>(isa, Filter::Absolute).allFinite());
    }
}

TEST_P(KernelModels, HaveForcesEqualToTheDifferenceOfEnergy) {
    ElasticBox<4> box(soft(GetParam()));
    box.scramble(0.1, 5);
    Positions<4> forces;
    Positions<4> unused;
    static_cast<void>(box.forces(Isa::Baseline, box.positions, forces));
    const Positions<4> direction = forces / forces.norm();
    const double h = 1e-5;  // error h^2 of the difference, and 1e-16 / h of rounding
    const double rise = box.forces(Isa::Baseline, box.positions + h * direction, unused).energy
                        - box.forces(Isa::Baseline, box.positions - h * direction, unused).energy;
    EXPECT_NEAR(-rise / (2 * h), forces.norm(), 1e-7 * forces.norm());
}

TEST_P(KernelModels, HaveForcesAndTorquesThatCancelInEveryPlane) {
    ElasticBox<4> box(soft(GetParam()));
    box.scramble(0.2, 6);
    Positions<4> forces;
    static_cast<void>(box.forces(best_isa(), box.positions, forces));
    EXPECT_LT(forces.rowwise().sum().norm(), 1e-12 * forces.norm());
    if (GetParam() != Model::Linear) {  // which is not invariant under rotations
        const Eigen::Matrix4d moment = box.positions * forces.transpose();
        EXPECT_LT((moment - moment.transpose()).norm(), 1e-11 * moment.norm());
    }
}

TEST(InvertedElements, AreCounted) {
    ElasticBox<4> box(soft(Model::StableNeoHookean));
    Positions<4> forces;
    EXPECT_EQ(box.forces(Isa::Baseline, box.positions, forces).inverted, 0);
    box.positions.row(0) *= -1;
    EXPECT_EQ(box.forces(Isa::Baseline, box.positions, forces).inverted, box.mesh.cell_count());
}

// The columns of held vertices go to the right side: K_fh shift, from the full matrix of a free box.
TEST(HeldVertices, TakeTheirColumnsToTheRightSide) {
    const Material material = soft(Model::StableNeoHookean);
    const std::vector<std::uint32_t> held = {1, 4, 9};
    ElasticBox<4> free_box(material);
    ElasticBox<4> box(material, held);
    free_box.scramble(0.1, 8);
    box.positions = free_box.positions;
    Positions<4> shift = Positions<4>::Zero(4, box.mesh.vertex_count());
    for (const std::uint32_t vertex : held) {
        shift.col(vertex) = Eigen::Vector4d(0.1, -0.2, 0.3, 0.05 * vertex);
    }
    BlockVector<4> all_shift(4, free_box.pattern.rows());
    for (std::uint32_t u = 0; u < free_box.numbering.free_count(); ++u) {
        all_shift.col(u) = shift.col(free_box.numbering.vertex_of_unknown[u]);
    }
    const MatrixXd K = free_box.stiffness<double>(Isa::Scalar, Filter::Clamp);
    const Eigen::VectorXd pulled = 2.5 * K * all_shift.reshaped();
    for (const Isa isa : supported_isas()) {
        BlockMatrix<4, double> matrix(box.pattern);
        BlockVector<4> right = BlockVector<4>::Zero(4, box.pattern.rows());
        box.elements->add_hessian(Workers(1), kernels<4>(isa), box.positions, 2.5, Filter::Clamp,
                                  shift, matrix, right);
        for (std::uint32_t u = 0; u < box.numbering.free_count(); ++u) {
            const std::uint32_t vertex = box.numbering.vertex_of_unknown[u];
            const Eigen::Index at = 4 * free_box.numbering.unknown_of_vertex[vertex];
            EXPECT_LT((right.col(u) + pulled.segment<4>(at)).norm(), 1e-10 * pulled.norm());
        }
    }
}

}  // namespace
}  // namespace pent::simulator
