#pragma once

#include <algorithm>
#include <limits>

namespace pent::contact {

/// A lower bound of the distance of a point of one patch from a point of another at any time, by
/// how far they were apart earlier: that times the stretch, less the lack.
///
/// With G the mean of the affine maps of both, x - y is G (X - Y), which is no shorter than the
/// earlier distance times the least stretch of G, plus what both maps and centers deviate from G.
/// That deviation is convex in time: largest at one of its ends.
struct PatchBound {
    double stretch = 0;
    double lack = std::numeric_limits<double>::infinity();  ///< m.

    /// Whether points that were so far apart (m), or farther, are certainly more than `distance`
    /// apart now. Never true where something is not finite.
    [[nodiscard]] bool is_apart(double earlier_distance, double distance) const {
        return stretch > 0 && stretch * earlier_distance - lack > distance;
    }

    /// The bound for both in a row: this one after an earlier one.
    [[nodiscard]] PatchBound after(const PatchBound& earlier) const {
        constexpr double kMaxStretch = 1e30;  // so that products stay finite
        return stretch > 0 && earlier.stretch > 0
                   ? PatchBound{std::min(stretch * earlier.stretch, kMaxStretch),
                                stretch * earlier.lack + lack}
                   : PatchBound{};
    }
};

}  // namespace pent::contact
