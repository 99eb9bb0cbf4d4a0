#include <pent/simulator/energy.h>
#include <pent/simulator/words.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace pent::simulator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::array kAllInvariants = {Invariant::I1, Invariant::I2, Invariant::I3};

Material soft(Model model) {
    return {.model = model, .lame = {.lambda = 1.3, .mu = 0.7}, .second_invariant = 0.4};
}

MatrixXd random_matrix(Index n, std::mt19937& random) {
    std::normal_distribution<double> normal;
    return MatrixXd::NullaryExpr(n, n, [&]() { return normal(random); });
}

MatrixXd random_rotation(Index n, std::mt19937& random) {
    const Eigen::HouseholderQR<MatrixXd> qr(random_matrix(n, random));
    MatrixXd Q = qr.householderQ();
    if (Q.determinant() < 0) {
        Q.col(0) *= -1;
    }
    return Q;
}

// F with given singular values and random rotations on both sides.
MatrixXd with_singular_values(const VectorXd& sigma, std::mt19937& random) {
    return random_rotation(sigma.size(), random) * sigma.asDiagonal()
           * random_rotation(sigma.size(), random).transpose();
}

// Singular values that formulas may trip over: repeated, zero, negative (inverted), huge.
std::vector<VectorXd> special_singular_values(Index n) {
    std::vector<VectorXd> list(6, VectorXd::LinSpaced(n, 1.6, 0.4));
    list[1].setOnes();
    list[2].head(2).setConstant(1.2);
    list[3][n - 1] = 0;
    list[4][n - 1] = -0.3;
    list[5][0] = 1e3;
    return list;
}

class Models : public testing::TestWithParam<Model> {};
INSTANTIATE_TEST_SUITE_P(All, Models, testing::ValuesIn(values<Model>()));
class Invariants : public testing::TestWithParam<Invariant> {};
INSTANTIATE_TEST_SUITE_P(All, Invariants, testing::ValuesIn(kAllInvariants));

TEST_P(Models, AreZeroWithZeroStressAtRest) {
    for (Index n = 2; n <= 8; ++n) {
        const MatrixXd identity = MatrixXd::Identity(n, n);
        EXPECT_NEAR(energy_density(soft(GetParam()), identity), 0, 1e-14);
        EXPECT_LT(stress(soft(GetParam()), identity).norm(), 1e-14);
    }
}

TEST(NonlinearModels, AreZeroWithZeroStressAtEveryRotation) {
    std::mt19937 random(1);
    for (const Model model : values<Model>()) {
        if (model == Model::Linear) {
            continue;
        }
        for (Index n = 2; n <= 8; ++n) {
            const MatrixXd R = random_rotation(n, random);
            EXPECT_NEAR(energy_density(soft(model), R), 0, 1e-13);
            EXPECT_LT(stress(soft(model), R).norm(), 1e-13);
        }
    }
}

// The material asked for is what small strains see: 2 mu e + lambda tr e I; arap has lambda = 0.
TEST_P(Models, LinearizeToTheLameParametersOfTheMaterial) {
    std::mt19937 random(2);
    for (Index n = 2; n <= 5; ++n) {
        const MatrixXd identity = MatrixXd::Identity(n, n);
        const MatrixXd half = random_matrix(n, random);
        const MatrixXd strain = half + half.transpose();
        const double lambda = GetParam() == Model::Arap ? 0 : 1.3;
        const MatrixXd expected = 2 * 0.7 * strain + lambda * strain.trace() * identity;
        const MatrixXd found = apply(hessian(soft(GetParam()), identity), strain);
        EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
    }
}

// It is so for every part of mu that the second invariant may carry, whatever Poisson's ratio.
TEST(MooneyRivlinEnergy, LinearizesToTheLameParametersForEveryShareOfTheSecondInvariant) {
    std::mt19937 random(12);
    for (const int n : {3, 4, 5}) {
        for (const double poisson : {-0.6, -0.2, 0.0, 0.9 * poisson_limit(n)}) {
            Material material{.model = Model::MooneyRivlin, .lame = lame_from_young(n, 1, poisson)};
            for (const double part : {0.0, 0.3, 1.0}) {
                material.second_invariant = part * highest_second_invariant(material.lame);
                const MatrixXd identity = MatrixXd::Identity(n, n);
                const MatrixXd half = random_matrix(n, random);
                const MatrixXd strain = half + half.transpose();
                const MatrixXd expected = 2 * material.lame.mu * strain
                                          + material.lame.lambda * strain.trace() * identity;
                const MatrixXd found = apply(hessian(material, identity), strain);
                EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
            }
        }
    }
}

TEST(MooneyRivlinEnergy, IsTheStableNeoHookeanOneWithNothingOnTheSecondInvariant) {
    std::mt19937 random(13);
    Material material = soft(Model::MooneyRivlin);
    material.second_invariant = 0;
    for (Index n = 2; n <= 5; ++n) {
        const MatrixXd F = random_matrix(n, random);
        const double energy = energy_density(soft(Model::StableNeoHookean), F);
        EXPECT_NEAR(energy_density(material, F), energy, 1e-14 * (1 + std::abs(energy)));
        const MatrixXd P = stress(soft(Model::StableNeoHookean), F);
        EXPECT_LT((stress(material, F) - P).norm(), 1e-14 * P.norm());
    }
}

