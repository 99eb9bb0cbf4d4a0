#pragma once

#include <pent/contact/obstacles.h>
#include <pent/contact/stencil.h>

#include <limits>

namespace pent::contact {

/// Continuous collision detection by distances alone, so that it holds in any dimension.
///
/// Corners move on straight lines from t = 0 to 1. The result is a t up to which the gap, the
/// distance less `separation`, stays at least a tenth of what it is at 0, or of Clearance::distance
/// if that is less; it is 1, or the gap at the t returned is below a fifth of the same, or the
/// limit on the number of advances was met. It never is too large: a missed collision is no
/// outcome.
///
/// Additive conservative advancement as in [li2021]: at each t the closest points give a direction
/// u, and the separation of the two simplices along u, min u . a_i(t) - max u . b_j(t), bounds
/// their distance from below for all later times too. That it is linear in t for each two corners
/// gives the next t; the advances add up. (The bound by speeds alone would need many advances for
/// what slides along at a small gap.)

/// The part of the gap at the start that is always left.
inline constexpr double kGapKept = 0.1;

/// A motion may be stopped where a gap is below this part of that at the start.
inline constexpr double kGapReached = 2 * kGapKept;

/// How much room a motion has to leave.
struct Clearance {
    double separation = 0;  ///< m, >= 0: a distance that is never reached.
    double distance =
        std::numeric_limits<double>::infinity();  ///< m, > 0: gaps beyond do not matter.
};

/// Where two simplices of K + L = Dim + 1 corners may go. 0 where they already are within
/// Clearance::separation. Rounding in distances is about 1e-15 of the coordinates: gaps have to be
/// well above that; not checked.
///
/// @param first_motion, second_motion  Of each corner, from t = 0 to 1, m.
/// @param limit                        Results above it are of no interest and returned as it.
template <int Dim, int K, int L>
[[nodiscard]] double safe_fraction(const Corners<Dim, K>& first,
                                   const Corners<Dim, K>& first_motion,
                                   const Corners<Dim, L>& second,
                                   const Corners<Dim, L>& second_motion,
                                   const Clearance& clearance = {},
                                   double limit = 1);

/// The same for a point and an obstacle: its signed distance changes no faster than the point
/// moves, and is concave along a line where the free side is convex (half-space and cavity).
template <int Dim>
[[nodiscard]] double safe_fraction(const ObstacleShape<Dim>& obstacle,
                                   const Vector<Dim>& point,
                                   const Vector<Dim>& motion,
                                   const Clearance& clearance = {},
                                   double limit = 1);

}  // namespace pent::contact
