#pragma once

#include <pent/contact/filter.h>
#include <pent/contact/stencil.h>

#include <Eigen/Core>

namespace pent::contact {

/// Eigenvalues of a symmetric matrix of a stencil, and orthonormal eigenvectors, one a column; all
/// others are 0. What is not changed by a translation has at most Dim^2 of them.
template <int Dim>
struct Spectrum {
    Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, Dim * Dim> values;
    Eigen::Matrix<double, Dim*(Dim + 1), Eigen::Dynamic, Eigen::ColMajor, Dim*(Dim + 1), Dim * Dim>
        vectors;

    /// Keeps the first ones.
    void resize(Eigen::Index count) {
        values.conservativeResize(count);
        vectors.conservativeResize(Eigen::NoChange, count);
    }

    [[nodiscard]] StencilMatrix<Dim> matrix() const {
        return vectors * values.asDiagonal() * vectors.transpose();
    }
};

/// Of the second derivatives of an energy that no translation changes, filtered.
template <int Dim>
[[nodiscard]] Spectrum<Dim> filtered_spectrum(const StencilMatrix<Dim>& matrix, Filter filter);

}  // namespace pent::contact
