#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace pent::contact {

template <int Dim>
using Vector = Eigen::Matrix<double, Dim, 1>;

/// Corners of a simplex, one a column, m.
template <int Dim, int Count>
using Corners = Eigen::Matrix<double, Dim, Count>;

/// How the closest points of two simplices came about.
enum class Branch : std::uint8_t {
    Interior,   ///< Inside both simplices; unique.
    Border,     ///< On a proper face of at least one of them; unique.
    Parallel,   ///< The simplices have a direction in common: one of many closest pairs.
    Collapsed,  ///< The corners of one simplex span less than they should: one of many weights.
};

/// The closest points of two simplices in R^Dim:
///
///     x = sum beta_i r_i,   y = sum alpha_j p_j,   all beta, alpha >= 0, each summing to 1.
template <int Dim, int K, int L>
struct ClosestPoints {
    Eigen::Matrix<double, K, 1> beta;   ///< Weights in the first simplex.
    Eigen::Matrix<double, L, 1> alpha;  ///< Weights in the second simplex.
    Vector<Dim> difference;             ///< x - y, m. Zero, and of no direction, where they touch.
    double distance_squared = 0;        ///< |x - y|^2, m^2.
    std::uint8_t first_face = 0;        ///< Bit i: corner i of the first simplex carries x.
    std::uint8_t second_face = 0;       ///< Bit j: corner j of the second simplex carries y.
    Branch branch = Branch::Interior;
};

/// Closest points of the simplices of K and L corners, K + L = Dim + 1: point and facet, or the
/// mixed pair (edge and edge in R^3, edge and triangle in R^4).
///
/// Minimizes |x - y|^2 over the product of the simplices, a convex polytope: the free minimum over
/// the affine hulls if its weights are all positive, else the best of the facets it lies beyond.
/// Where the edges are dependent within 0.01 rad every facet is tried, so that the distance is
/// right to rounding (1e-14 of the size of the simplices) for parallel, touching and collapsed
/// simplices too. Which of several closest pairs comes out depends on the order of the corners.
///
/// @param first   Corners r_i, finite, not checked.
/// @param second  Corners p_j, finite, not checked.
template <int Dim, int K, int L>
[[nodiscard]] ClosestPoints<Dim, K, L> closest_points(const Corners<Dim, K>& first,
                                                      const Corners<Dim, L>& second);

/// The smaller of the squared distance of two simplices and `limit_squared`, m^2: the same search,
/// left as soon as the distance is known to be beyond the limit.
template <int Dim, int K, int L>
[[nodiscard]] double distance_squared_within(const Corners<Dim, K>& first,
                                             const Corners<Dim, L>& second,
                                             double limit_squared);

}  // namespace pent::contact
