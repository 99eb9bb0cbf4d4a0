#pragma once

#include <cstdint>

namespace pent::contact {

/// How an energy of a distance d grows; all are 0 from `distance` = eps on, with their slopes.
enum class DistanceLaw : std::uint8_t {
    /// k (d - eps)^2 at any depth: outside [shi2025] Eq. 24, which drops to no force at depth eps;
    /// here the force grows on linearly.
    Penalty,
    /// The same outside. Inside, k (eps^2 - 2 eps d + d^2 + 4 d^3 / (3 eps)) down to d = -eps, for
    /// pairs that only tell a crossing while it is shallow: the force 2 k (eps + d)(eps - 2 d) /
    /// eps is largest, 2.25 k eps, at d = -eps / 4. Where it has faded out, at d = -eps, the
    /// energy, 8/3 k eps^2, is let go: a jump to 0, with no force.
    FadingPenalty,
    /// -k eps^2 (y - 1)^2 ln y with y = (gap / eps)^2 and gap = d - separation, for 0 < gap < eps:
    /// twice continuously differentiable, infinite where gap <= 0. Source: [li2020] Eq. 6, scaled
    /// so that k is a stiffness; separation as in [li2021].
    Barrier,
};

/// An energy of a signed distance d: positive outside, negative inside. Value and slope of
/// penalties are continuous, at d = 0 the curvature is too.
struct DistanceEnergy {
    DistanceLaw law = DistanceLaw::Penalty;
    double distance = 0;   ///< eps, m, > 0: the gap at which it begins.
    double stiffness = 0;  ///< k, N/m, > 0.
    double separation =
        0;  ///< m, >= 0: what a barrier never lets be reached; not read by penalties.

    [[nodiscard]] double value(double d) const;      ///< J.
    [[nodiscard]] double slope(double d) const;      ///< J/m, <= 0.
    [[nodiscard]] double curvature(double d) const;  ///< J/m^2.
};

}  // namespace pent::contact
