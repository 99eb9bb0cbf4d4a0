#pragma once

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <string_view>
#include <vector>

namespace pent::viewer {

/// The closed boundary of a mesh, made once per body: what every slice of every frame is cut from.
template <int Dim>
struct Boundary {
    static constexpr int kFacetEdges = Dim * (Dim - 1) / 2;

    /// Outward: for n out of the body, det[n, t1 - t0, ..., t(Dim-1) - t0] > 0.
    Simplices<Dim> facets;

    /// The edges of the facets, each once, lower vertex first, in lexicographic order.
    Simplices<2> edges;

    /// Per facet its edges, for corners in the order 01 02 .. 12 ..: an index into `edges`.
    Eigen::Matrix<std::uint32_t, kFacetEdges, Eigen::Dynamic> facet_edges;

    /// The facets at vertex v are vertex_facets[vertex_begin[v] .. vertex_begin[v + 1]), ascending.
    std::vector<std::uint32_t> vertex_begin;
    std::vector<std::uint32_t> vertex_facets;
};

/// Finds the boundary of a valid mesh, in linear time.
///
/// Throws an Error that begins with `name` where cells do not fit together: such a body has no
/// inside, and its slices would have holes.
template <int Dim>
[[nodiscard]] Boundary<Dim> make_boundary(const SimplexMesh<Dim>& mesh, std::string_view name);

/// The same for facets found elsewhere.
///
/// @param vertices  Number of vertices; indices are below it, not checked.
template <int Dim>
[[nodiscard]] Boundary<Dim> index_boundary(Simplices<Dim> facets, Eigen::Index vertices);

}  // namespace pent::viewer
