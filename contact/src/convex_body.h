#pragma once

#include "paths.h"

#include <pent/contact/surface.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace pent::contact {

/// Tells, for a body that is convex at rest or up to small dents, that it is nowhere near itself:
/// from its cells, in a fraction of what a search takes.
///
/// Let F be the deformation gradient of its cells from a convex reference, and R a rotation. If the
/// symmetric part of R^T F has no eigenvalue below c, the map is strongly monotone: x(a) - x(b)
/// along R (a - b) is at least c |a - b| for any two points a and b of the reference, since the
/// line between these runs within it [ciarlet1988]. So what is `gap` apart there is c gap apart,
/// however the body is turned and however much it is stretched. The least eigenvalue is concave
/// along straight paths of the vertices: what holds at both ends holds all the way.
template <int Dim>
class ConvexBody {
public:
    /// No value for a body that is not nearly convex, or nearer to itself than is of use.
    ///
    /// @param cells     Dim + 1 corners of each, of all cells of the body, positively oriented at
    ///                  rest. Must outlive this.
    /// @param rest      Of all vertices of the scene, m.
    /// @param distance  The least that will be asked for, m.
    [[nodiscard]] static std::optional<ConvexBody> make(std::span<const std::uint32_t> cells,
                                                        const PositionsView<Dim>& rest,
                                                        double distance);

    /// Whether all pairs of vertices and facets, and of edges and ridges, that share no vertex stay
    /// farther than a distance (m) apart on straight paths; false where this does not tell.
    /// Parallel.
    [[nodiscard]] bool stays_apart(const Paths<Dim>& paths, double distance) const;

    [[nodiscard]] std::int64_t bytes() const;

private:
    ConvexBody(std::span<const std::uint32_t> cells, Positions<Dim> reference, double gap);

    [[nodiscard]] Block<Dim> rotation(const Paths<Dim>& paths) const;
    [[nodiscard]] bool is_monotone(std::size_t cell,
                                   const Positions<Dim>& turned,
                                   const PositionsView<Dim>& positions,
                                   double least) const;

    std::span<const std::uint32_t> cells_;
    std::uint32_t first_vertex_;
    Positions<Dim> reference_;  // of the vertices of the body, m
    double gap_;                // the least between two simplices of it there, or less, m
};

}  // namespace pent::contact
