#pragma once

#include "lanes.h"
#include "patch_lanes.h"
#include "patch_partition.h"
#include "patch_vertices.h"
#include "paths.h"

#include <pent/contact/box_tree.h>
#include <pent/contact/surface.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace pent::contact {

/// The simplices of one kind in patches, and where these go on some paths.
template <int Dim>
struct PatchesOnPaths {
    PatchPartition partition;
    PatchVertices vertices;
    std::vector<Box> around;        ///< The paths of each patch.
    BoxTree tree;                   ///< Over these, in the order of patches.
    std::vector<double> inflation;  ///< How far a vertex of each may leave its path, m.
    PatchLanes<Dim> at_start;       ///< Of the paths.
    PatchLanes<Dim> at_end;         ///< Not set where paths are still.
};

/// The simplices of one surface, of each kind in patches of neighbors at rest, and where they go on
/// some paths: what a search for near pairs needs to know, patch against patch.
template <int Dim>
class SurfacePatches {
public:
    /// Parallel.
    ///
    /// @param rest  Of all vertices of the scene.
    SurfacePatches(const Surface<Dim>& surface, const PositionsView<Dim>& rest);

    /// Fits boxes to paths. Parallel.
    ///
    /// @param of_vertex  Boxes around all that is to be near each vertex; read for those of the
    ///                   surface.
    void fit(const Paths<Dim>& paths, const std::vector<Box>& of_vertex);

    /// Sets where simplices are at the ends of paths. Parallel.
    void set_lanes(const Paths<Dim>& paths);

    /// The patches of the simplices with that many corners.
    template <int Count>
    [[nodiscard]] const PatchesOnPaths<Dim>& of() const {
        return kinds_[Count - 1];
    }

    /// Trees fit so far.
    [[nodiscard]] std::int64_t refit() const { return refit_; }
    [[nodiscard]] std::int64_t bytes() const;

private:
    std::array<PatchesOnPaths<Dim>, Dim> kinds_;
    std::int64_t refit_ = 0;
};

/// One of them.
template <int Dim>
struct PatchOnPaths {
    const PatchesOnPaths<Dim>& all;
    std::size_t place;

    [[nodiscard]] std::span<const std::uint32_t> members() const { return all.partition[place]; }
    [[nodiscard]] LanesView at_start() const { return all.at_start.of(place, all.vertices); }
    [[nodiscard]] LanesView at_end(bool is_still) const {
        return is_still ? at_start() : all.at_end.of(place, all.vertices);
    }
};

/// Calls visit(i, j) for the pairs of simplices of two patches without a common vertex that may be
/// nearer than a distance at some time, none of which that are is left out. Of a patch with itself
/// each pair once.
///
/// @param is_still  Where paths start, in place of along them.
/// @param distance  With what their vertices may leave their paths by, m.
template <int Dim, int K, typename Visit>
void for_each_near(const PatchOnPaths<Dim>& first,
                   const PatchOnPaths<Dim>& second,
                   bool is_still,
                   double distance,
                   const Visit& visit) {
    std::array<std::uint16_t, kLanes> near;
    const LanesOnPaths patches{first.at_start(), first.at_end(is_still), second.at_start(),
                               second.at_end(is_still)};
    if (!lanes_kernels<Dim>().template find_near<K>()(patches, distance, near.data())) {
        return;
    }
    const std::span<const std::uint32_t> of_first = first.members();
    const std::span<const std::uint32_t> of_second = second.members();
    const bool is_one = &first.all == &second.all && first.place == second.place;
    for (std::size_t i = 0; i < of_first.size(); ++i) {
        unsigned bits = near[i];
        if (is_one) {
            bits &= ~0U << (i + 1);
        }
        for (; bits != 0; bits &= bits - 1) {
            visit(of_first[i], of_second[static_cast<std::size_t>(std::countr_zero(bits))]);
        }
    }
}

}  // namespace pent::contact
