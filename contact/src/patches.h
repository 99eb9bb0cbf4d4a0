#pragma once

#include "patch_partition.h"
#include "paths.h"

#include <pent/contact/surface.h>

#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace pent::contact {

/// Where a patch of a surface is.
template <int Dim>
struct PatchPlace {
    Vector<Dim> center = Vector<Dim>::Zero();
    Eigen::Matrix<double, Dim, Dim> map = Eigen::Matrix<double, Dim, Dim>::Zero();
};

/// How a patch of a surface has moved from rest, on straight paths from one place to another. A
/// point X of its simplices is at
///
///     center + map (X - rest_center) + d,   |d| <= deviation
///
/// with a center and a map that change evenly from those at the start to those at the end.
template <int Dim>
struct PatchMotion {
    Vector<Dim> rest_center = Vector<Dim>::Zero();
    double least_stretch = 0;  ///< No singular value of the map is less at any time.
    double radius = 0;         ///< Farthest that |X - rest_center| gets, m.
    double deviation = std::numeric_limits<double>::infinity();  ///< m; infinite where not known.
    bool is_still = true;                                        ///< Then only the end counts.
    PatchPlace<Dim> end;
    PatchPlace<Dim> start;
};

/// How near a point of one and a point of another patch can be at any time, from how far they are
/// apart at rest.
///
/// With G the mean of both maps, x - y is G (X - Y), which is no shorter than the rest distance
/// times the least stretch of G, and what the maps and centers lack to agree with G. That is
/// convex in time: most at one of its ends.
struct PatchBound {
    double stretch = 0;
    double lack = std::numeric_limits<double>::infinity();  ///< m.

    /// Whether points so far apart at rest (m), or farther, are certainly more than `distance`
    /// apart now. Never true where something is not finite.
    [[nodiscard]] bool is_apart(double rest_distance, double distance) const {
        return stretch > 0 && stretch * rest_distance - lack > distance;
    }
};

template <int Dim>
[[nodiscard]] PatchBound bound_of(const PatchMotion<Dim>& first, const PatchMotion<Dim>& second);

/// How each patch of a surface has moved.
template <int Dim>
class Patches {
public:
    Patches() = default;

    /// Fits nothing yet.
    ///
    /// @param partition  Of the simplices.
    /// @param rest       Rest positions of all vertices of the scene.
    template <int Count>
    Patches(const Simplices<Count>& simplices,
            const PatchPartition& partition,
            const PositionsView<Dim>& rest);

    /// The patches of the others, from other positions that count as at rest.
    Patches(const Patches& others, const PositionsView<Dim>& rest);

    /// Finds the motion of each patch: the affine maps that fit its vertices best. Parallel.
    void fit(const Paths<Dim>& paths);

    /// Of each; empty if there are no patches.
    [[nodiscard]] const std::vector<PatchMotion<Dim>>& motions() const { return motions_; }

    [[nodiscard]] std::int64_t bytes() const;

private:
    // Which vertices each patch has.
    struct Vertices {
        std::vector<std::size_t> begin;  // of each patch, and one more
        std::vector<std::uint32_t> of_patch;

        [[nodiscard]] std::span<const std::uint32_t> of(std::size_t patch) const {
            return std::span(of_patch).subspan(begin[patch], begin[patch + 1] - begin[patch]);
        }
    };

    // What a patch is at rest.
    struct Rest {
        bool is_flat = false;  // across axes.col(0) there is nothing to fit to
        Eigen::Matrix<double, Dim, Dim> axes = Eigen::Matrix<double, Dim, Dim>::Zero();
        // map = (sum of (position - center) (rest - rest_center)^T over the vertices) inverse
        Eigen::Matrix<double, Dim, Dim> inverse = Eigen::Matrix<double, Dim, Dim>::Zero();
    };

    void set_rest(const PositionsView<Dim>& rest);
    [[nodiscard]] Rest rest_of(std::size_t patch, PatchMotion<Dim>& motion) const;
    [[nodiscard]] PatchMotion<Dim> fit(std::size_t patch, const Paths<Dim>& paths) const;
    [[nodiscard]] PatchPlace<Dim> place(std::size_t patch,
                                        const PositionsView<Dim>& positions,
                                        double& deviation) const;

    std::shared_ptr<const Vertices> vertices_;
    Positions<Dim> rest_positions_;
    std::vector<Rest> patches_;
    std::vector<PatchMotion<Dim>> motions_;
};

}  // namespace pent::contact
