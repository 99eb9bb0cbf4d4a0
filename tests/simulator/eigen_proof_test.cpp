#include "eigen_oracle.h"

#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using Eigen::MatrixXd;

class EigenProofs : public testing::TestWithParam<EigenFunction> {};
INSTANTIATE_TEST_SUITE_P(All, EigenProofs, testing::ValuesIn(eigen_functions()));

TEST_P(EigenProofs, HoldInDimensions2To8WithTheDenseMatrix) {
    for (int dim = 2; dim <= 8; ++dim) {
        const EigenProof proof = prove_eigensystem(GetParam(), dim);
        EXPECT_TRUE(proof.holds()) << dim << ": " << proof.values << " " << proof.residual << " "
                                   << proof.orthogonality << " " << proof.trace;
        EXPECT_EQ(proof.states, 8);
    }
}

TEST_P(EigenProofs, HoldInDimension30WithoutAMatrix) {
    const EigenProof proof = prove_eigensystem(GetParam(), 30);
    EXPECT_TRUE(proof.holds()) << proof.residual << " " << proof.orthogonality << " "
                               << proof.trace;
    EXPECT_GE(proof.modes, 8 * 10 - 2);
}

// The rotation is not unique where two singular values add up to 0: one twist there, in two states.
TEST(EigenProofs, NameTheStatesWhereTheRotationIsNotUnique) {
    for (const EigenFunction& function : eigen_functions()) {
        const bool has_rotation =
            function == EigenFunction(Invariant::I1) || function == EigenFunction(Model::Arap);
        const EigenProof proof = prove_eigensystem(function, 4);
        ASSERT_EQ(proof.undefined.size(), has_rotation ? 2U : 0U) << eigen_function_name(function);
        for (const UndefinedModes& entry : proof.undefined) {
            EXPECT_TRUE(entry.state == "two zeros" || entry.state == "sigma_i + sigma_j = 0");
            EXPECT_EQ(entry.modes, 1);
        }
    }
}

// A proof must fail for what is wrong: one eigenvalue off, or one eigenmatrix.
TEST(EigenProofs, FailForAWrongEigenvalueOrEigenmatrix) {
    MatrixXd F = MatrixXd::Identity(3, 3);
    F(0, 1) = 0.3;
    F(2, 2) = 1.4;
    const HessianFrame right = hessian(proof_material(Model::StableNeoHookean), F);
    EigenProof proof;
    compare(Model::StableNeoHookean, F, right, "", proof);
    EXPECT_TRUE(proof.holds());
    HessianFrame wrong = right;
    wrong.twist(0, 1) *= 1.001;
    wrong.twist(1, 0) = wrong.twist(0, 1);
    EigenProof value;
    compare(Model::StableNeoHookean, F, wrong, "", value);
    EXPECT_GT(value.residual, 1e-5);
    EXPECT_GT(value.values, 1e-5);
    EXPECT_GT(value.trace, 1e-5);
    wrong = right;
    wrong.U.col(0).swap(wrong.U.col(1));
    EigenProof mode;
    compare(Model::StableNeoHookean, F, wrong, "", mode);
    EXPECT_GT(mode.residual, 1e-3);
    wrong = right;
    wrong.V.col(0) += 0.1 * wrong.V.col(1);
    EigenProof skewed;
    compare(Model::StableNeoHookean, F, wrong, "", skewed);
    EXPECT_GT(skewed.orthogonality, 1e-3);
}

}  // namespace
}  // namespace pent::simulator
