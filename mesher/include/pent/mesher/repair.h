#pragma once

#include <pent/mesher/step_limits.h>
#include <pent/mesher/surface_check.h>

#include <cstdint>
#include <string>

namespace pent::mesher {

/// How far mending a surface may go.
enum class Repair {
    None,   ///< A surface that is not clean is refused.
    Light,  ///< Drop, stitch, fill holes, unite, cut out self-intersections; keeps what is sound.
    Wrap,   ///< A new surface around the old one, which any input allows.
    Auto,   ///< Nothing if it is clean; else light; wrap if that is not enough.
};

struct RepairOptions {
    Repair repair = Repair::Auto;
    /// Largest distance from the wrap to the surface, over the diagonal of the bounding box.
    double wrap_distance = 0.01;
    StepLimits limits = {};  ///< For each of: filling holes, cutting, uniting, a wrap.
};

/// A surface that bounds a body, and what it took to get there.
struct Repaired {
    Surface surface;
    Repair used = Repair::None;  ///< None, Light or Wrap.
    SurfaceReport before;
    SurfaceReport after;  ///< Clean.
    /// From points of the new surface to the old one, m; sampled at the new one's points, edges and
    /// centers of triangles. For a wrap, the old one has its holes filled.
    double distance = 0;
    std::string failures;  ///< Of steps that were tried in vain, one line; empty if none failed.
};

/// Makes a clean surface of one that may not be.
///
/// Throws an Error if all points lie in a plane (there is nothing to fill), if the diagonal is not
/// within 1e-30 to 1e30 m, if the surface is not clean and may not be mended, or if the means
/// allowed do not suffice.
[[nodiscard]] Repaired repair(const Surface& surface, const RepairOptions& options = {});

/// "none", "light", "wrap" or "auto".
[[nodiscard]] std::string name_of(Repair repair);

}  // namespace pent::mesher
