#pragma once

#include "lattice_stuffing.h"
#include "star_mesh.h"

#include <pent/mesher/solid.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace pent::mesher {

/// A mesh whose boundary vertices know on which pieces of a solid's surface they lie.
struct SurfaceMesh {
    const Solid* solid = nullptr;
    double scale = 1;  ///< Of the smallest cells, m.
    StarMesh mesh;
    std::vector<std::vector<int>> pieces;  ///< One a vertex: ascending; none inside.
    std::vector<std::uint8_t> sizes;       ///< One a vertex: cells there are 2^this times as large.

    /// The best that could be had of bringing a boundary simplex to a ridge.
    struct Attempt {
        std::vector<std::uint32_t> changes;  ///< StarMesh::change() of its corners then.
        double best = 0;  ///< Mean ratio of the worst cell, at best; 0 where there is no ridge.
    };

    /// Of simplices that sharpen() has left as they were.
    std::map<std::vector<std::uint32_t>, Attempt> attempts = {};

    /// Of vertices for which smooth() has found nothing better: StarMesh::change() then.
    std::vector<std::uint32_t> settled = {};

    /// Of the cells at a vertex, m.
    [[nodiscard]] double scale_at(std::uint32_t vertex) const {
        return std::ldexp(scale, sizes[vertex]);
    }
};

[[nodiscard]] SurfaceMesh on_surface(const Solid& solid, double scale, StuffedMesh stuffed);

/// Where a vertex may go: anywhere if it is inside; along the pieces that it lies on to the point
/// nearest to a place on all of them, if the solid's surface is there.
[[nodiscard]] std::optional<Eigen::Vector4d> slide(const SurfaceMesh& surface,
                                                   std::uint32_t vertex,
                                                   const Eigen::Vector4d& place);

/// Brings edges and corners of the mesh to where pieces meet at an angle. A boundary simplex
/// without a piece common to its vertices crosses a ridge: a vertex of it moves there, or a new
/// one splits it, whichever leaves the better cells. One stays as it is where either would leave
/// cells too flat.
///
/// Returns how many boundary simplices still cross ridges.
std::int64_t sharpen(SurfaceMesh& surface, double least_quality);

/// Moves vertices until the cells around the worst ones are better; those on the surface along
/// it, those on ridges along these.
/// @param target  Cells of this mean ratio are good enough.
void relax(SurfaceMesh& surface, double target);

/// Moves vertices of cells along ridges to where the cells around each are better on the mean,
/// along what they lie on as relax() does. The worst cell around a vertex does not become worse,
/// unless it stays above `least`, which is the same in all calls for a surface.
void smooth(SurfaceMesh& surface, double least);

}  // namespace pent::mesher