// II = J^2 in the plane.
TEST(MooneyRivlinEnergy, DoesNotSeeTheSecondInvariantInThePlane) {
    std::mt19937 random(14);
    const MatrixXd F = random_matrix(2, random);
    EXPECT_NEAR(energy_density(soft(Model::MooneyRivlin), F),
                energy_density(soft(Model::StableNeoHookean), F), 1e-14);
}

// Pulled along an axis to a stretch a, sides free, an incompressible body narrows to
// b = a^(-1 / (n - 1)) and pulls back with 2 (a - b^2 / a) (c1 + (n - 2) c2 b^2) on each unit of
// its area at rest; in 3D Mooney's 2 (a - 1 / a^2) (c1 + c2 / a). With lambda = 1e6 mu the volume
// is off by 1e-6.
TEST(MooneyRivlinEnergy, HasMooneysStressUnderUniaxialTension) {
    for (const int n : {3, 4}) {
        for (const double part : {0.0, 0.5, 1.0}) {
            const Material material{.model = Model::MooneyRivlin,
                                    .lame = {.lambda = 1e6, .mu = 1},
                                    .second_invariant = part};
            const double c1 = (1 - part) / 2;
            const double c2 = part / (2.0 * (n - 2));
            for (const double a : {0.6, 1.3, 2.5}) {
                double low = 0.5 * std::pow(a, -1.0 / (n - 1));  // pressed: pushes to the side
                double high = 2 * std::pow(a, -1.0 / (n - 1));
                MatrixXd P;
                for (int i = 0; i < 60; ++i) {
                    VectorXd sigma = VectorXd::Constant(n, 0.5 * (low + high));
                    sigma[0] = a;
                    P = stress(material, sigma.asDiagonal());
                    (P(1, 1) < 0 ? low : high) = sigma[1];
                }
                const double b_squared = std::pow(a, -2.0 / (n - 1));
                const double expected = 2 * (a - b_squared / a) * (c1 + (n - 2) * c2 * b_squared);
                EXPECT_NEAR(P(0, 0), expected, 2e-5 * std::abs(expected)) << n << " " << a;
            }
        }
    }
}

// Beyond the highest part det F outweighs all else in 3D: the bound is no smaller than it must be.
TEST(MooneyRivlinEnergy, HasALowerBoundUpToTheHighestShareOfTheSecondInvariantAndNoneBeyondIn3D) {
    Material material{.model = Model::MooneyRivlin, .lame = lame_from_young(3, 1, -0.3)};
    const MatrixXd huge = 1e4 * MatrixXd::Identity(3, 3);
    material.second_invariant = highest_second_invariant(material.lame);
    EXPECT_LT(material.second_invariant, 1);
    EXPECT_GT(energy_density(material, huge), 0);
    material.second_invariant *= 1.01;
    EXPECT_LT(energy_density(material, huge), -1e10);
}

// Central differences with step h are off by h^2 f'''/6 and by 1e-16 f / h, both about 1e-10 of f
// here.
constexpr double kStep = 1e-5;

TEST_P(Models, HaveStressEqualToTheDifferenceOfEnergyAlongEveryDirection) {
    std::mt19937 random(3);
    for (Index n = 2; n <= 5; ++n) {
        for (const VectorXd& sigma : special_singular_values(n)) {
            const MatrixXd F = with_singular_values(sigma, random);
            const Material material = soft(GetParam());
            const MatrixXd P = stress(material, F);
            // Along the gradient as well: random directions can average a mistake away.
            for (const MatrixXd& direction : {random_matrix(n, random), P}) {
                if (direction.norm() < 1e-9) {
                    continue;
                }
                const MatrixXd d = direction / direction.norm();
                const double h = kStep;
                const double slope =
                    (energy_density(material, F + h * d) - energy_density(material, F - h * d))
                    / (2 * h);
                const double size =
                    P.norm() + std::abs(energy_density(material, F)) / F.norm() + 1e-3;
                EXPECT_NEAR(P.cwiseProduct(d).sum(), slope, 2e-6 * size) << sigma.transpose();
            }
        }
    }
}

TEST_P(Models, HaveHessianEqualToTheDifferenceOfStress) {
    std::mt19937 random(4);
    for (Index n = 2; n <= 5; ++n) {
        for (const VectorXd& sigma : special_singular_values(n)) {
            const MatrixXd F = with_singular_values(sigma, random);
            const Material material = soft(GetParam());
            const HessianFrame H = hessian(material, F);
            const MatrixXd d = random_matrix(n, random).normalized();
            const double h = kStep;
            const MatrixXd slope =
                (stress(material, F + h * d) - stress(material, F - h * d)) / (2 * h);
            EXPECT_LT((apply(H, d) - slope).norm(), 2e-6 * (1 + dense(H).norm()))
                << sigma.transpose();
        }
    }
}

