#include "kernels/kernels.h"

#include "elastic_box.h"
#include "kernel_reference.h"

#include <pent/simulator/energy.h>
#include <pent/simulator/words.h>

#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using Eigen::MatrixXd;
using test::ElasticBox;
using test::Reference;
using test::supported_isas;

Material soft(Model model) {
    return {.model = model, .lame = {.lambda = 1.3, .mu = 0.7}, .second_invariant = 0.4};
}

template <int Dim>
void expect_kernels_match_reference(const Material& material, ElementKind kind, double scramble) {
    const std::vector<std::uint32_t> held = {0, 3};
    ElasticBox<Dim> box(material, held, kind);
    box.scramble(scramble, 7);
    for (const Filter filter : {Filter::Clamp, Filter::Absolute, Filter::None}) {
        const Reference<Dim> reference(box, material, filter, kind);
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

struct KernelCase {
    Model model;
    ElementKind kind;
};

std::vector<KernelCase> kernel_cases() {
    std::vector<KernelCase> cases;
    for (const Model model : values<Model>()) {
        cases.push_back({model, ElementKind::Linear});
        cases.push_back({model, ElementKind::Smoothed});
        cases.push_back({model, ElementKind::Quadratic});
    }
    return cases;
}

class KernelModels : public testing::TestWithParam<KernelCase> {
protected:
    [[nodiscard]] static Material material() { return soft(GetParam().model); }
    [[nodiscard]] static ElementKind kind() { return GetParam().kind; }
};
INSTANTIATE_TEST_SUITE_P(All, KernelModels, testing::ValuesIn(kernel_cases()), [](const auto& all) {
    return std::string(all.param.kind == ElementKind::Linear     ? "Linear"
                       : all.param.kind == ElementKind::Smoothed ? "Smoothed"
                                                                 : "Quadratic")
           + std::to_string(static_cast<int>(all.param.model));
});

TEST_P(KernelModels, MatchTheReferenceNearRest) {
    expect_kernels_match_reference<3>(material(), kind(), 0.02);
    expect_kernels_match_reference<4>(material(), kind(), 0.02);
}

TEST_P(KernelModels, MatchTheReferenceWithInvertedElements) {
    expect_kernels_match_reference<3>(material(), kind(), 0.4);
    expect_kernels_match_reference<4>(material(), kind(), 0.4);
}

TEST_P(KernelModels, MatchTheReferenceExactlyAtRest) {
    expect_kernels_match_reference<3>(material(), kind(), 0);
    expect_kernels_match_reference<4>(material(), kind(), 0);
}

// Moduli whose squares leave the range of float: the Hessian is proportional to them.
TEST_P(KernelModels, MatchTheReferenceInAnyUnits) {
    for (const double unit : {1e-25, 1e25}) {
        Material scaled = material();
        scaled.lame.lambda *= unit;
        scaled.lame.mu *= unit;
        expect_kernels_match_reference<3>(scaled, kind(), 0.4);
        expect_kernels_match_reference<4>(scaled, kind(), 0.4);
    }
}

// A body pressed flat has det F = 0 everywhere: singular vectors of the zero value are made up.
TEST(FlattenedBody, HasTheHessianOfTheReference) {
    for (const auto& [model, kind] : kernel_cases()) {
        ElasticBox<4> box(soft(model), {}, kind);
        box.scramble(0.05, 3);
        box.positions.row(3).setZero();
        const Reference<4> reference(box, soft(model), Filter::Clamp, kind);
        for (const Isa isa : supported_isas()) {
            const MatrixXd K = box.stiffness<double>(isa, Filter::Clamp);
            EXPECT_LT((K - reference.stiffness).norm(), 1e-9 * reference.stiffness.norm());
            const MatrixXd Kf = box.stiffness<float>(isa, Filter::Clamp);
            EXPECT_LT((Kf - reference.stiffness).norm(), 2e-4 * reference.stiffness.norm());
        }
    }
}

// A body on its way to a point has singular vectors at every size, far below that at which fourth
// powers of F underflow in float. Far above its size only arap is finite in float. Beside the
// stiffness at rest, as that of a crushed body may be zero.
TEST_P(KernelModels, MatchTheReferenceAtEverySizeOfABody) {
    ElasticBox<4> box(material(), {}, kind());
    const double stiff = Reference<4>(box, material(), Filter::Clamp, kind()).stiffness.norm();
    for (const double size : {1e-5, 1e-8, 1e-12, 1e-25, 1e12}) {
        if (size > 1 && GetParam().model != Model::Arap) {
            continue;
        }
        box.scramble(0.1, 3);
        box.positions *= size;
        const Reference<4> reference(box, material(), Filter::Clamp, kind());
        for (const Isa isa : supported_isas()) {
            const MatrixXd Kf = box.stiffness<float>(isa, Filter::Clamp);
            EXPECT_LT((Kf - reference.stiffness).norm(), 2e-4 * stiff)
                << isa_name(isa) << " at " << size;
        }
    }
}

TEST_P(KernelModels, AreFiniteInACollapsedBody) {
    ElasticBox<4> box(material(), {}, kind());
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
    ElasticBox<4> box(material(), {}, kind());
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
    ElasticBox<4> box(material(), {}, kind());
    box.scramble(0.2, 6);
    Positions<4> forces;
    static_cast<void>(box.forces(best_isa(), box.positions, forces));
    EXPECT_LT(forces.rowwise().sum().norm(), 1e-12 * forces.norm());
    if (GetParam().model != Model::Linear) {  // which is not invariant under rotations
        const Eigen::Matrix4d moment = box.positions * forces.transpose();
        EXPECT_LT((moment - moment.transpose()).norm(), 1e-11 * moment.norm());
    }
}

class KernelKinds : public testing::TestWithParam<ElementKind> {};
INSTANTIATE_TEST_SUITE_P(All,
                         KernelKinds,
                         testing::Values(ElementKind::Linear,
                                         ElementKind::Smoothed,
                                         ElementKind::Quadratic));

TEST_P(KernelKinds, CountInvertedElements) {
    ElasticBox<4> box(soft(Model::StableNeoHookean), {}, GetParam());
    Positions<4> forces;
    EXPECT_EQ(box.forces(Isa::Baseline, box.positions, forces).inverted, 0);
    box.positions.row(0) *= -1;
    EXPECT_EQ(box.forces(Isa::Baseline, box.positions, forces).inverted, box.elements->count());
}

TEST_P(KernelKinds, CountCollapsedElements) {
    ElasticBox<4> box(soft(Model::StableNeoHookean), {}, GetParam());
    Positions<4> forces;
    EXPECT_EQ(box.forces(best_isa(), box.positions, forces).collapsed, 0);
    box.positions *= 1e-3;
    EXPECT_EQ(box.forces(best_isa(), box.positions, forces).collapsed, box.elements->count());
}

// The columns of held vertices go to the right side: K_fh displacement, from the full matrix of a
// free box.
TEST_P(KernelKinds, TakeColumnsOfHeldVerticesToTheRightSide) {
    const Material material = soft(Model::StableNeoHookean);
    const std::vector<std::uint32_t> held = {1, 4, 9};
    ElasticBox<4> free_box(material, {}, GetParam());
    ElasticBox<4> box(material, held, GetParam());
    free_box.scramble(0.1, 8);
    box.positions = free_box.positions;
    Positions<4> displacement = Positions<4>::Zero(4, box.mesh.vertex_count());
    for (const std::uint32_t vertex : held) {
        displacement.col(vertex) = Eigen::Vector4d(0.1, -0.2, 0.3, 0.05 * vertex);
    }
    BlockVector<4> all_displacement(4, free_box.pattern.rows());
    for (std::uint32_t u = 0; u < free_box.dofs.count(); ++u) {
        all_displacement.col(u) = displacement.col(free_box.dofs.vertex_of(u));
    }
    const MatrixXd K = free_box.stiffness<double>(Isa::Scalar, Filter::Clamp);
    const Eigen::VectorXd pulled = 2.5 * K * all_displacement.reshaped();
    for (const Isa isa : supported_isas()) {
        BlockMatrix<4, double> matrix(box.pattern);
        BlockVector<4> right = BlockVector<4>::Zero(4, box.pattern.rows());
        HessianTarget<double> target = target_in(matrix, 2.5, Filter::Clamp);
        target.prescribed_displacement = displacement.data();
        target.right = right.data();
        box.elements->add_hessian(Workers(1), kernels<4>(isa), box.positions, target);
        for (std::uint32_t u = 0; u < box.dofs.count(); ++u) {
            const std::uint32_t vertex = box.dofs.vertex_of(u);
            const Eigen::Index at = Eigen::Index{4} * free_box.dofs.dof_of(vertex);
            EXPECT_LT((right.col(u) + pulled.segment<4>(at)).norm(), 1e-10 * pulled.norm());
        }
    }
}

}  // namespace
}  // namespace pent::simulator
