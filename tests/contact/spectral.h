#pragma once

#include "spectra.h"

#include <vector>

namespace pent::contact::test {

/// Eigenvalues and eigenvectors, as matrices: of all vertices in use.
template <int Dim>
struct DenseSpectrum {
    Eigen::VectorXd values;
    Eigen::MatrixXd vectors;

    DenseSpectrum(const SpectralHessian<Dim>& hessian, const std::vector<double>& numbers)
        : values(hessian.rank), vectors(Dim * hessian.count, hessian.rank) {
        const double* next = numbers.data() + hessian.begin;
        for (double& value : values) {
            value = *next++;
        }
        for (int i = 0; i < hessian.count; ++i) {
            for (int k = 0; k < hessian.rank; ++k, next += Dim) {
                vectors.col(k).segment(Dim * i, Dim) = Eigen::Map<const Vector<Dim>>(next);
            }
        }
    }

    [[nodiscard]] Eigen::MatrixXd matrix() const {
        return vectors * values.asDiagonal() * vectors.transpose();
    }
};

/// Of one matrix, at all its vertices.
template <int Dim, int Size>
[[nodiscard]] DenseSpectrum<Dim> spectrum_of(const ReducedMatrix<Dim, Size>& matrix,
                                             Filter filter,
                                             int most) {
    SpectralHessian<Dim> hessian;
    hessian.count = Dim + 1;
    std::vector<double> numbers(static_cast<std::size_t>(most * (1 + Dim * (Dim + 1))));
    Spectra<Dim, Size> spectra(filter, most, numbers.data());
    spectra.add(matrix, hessian);
    spectra.finish();
    return {hessian, numbers};
}

}  // namespace pent::contact::test
