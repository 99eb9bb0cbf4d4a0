#include "theory/eigen_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>

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

// Beyond n = 8 a sample of modes is tried, whatever the number of modes leaves over by its stride.
TEST(EigenProofs, TryNoModeTwice) {
    for (int dim = 9; dim <= 24; ++dim) {
        const EigenProof proof = prove_eigensystem(Invariant::I2, dim);
        EXPECT_TRUE(proof.holds()) << dim << ": " << proof.residual << " " << proof.orthogonality;
    }
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

TEST(EigenProof, OfTwoHasTheWorstOfEachAndAllTheirStates) {
    EigenProof a = prove_eigensystem(Model::Arap, 4);
    const EigenProof b = prove_eigensystem(Invariant::I1, 5);
    const EigenProof alone = a;
    a.merge(b);
    EXPECT_EQ(a.dim, 5);
    EXPECT_EQ(a.states, alone.states + b.states);
    EXPECT_EQ(a.modes, alone.modes + b.modes);
    EXPECT_EQ(a.values, std::max(alone.values, b.values));
    EXPECT_EQ(a.residual, std::max(alone.residual, b.residual));
    ASSERT_EQ(a.undefined.size(), 2U);  // the same two states, each with a mode more
    EXPECT_EQ(a.undefined[0].modes, 2);
    EigenProof none;
    none.merge(b);
    EXPECT_EQ(none.undefined.size(), b.undefined.size());
}

TEST(EigenFunctions, HaveNamesOfTheirOwn) {
    std::set<std::string> names;
    for (const EigenFunction& function : eigen_functions()) {
        names.insert(eigen_function_name(function));
    }
    EXPECT_EQ(names.size(), eigen_functions().size());
    EXPECT_EQ(names.count(""), 0U);
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

// Nor may what is not a number pass, in one mode among many, in a small matrix or in a large one.
TEST(EigenProofs, FailForAnEigenvalueThatIsNotANumber) {
    for (const int dim : {4, 9}) {
        const MatrixXd F = 1.2 * MatrixXd::Identity(dim, dim);
        HessianFrame wrong = hessian(proof_material(Model::Linear), F);
        wrong.flip(0, 1) = std::numeric_limits<double>::quiet_NaN();
        EigenProof proof;
        compare(Model::Linear, F, wrong, "", proof);
        EXPECT_FALSE(proof.holds()) << dim;
        EigenProof all = prove_eigensystem(Model::Linear, dim);
        EXPECT_TRUE(all.holds());
        all.merge(proof);
        EXPECT_FALSE(all.holds()) << dim;
    }
}

}  // namespace
}  // namespace pent::simulator
