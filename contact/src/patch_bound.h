#pragma once

#include <algorithm>
#include <limits>

namespace pent::contact {

/// How near a point of one and a point of another patch can be at any time, from how far they were
/// apart earlier: no nearer than that times the stretch, less the lack.
///
/// With G the mean of both maps, x - y is G (X - Y), which is no shorter than the earlier distance
/// times the least stretch of G, and what the maps and centers lack to agree with G. That is
/// convex in time: most at one of its ends.
struct PatchBound {
    double stretch = 0;
    double lack = std::numeric_limits<double>::infinity();  ///< m.

    /// Whether points that were so far apart (m), or farther, are certainly more than `distance`
    /// apart now. Never true where something is not finite.
    [[nodiscard]] bool is_apart(double earlier_distance, double distance) const {
        return stretch > 0 && stretch * earlier_distance - lack > distance;
    }

    /// What this tells of moments to which another bound has led.
    [[nodiscard]] PatchBound after(const PatchBound& earlier) const {
        constexpr double kMaxStretch = 1e30;  // so that products stay finite
        return stretch > 0 && earlier.stretch > 0
                   ? PatchBound{std::min(stretch * earlier.stretch, kMaxStretch),
                                stretch * earlier.lack + lack}
                   : PatchBound{};
    }
};

}  // namespace pent::contact
