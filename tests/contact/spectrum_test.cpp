#include "spectrum.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <random>

namespace pent::contact {
namespace {

template <typename T>
class SpectrumTest : public testing::Test {
protected:
    static constexpr int kSpace = T::value;
    using Matrix = StencilMatrix<kSpace>;

    // Symmetric, and the same for all points moved alike; of the given rank, at most.
    Matrix matrix(int rank) {
        Matrix sum = Matrix::Zero();
        for (int k = 0; k < rank; ++k) {
            StencilVector<kSpace> vector =
                StencilVector<kSpace>::NullaryExpr([&] { return number(); });
            auto points = vector.template reshaped<Eigen::AutoOrder>(kSpace, kSpace + 1);
            points.colwise() -= points.rowwise().mean().eval();
            sum += number() * vector * vector.transpose();
        }
        return sum;
    }
    double number() { return uniform_(random_); }

private:
    std::mt19937 random_{5};
    std::uniform_real_distribution<double> uniform_{-1, 1};
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(SpectrumTest, Dimensions);

TYPED_TEST(SpectrumTest, IsThatOfTheWholeMatrix) {
    constexpr int kDim = TypeParam::value;
    for (int rank = 1; rank <= kDim * kDim; ++rank) {
        const StencilMatrix<kDim> matrix = this->matrix(rank);
        const Eigen::SelfAdjointEigenSolver<StencilMatrix<kDim>> solver(matrix);
        const auto& V = solver.eigenvectors();
        const auto& values = solver.eigenvalues();
        const auto expect = [&](Filter filter, const auto& filtered) {
            const Spectrum<kDim> spectrum = filtered_spectrum<kDim>(matrix, filter);
            const StencilMatrix<kDim> expected = V * filtered.asDiagonal() * V.transpose();
            EXPECT_LT((spectrum.matrix() - expected).norm(), 1e-13 * matrix.norm());
            const auto count = spectrum.values.size();
            EXPECT_LE(count, kDim * kDim);
            EXPECT_LT((spectrum.vectors.transpose() * spectrum.vectors
                       - Eigen::MatrixXd::Identity(count, count))
                          .norm(),
                      1e-13);
            EXPECT_TRUE(filter == Filter::None || (spectrum.values.array() > 0).all());
        };
        expect(Filter::None, values);
        expect(Filter::Clamp, values.cwiseMax(0));
        expect(Filter::Absolute, values.cwiseAbs());
    }
}

TYPED_TEST(SpectrumTest, OfNothingIsEmpty) {
    constexpr int kDim = TypeParam::value;
    const StencilMatrix<kDim> nothing = StencilMatrix<kDim>::Zero();
    for (const Filter filter : {Filter::None, Filter::Clamp, Filter::Absolute}) {
        const Spectrum<kDim> spectrum = filtered_spectrum<kDim>(nothing, filter);
        EXPECT_EQ(spectrum.values.size(), 0);
        EXPECT_EQ(spectrum.matrix(), nothing);
    }
    const StencilMatrix<kDim> matrix = this->matrix(3);
    const StencilMatrix<kDim> below = -matrix * matrix.transpose();
    EXPECT_LT(filtered_spectrum<kDim>(below, Filter::Clamp).matrix().norm(), 1e-13 * below.norm());
}

}  // namespace
}  // namespace pent::contact
