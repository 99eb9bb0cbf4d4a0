#pragma once

#include <pent/mesher/size_field.h>
#include <pent/mesher/solid.h>
#include <pent/simplex_mesh.h>

#include <Eigen/Core>

#include <cstdint>
#include <limits>

namespace pent::mesher {

/// Walls and gaps that are thinner than the edges across them: such a wall has holes or is not
/// there, such a gap is closed. Both sides of one are seen from the two ends of an edge, to first
/// order; what is curved within an edge may be missed.
struct ThinParts {
    std::int64_t edges = 0;  ///< Of the lattice, with a whole wall or gap between their ends.
    double width = std::numeric_limits<double>::infinity();  ///< Of the thinnest, m.
    Eigen::Vector4d place = Eigen::Vector4d::Zero();         ///< Near the thinnest, m.
};

/// A solid as a mesh, and what it took.
struct StuffedSolid {
    SimplexMesh<4> mesh;
    std::int64_t moved_back = 0;  ///< Lattice points whose move onto the surface was undone.
    std::int64_t beveled = 0;  ///< Edges, triangles and tetrahedra of the boundary that still cross
                               ///< a ridge, since cells would have become too flat.
    ThinParts thin_parts;
};

/// Fills a solid with pentachora by stuffing a lattice of congruent ones [labelle2007].
///
/// Inside, all cells are those of the lattice A4* (but between sizes, see below). Lattice points
/// near the surface move onto it, and of the simplices that the surface still cuts then the parts
/// inside are kept, see cut_simplex(). Where the boundary is not a manifold, moves are undone;
/// without any it always is one. Then boundary simplices that cross ridges are bent or split so
/// that they follow them, and vertices of the worst cells move, those on the surface along it. All
/// boundary vertices lie on the surface to 1e-6 edges.
///
/// The same bytes at any number of threads.
/// @param edge_length  Mean length of the edges inside, m, above 0; where they are shortest.
/// @param sizes        How much longer they may be elsewhere: by powers of two, by one between
///                     cells that touch, with the pieces of halved_simplices() between. Half of the
///                     thinnest primitive is the longest, whatever is allowed.
/// Throws an Error for a solid that is empty, without bounds, thinner than an edge, or too large
/// for such edges.
[[nodiscard]] StuffedSolid stuff(const Solid& solid,
                                 double edge_length,
                                 const SizeField& sizes = {});

/// About how many cells stuff() gives, without the work: by how many of 16^4 points are inside.
/// Throws as stuff() does for edges that the solid's parts are too thin for, and for one without
/// bounds.
[[nodiscard]] double estimate_cells(const Solid& solid,
                                    double edge_length,
                                    const SizeField& sizes = {});

}  // namespace pent::mesher
