#pragma once

#include <pent/simplex_mesh.h>

#include <cstdint>
#include <string>

namespace pent::mesher {

/// What was verified about a mesh, with the figures.
struct Proof {
    std::int64_t cells = 0;
    std::int64_t interior_facets = 0;  ///< Shared by two cells, seen from opposite sides.
    std::int64_t boundary_facets = 0;
    std::int64_t faulty_facets = 0;  ///< Seen twice from one side, or shared by more than two.
    std::int64_t faulty_ridges = 0;  ///< Ridges (facets of the boundary's facets) that are not
                                     ///< shared by exactly two of these, from opposite sides.
    double volume = 0;               ///< Sum over the cells, m^Dim.
    double boundary_volume = 0;  ///< The same by the divergence theorem over the boundary, m^Dim.
    double expected_volume = 0;  ///< What the caller knows it must be, or boundary_volume.
    double tolerance = 0;        ///< Bound for the rounding in the differences of the three, m^Dim.

    /// Cells fit together, the boundary is closed and oriented, and the volumes agree.
    [[nodiscard]] bool holds() const;
};

/// Verifies that a mesh is conforming: every interior facet is shared by two cells that see it from
/// opposite sides; the boundary is a closed oriented pseudo-manifold; the volume is as expected.
///
/// The tolerance is 8 eps times the sum over cells of the product of the edges at their first
/// corner over Dim! (determinants), plus eps times cells times volume (the sum), plus 4 eps times
/// the largest coordinate times the boundary's measure (rounded positions).
///
/// @param mesh      Passes validate().
/// @param expected  Volume, m^Dim, by another way; 0 if there is none.
template <int Dim>
[[nodiscard]] Proof prove(const SimplexMesh<Dim>& mesh, double expected = 0);

/// What does not hold, in one line; empty if all does.
[[nodiscard]] std::string describe_faults(const Proof& proof, int dim);

}  // namespace pent::mesher
