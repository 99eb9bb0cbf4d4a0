#pragma once

#include "motion_lanes.h"
#include "patch_bound.h"
#include "patch_vertices.h"

#include <pent/contact/surface.h>

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace pent::contact {

/// Where a patch of a surface is: a point X of its simplices is near center + map (X - its center
/// at rest).
template <int Dim>
struct PatchPlace {
    Vector<Dim> center = Vector<Dim>::Zero();
    Eigen::Matrix<double, Dim, Dim> map = Eigen::Matrix<double, Dim, Dim>::Zero();
};

/// Where all patches of a surface are at some moment.
template <int Dim>
struct PatchPlaces {
    std::vector<PatchPlace<Dim>> of_patch;
    Positions<Dim> vertices;  ///< Of the patches, one patch behind the other, m.

    [[nodiscard]] std::int64_t bytes() const {
        return static_cast<std::int64_t>(of_patch.size() * sizeof(PatchPlace<Dim>)
                                         + static_cast<std::size_t>(vertices.size())
                                               * sizeof(double));
    }
};

/// How a patch of a surface has moved since an earlier moment, on straight paths from one place to
/// another. A point X of its simplices is at
///
///     center + map (X - earlier_center) + d,   |d| <= deviation
///
/// with a center and a map that change evenly from those at the start to those at the end.
template <int Dim>
struct PatchMotion {
    Vector<Dim> earlier_center = Vector<Dim>::Zero();
    double least_stretch = 0;  ///< No singular value of the map is less at any time.
    double radius = 0;         ///< Farthest that |X - earlier_center| gets, m.
    double deviation = std::numeric_limits<double>::infinity();  ///< m; infinite where not known.
    bool is_still = true;                                        ///< Then only the end counts.
    PatchPlace<Dim> end;
    PatchPlace<Dim> start;
};

/// How all patches of a surface have moved, for bounds of many pairs.
template <int Dim>
class PatchMotions {
public:
    PatchMotions() = default;
    explicit PatchMotions(const std::vector<PatchMotion<Dim>>& motions);

    /// Writes the bound of a patch and of each of some patches of others, which have moved at the
    /// same time, to the begin of `bounds`.
    void bound(std::size_t patch,
               const PatchMotions& others,
               std::span<const std::uint32_t> which,
               std::span<PatchBound> bounds) const;

    [[nodiscard]] std::int64_t bytes() const {
        return static_cast<std::int64_t>(numbers_.size() * sizeof(double));
    }

private:
    [[nodiscard]] MotionRows rows() const { return {numbers_.data(), places_}; }

    int places_ = 1;
    std::vector<double> numbers_;
};

/// How the patches of a surface move.
template <int Dim>
class Patches {
public:
    Patches() = default;

    /// @param rest  Rest positions of all vertices of the scene.
    Patches(const PatchVertices& vertices, const PositionsView<Dim>& rest);

    [[nodiscard]] std::size_t size() const { return rest_.size(); }

    /// The place of each patch: the affine map that fits its vertices best. Parallel.
    [[nodiscard]] PatchPlaces<Dim> place(const PositionsView<Dim>& positions) const;

    /// How each has moved since an earlier moment. Parallel.
    [[nodiscard]] std::vector<PatchMotion<Dim>> motions(const PatchPlaces<Dim>& earlier,
                                                        const PatchPlaces<Dim>& now) const;

    /// The same for paths from a place to another.
    [[nodiscard]] std::vector<PatchMotion<Dim>> motions(const PatchPlaces<Dim>& earlier,
                                                        const PatchPlaces<Dim>& start,
                                                        const PatchPlaces<Dim>& end) const;

    [[nodiscard]] std::int64_t bytes() const;

private:
    // A patch at rest.
    struct Rest {
        bool is_flat = false;  // across axes.col(0) there is nothing to fit to
        Eigen::Matrix<double, Dim, Dim> axes = Eigen::Matrix<double, Dim, Dim>::Zero();
        // map = (sum of (position - center) offset^T over the vertices) inverse
        Eigen::Matrix<double, Dim, Dim> inverse = Eigen::Matrix<double, Dim, Dim>::Zero();
    };

    // The vertices of one patch, of those of all.
    template <typename Vertices>
    [[nodiscard]] auto own(Vertices& of_all, std::size_t patch) const {
        return of_all.middleCols(static_cast<Eigen::Index>(begin_[patch]),
                                 static_cast<Eigen::Index>(begin_[patch + 1] - begin_[patch]));
    }
    void gather(std::size_t patch,
                const PositionsView<Dim>& positions,
                Eigen::Ref<Positions<Dim>> vertices) const;
    [[nodiscard]] static Rest rest_of(const PositionsView<Dim>& offsets);
    [[nodiscard]] PatchPlace<Dim> place(std::size_t patch,
                                        const PositionsView<Dim>& vertices) const;
    void begin(std::size_t patch, const PatchPlaces<Dim>& earlier, PatchMotion<Dim>& motion) const;
    [[nodiscard]] PatchPlace<Dim> move(std::size_t patch,
                                       const PatchPlaces<Dim>& earlier,
                                       const PatchPlaces<Dim>& now,
                                       PatchMotion<Dim>& motion) const;

    std::vector<std::size_t> begin_;       // of the vertices of each patch, and one more
    std::vector<std::uint32_t> vertices_;  // of all patches
    Positions<Dim> offsets_;               // of these from the centers of patches, at rest
    std::vector<Rest> rest_;
};

}  // namespace pent::contact
