#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pent::contact {

template <int Dim>
using Vector = Eigen::Matrix<double, Dim, 1>;

/// A matrix between two points.
template <int Dim>
using Block = Eigen::Matrix<double, Dim, Dim>;

/// Corners of a simplex, one a column, m.
template <int Dim, int Count>
using Corners = Eigen::Matrix<double, Dim, Count>;

/// The Dim + 1 points of a pair, one a column, m: corners of the first simplex, then of the second.
template <int Dim>
using Stencil = Eigen::Matrix<double, Dim, Dim + 1>;

/// Weights w of these points, dimensionless: beta of the first simplex, -alpha of the second.
template <int Dim>
using Weights = Eigen::Matrix<double, Dim + 1, 1>;

/// Derivatives by all coordinates of a stencil, in the order x0 y0 z0 w0 x1 ...
template <int Dim>
using StencilVector = Eigen::Matrix<double, Dim*(Dim + 1), 1>;
template <int Dim>
using StencilMatrix = Eigen::Matrix<double, Dim*(Dim + 1), Dim*(Dim + 1)>;

/// The Hessian of an energy of sum w_i x_i with the weights held, N/m: block (i, j) is w_i w_j
/// block.
template <int Dim>
struct WeightedHessian {
    std::array<std::uint32_t, Dim + 1> vertices{};
    std::int32_t count = 0;  ///< Vertices in use.
    Weights<Dim> weights = Weights<Dim>::Zero();
    Block<Dim> block = Block<Dim>::Zero();
};

/// The Hessian of an energy of a few vertices by all their coordinates, N/m, by its eigenvalues and
/// eigenvectors: block (i, j) is
///
///     sum over k < rank of value_k f_ik f_jk^T
///
/// Its numbers are in a list of StencilHessians: the values, and then for each vertex i the vectors
/// f_i0, f_i1, ... of Dim numbers.
template <int Dim>
struct SpectralHessian {
    std::array<std::uint32_t, Dim + 1> vertices{};
    std::int32_t count = 0;  ///< Vertices in use.
    std::int32_t rank = 0;   ///< Eigenvalues that are not 0.
    std::size_t begin = 0;   ///< Of its numbers.
};

/// The Hessian of a sum of such energies: what to scatter into a matrix, in this order.
template <int Dim>
struct StencilHessians {
    std::vector<WeightedHessian<Dim>> weighted;
    std::vector<SpectralHessian<Dim>> spectral;
    std::vector<double> numbers;  ///< Of `spectral`; there may be more than are in use.
};

}  // namespace pent::contact
