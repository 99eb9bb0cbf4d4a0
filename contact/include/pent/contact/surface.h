#pragma once

#include <pent/contact/box_tree.h>
#include <pent/simplex_mesh.h>

#include <cstdint>
#include <span>
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

/// Outward normal of a facet: length (Dim - 1)! times its area, so zero where it has collapsed.
///
/// @param corners  In the outward order.
template <int Dim>
[[nodiscard]] Vector<Dim> facet_normal(const Corners<Dim, Dim>& corners);

/// Unit outward normals at surface.vertices, Dim x vertices: the area-weighted mean of the facets
/// there; zero where they cancel. Parallel.
template <int Dim>
[[nodiscard]] Positions<Dim> vertex_normals(const Surface<Dim>& surface,
                                            const PositionsView<Dim>& positions);

/// Boxes around simplices at given positions, within `margin` (m). Parallel.
template <int Dim, int Count>
[[nodiscard]] std::vector<Box> boxes_around(const Simplices<Count>& simplices,
                                            const PositionsView<Dim>& positions,
                                            double margin);

/// How many times the surface goes round a point: 1 inside, 0 outside, more where the body overlaps
/// itself, and less where it is inside out. A point on the surface counts with either side.
///
/// Counts, with sign, the facets that a ray along an axis crosses. Which facet a ray crosses at a
/// common face is decided by one exact rule for all facets of the face (a symbolic shift of
/// the point [edelsbrunner1990]), so that none is counted twice or missed, on lattices either.
///
/// @param facets  Tree over boxes that hold the surface's facets, in their order.
template <int Dim>
[[nodiscard]] int winding_number(const Surface<Dim>& surface,
                                 const BoxTree& facets,
                                 const PositionsView<Dim>& positions,
                                 const Vector<Dim>& point);

}  // namespace pent::contact
