#include "spectra.h"

#include "spectral.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <vector>

namespace pent::contact {
namespace {

constexpr std::array<Filter, 3> kFilters{Filter::None, Filter::Clamp, Filter::Absolute};

template <typename T>
class SpectraTest : public testing::Test {
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
TYPED_TEST_SUITE(SpectraTest, Dimensions);

TYPED_TEST(SpectraTest, AreThoseOfTheWholeMatrix) {
    constexpr int kDim = TypeParam::value;
    for (int rank = 1; rank <= kDim * kDim; ++rank) {
        const StencilMatrix<kDim> matrix = this->matrix(rank);
        const auto reduced = without_translations<kDim>(matrix);
        EXPECT_LT((reduced.matrix() - matrix).norm(), 1e-14 * matrix.norm());
        const Eigen::SelfAdjointEigenSolver<StencilMatrix<kDim>> solver(matrix);
        const auto& V = solver.eigenvectors();
        const auto& values = solver.eigenvalues();
        const auto expect = [&](Filter filter, const auto& filtered) {
            const auto spectrum = test::spectrum_of(reduced, filter, kDim * kDim);
            const StencilMatrix<kDim> expected = V * filtered.asDiagonal() * V.transpose();
            EXPECT_LT((spectrum.matrix() - expected).norm(), 1e-13 * matrix.norm());
            const auto count = spectrum.values.size();
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

TYPED_TEST(SpectraTest, OfNothingIsEmpty) {
    constexpr int kDim = TypeParam::value;
    const StencilMatrix<kDim> nothing = StencilMatrix<kDim>::Zero();
    for (const Filter filter : kFilters) {
        const auto spectrum =
            test::spectrum_of(without_translations<kDim>(nothing), filter, kDim * kDim);
        EXPECT_EQ(spectrum.values.size(), 0);
    }
    const StencilMatrix<kDim> matrix = this->matrix(3);
    const StencilMatrix<kDim> below = -matrix * matrix.transpose();
    const auto clamped =
        test::spectrum_of(without_translations<kDim>(below), Filter::Clamp, kDim * kDim);
    EXPECT_LT(clamped.matrix().norm(), 1e-13 * below.norm());
}

TYPED_TEST(SpectraTest, KeepTheLargest) {
    constexpr int kDim = TypeParam::value;
    const auto reduced = without_translations<kDim>(this->matrix(kDim * kDim));
    const auto all = test::spectrum_of(reduced, Filter::Absolute, kDim * kDim);
    Eigen::VectorXd sorted = all.values;
    std::sort(sorted.begin(), sorted.end(), std::greater<>());
    for (int most = 1; most < kDim * kDim; ++most) {
        const auto kept = test::spectrum_of(reduced, Filter::Absolute, most);
        EXPECT_EQ(kept.values, sorted.head(most));
        const StencilMatrix<kDim> matrix = reduced.matrix();
        for (int k = 0; k < most; ++k) {
            const Eigen::VectorXd vector = kept.vectors.col(k);
            EXPECT_NEAR((matrix * vector).norm(), kept.values[k], 1e-13 * matrix.norm());
        }
    }
}

// However many there are, each gets its own, and no number is written beyond its room.
TYPED_TEST(SpectraTest, OfManyAreThoseOfEach) {
    constexpr int kDim = TypeParam::value;
    constexpr int kSize = kDim * kDim;
    for (int count = 1; count <= 2 * kSpectra + 1; ++count) {
        std::vector<StencilMatrix<kDim>> matrices;
        std::vector<SpectralHessian<kDim>> hessians(static_cast<std::size_t>(count));
        std::vector<double> numbers;
        for (int i = 0; i < count; ++i) {
            matrices.push_back(this->matrix(i % kSize));
            SpectralHessian<kDim>& hessian = hessians[static_cast<std::size_t>(i)];
            hessian.count = 1 + i % (kDim + 1);
            hessian.begin = numbers.size();
            numbers.resize(numbers.size()
                           + static_cast<std::size_t>(kSize * (1 + kDim * hessian.count)));
        }
        Spectra<kDim, kSize> spectra(Filter::None, kSize, numbers.data());
        for (int i = 0; i < count; ++i) {
            spectra.add(without_translations<kDim>(matrices[static_cast<std::size_t>(i)]),
                        hessians[static_cast<std::size_t>(i)]);
        }
        spectra.finish();
        spectra.finish();  // of nothing
        for (int i = 0; i < count; ++i) {
            const auto& hessian = hessians[static_cast<std::size_t>(i)];
            const int rows = kDim * hessian.count;
            const StencilMatrix<kDim>& matrix = matrices[static_cast<std::size_t>(i)];
            EXPECT_LE((test::DenseSpectrum<kDim>(hessian, numbers).matrix()
                       - matrix.topLeftCorner(rows, rows))
                          .norm(),
                      1e-13 * matrix.norm());
        }
    }
}

}  // namespace
}  // namespace pent::contact
