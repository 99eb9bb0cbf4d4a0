#include "spectrum.h"

#include "filter.h"

#include <pent/dimensions.h>

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace pent::contact {

namespace {

// Orthonormal columns whose sums are 0: differences of points, from which translations are gone.
template <int Dim>
Eigen::Matrix<double, Dim + 1, Dim> differences() {
    Eigen::Matrix<double, Dim + 1, Dim> columns = Eigen::Matrix<double, Dim + 1, Dim>::Zero();
    for (int k = 0; k < Dim; ++k) {
        columns.col(k).head(k + 1).setOnes();
        columns(k + 1, k) = -(k + 1);
        columns.col(k).normalize();
    }
    return columns;
}

}  // namespace

template <int Dim>
Spectrum<Dim> filtered_spectrum(const StencilMatrix<Dim>& matrix, Filter filter) {
    constexpr int kSize = Dim * Dim;
    static const Eigen::Matrix<double, Dim + 1, Dim> basis = differences<Dim>();
    Eigen::Matrix<double, Dim*(Dim + 1), kSize> half =
        Eigen::Matrix<double, Dim*(Dim + 1), kSize>::Zero();
    for (int k = 0; k < Dim; ++k) {
        for (int i = 0; i <= k + 1; ++i) {
            half.template middleCols<Dim>(Dim * k) +=
                basis(i, k) * matrix.template middleCols<Dim>(Dim * i);
        }
    }
    Eigen::Matrix<double, kSize, kSize> inner = Eigen::Matrix<double, kSize, kSize>::Zero();
    for (int k = 0; k < Dim; ++k) {
        for (int i = 0; i <= k + 1; ++i) {
            inner.template middleRows<Dim>(Dim * k) +=
                basis(i, k) * half.template middleRows<Dim>(Dim * i);
        }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kSize, kSize>> solver(inner);
    Spectrum<Dim> spectrum;
    spectrum.resize(kSize);
    Eigen::Index rank = 0;
    for (Eigen::Index from = 0; from < kSize; ++from) {
        const double value = filtered(solver.eigenvalues()[from], filter);
        if (value == 0) {
            continue;
        }
        spectrum.values[rank] = value;
        const auto vector = solver.eigenvectors().col(from);
        for (int i = 0; i <= Dim; ++i) {
            Vector<Dim> corner = Vector<Dim>::Zero();
            for (int k = std::max(i - 1, 0); k < Dim; ++k) {
                corner += basis(i, k) * vector.template segment<Dim>(Dim * k);
            }
            spectrum.vectors.col(rank).template segment<Dim>(Dim * i) = corner;
        }
        ++rank;
    }
    spectrum.resize(rank);
    return spectrum;
}

#define PENT_INSTANTIATE(Dim) \
    template Spectrum<Dim> filtered_spectrum<Dim>(const StencilMatrix<Dim>&, Filter);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
