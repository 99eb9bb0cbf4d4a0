#pragma once

#include <pent/contact/stencil.h>
#include <pent/simplex_mesh.h>

#include <cstdint>
#include <vector>

namespace pent::contact {

/// Positions of the vertices of a scene or of a body, Dim x n, m.
template <int Dim>
using PositionsView = Eigen::Ref<const Positions<Dim>>;

/// The boundary of a body, and the faces of it that can touch something.
///
/// Indices are those of the scene's vertices (the mesh's plus an offset). Corners of edges and
/// ridges ascend, and edges and ridges are in ascending order of their corners.
template <int Dim>
struct Surface {
    std::uint32_t first_vertex = 0;  ///< What the mesh's indices were raised by.
    Simplices<1> vertices;           ///< 1 x vertices, ascending.
    Simplices<2> edges;              ///< 2 x edges.
    Simplices<Dim - 1>
        ridges;             ///< (Dim - 1) x ridges: faces of facets, which are edges again in R^3.
    Simplices<Dim> facets;  ///< Dim x facets, outward; see match_facets().

    /// Facets at the i-th of `vertices`: facet_of[facet_begin[i] .. facet_begin[i + 1]), ascending.
    std::vector<std::uint32_t> facet_begin;
    std::vector<std::uint32_t> facet_of;

    /// Vertices, edges, ridges or facets: those with so many corners.
    template <int Count>
    [[nodiscard]] const Simplices<Count>& simplices() const {
        if constexpr (Count == 1) {
            return vertices;
        } else if constexpr (Count == 2) {
            return edges;
        } else if constexpr (Count == Dim) {
            return facets;
        } else {
            return ridges;
        }
    }

    [[nodiscard]] std::int64_t bytes() const {
        return static_cast<std::int64_t>(sizeof(std::uint32_t))
               * (vertices.size() + edges.size() + ridges.size() + facets.size()
                  + static_cast<std::int64_t>(facet_begin.size() + facet_of.size()));
    }
};

/// Finds the boundary of a body.
///
/// @param cells         Of the body's mesh, indices from 0.
/// @param vertices      Vertices of the mesh.
/// @param first_vertex  What to add to the mesh's indices.
template <int Dim>
[[nodiscard]] Surface<Dim> make_surface(const Simplices<Dim + 1>& cells,
                                        Eigen::Index vertices,
                                        std::uint32_t first_vertex = 0);

/// Mean length of the edges of a surface, m; 0 without edges.
template <int Dim>
[[nodiscard]] double mean_edge_length(const Surface<Dim>& surface,
                                      const PositionsView<Dim>& positions);

}  // namespace pent::contact