TEST_P(Invariants, HaveGradientEqualToTheDifferenceOfTheValue) {
    std::mt19937 random(5);
    for (Index n = 2; n <= 6; ++n) {
        for (const VectorXd& sigma : special_singular_values(n)) {
            const MatrixXd F = with_singular_values(sigma, random);
            const MatrixXd gradient = invariant_gradient(GetParam(), F);
            const MatrixXd d = gradient / gradient.norm();
            const double h = kStep;
            const double slope =
                (invariant(GetParam(), F + h * d) - invariant(GetParam(), F - h * d)) / (2 * h);
            EXPECT_NEAR(gradient.norm(), slope, 1e-6 * gradient.norm()) << sigma.transpose();
        }
    }
}

// One Hessian product that knows nothing of singular vectors: the derivative of mu F + p(J) cof F
// along d, with d cof F = J (tr(G d) G^T - (G d G)^T), G = F^-1.
MatrixXd neo_hookean_product(const Lame& lame, const MatrixXd& F, const MatrixXd& d) {
    const MatrixXd G = F.inverse();
    const double J = F.determinant();
    const MatrixXd cofactor = J * G.transpose();
    const double trace = (G * d).trace();
    const double lambda = lame.lambda + lame.mu;
    return lame.mu * d + lambda * J * trace * cofactor
           + (lambda * (J - 1) - lame.mu) * (trace * cofactor - J * (G * d * G).transpose());
}

// Matrix-free, so that it reaches n = 100: sampled eigenpairs satisfy H q = lambda q, all modes
// have norm 1 and sampled ones are orthogonal, and eigenvalues add up to the trace of H.
TEST(NeoHookeanEigensystem, HoldsInDimensionsUpTo100) {
    std::mt19937 random(9);
    const Material material = soft(Model::StableNeoHookean);
    for (const Index n : {2, 3, 4, 10, 30, 100}) {
        // Values near 1 keep products of 100 of them near 1.
        std::uniform_real_distribution<double> near_one(0.95, 1.05);
        const VectorXd sigma = VectorXd::NullaryExpr(n, [&]() { return near_one(random); });
        const MatrixXd F = with_singular_values(sigma, random);
        const Eigensystem system(hessian(material, F));
        const double scale = system.values().cwiseAbs().maxCoeff();
        std::uniform_int_distribution<Index> pick(0, n * n - 1);
        MatrixXd previous = MatrixXd::Zero(n, n);
        for (int sample = 0; sample < 20; ++sample) {
            const Index k = sample < n ? sample : pick(random);
            const MatrixXd q = system.mode(k);
            const MatrixXd Hq = neo_hookean_product(material.lame, F, q);
            EXPECT_LT((Hq - system.values()[k] * q).norm(), 1e-11 * scale) << n << " " << k;
            EXPECT_NEAR(q.norm(), 1, 1e-12);
            EXPECT_TRUE(q.isApprox(previous) || std::abs(q.cwiseProduct(previous).sum()) < 1e-11);
            previous = q;
        }
        // tr H = mu n^2 + lambda |cof F|^2: the second derivative of det has no diagonal.
        const double lambda = material.lame.lambda + material.lame.mu;
        const MatrixXd cofactor = F.determinant() * F.inverse().transpose();
        const double trace =
            material.lame.mu * static_cast<double>(n * n) + lambda * cofactor.squaredNorm();
        EXPECT_NEAR(system.values().sum(), trace, 1e-10 * trace);
    }
}

TEST(RotationHessian, IsZeroWhereTheRotationIsNotUnique) {
    const MatrixXd F = Eigen::Vector4d(2, 1, 0, 0).asDiagonal();
    const HessianFrame H = invariant_hessian(Invariant::I1, F);
    EXPECT_TRUE(dense(H).allFinite());
    EXPECT_EQ(H.twist.minCoeff(), 0);
    EXPECT_TRUE(dense(hessian(soft(Model::Arap), MatrixXd::Zero(4, 4))).allFinite());
}

TEST_P(Models, HaveNoNegativeEigenvalueAfterClampingAndOnlyAbsoluteOnesAfterAbsolute) {
    std::mt19937 random(10);
    for (Index n = 2; n <= 4; ++n) {
        const MatrixXd F = random_matrix(n, random);
        const HessianFrame H = hessian(soft(GetParam()), F);
        const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(dense(H));
        const auto rebuilt = [&](const VectorXd& values) -> MatrixXd {
            return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
        };
        const VectorXd values = solver.eigenvalues();
        const double scale = 1 + values.cwiseAbs().maxCoeff();
        const MatrixXd clamped = dense(filtered(H, Filter::Clamp));
        const MatrixXd absolute = dense(filtered(H, Filter::Absolute));
        EXPECT_LT((clamped - rebuilt(values.cwiseMax(0))).norm(), 1e-11 * scale);
        EXPECT_LT((absolute - rebuilt(values.cwiseAbs())).norm(), 1e-11 * scale);
        EXPECT_LT((dense(filtered(H, Filter::None)) - dense(H)).norm(), 1e-11 * scale);
    }
}

}  // namespace
}  // namespace pent::simulator
