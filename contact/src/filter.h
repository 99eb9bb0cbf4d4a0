#pragma once

#include <pent/contact/filter.h>

#include <Eigen/Eigenvalues>

#include <cmath>

namespace pent::contact {

/// An eigenvalue as the filter leaves it.
[[nodiscard]] inline double filtered(double eigenvalue, Filter filter) {
    switch (filter) {
        case Filter::Clamp:
            return eigenvalue > 0 ? eigenvalue : 0;
        case Filter::Absolute:
            return std::abs(eigenvalue);
        case Filter::None:
            break;
    }
    return eigenvalue;
}

/// A symmetric matrix with its eigenvalues filtered.
template <typename Square>
[[nodiscard]] Square filtered_square(const Square& matrix, Filter filter) {
    if (filter == Filter::None) {
        return matrix;
    }
    const Eigen::SelfAdjointEigenSolver<Square> solver(matrix);
    const auto values =
        solver.eigenvalues().unaryExpr([&](double value) { return filtered(value, filter); });
    return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace pent::contact
