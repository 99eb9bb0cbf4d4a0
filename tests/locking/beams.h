#pragma once

#include "ritz_beam.h"

#include <pent/simplex_mesh.h>
#include <pent/simulator/solver_options.h>

#include <string>
#include <vector>

namespace pent::locking {

/// How far beams give way that are held at one end, of linear elasticity: what the laws of
/// locking_test.cpp judge and docs/accuracy.md shows.

/// What a beam is loaded by.
enum class Load { Bending, Diagonal, Twist };

/// How its mesh is made: of cubes cut alike, or with vertices moved off the grid by up to a quarter
/// of an edge, those of the surface within it; or by TetGen, with layers of its tetrahedra in 4D.
enum class Cut { Structured, Distorted, TetGen };

/// Poisson's ratios as parts of its limit in a dimension: in 4D 0, 0.28, 0.32, 0.33, 0.3333.
inline constexpr double kShares[] = {0, 0.84, 0.96, 0.99, 0.9999};

template <int Dim>
[[nodiscard]] BodyForce<Dim> body_force(Load load);

/// A beam [0, 4] x [0, 1]^(Dim - 1). Of an even number of cells across it has parents, which are
/// what is cut. TetGen's have two across: tetgen_beam.pent is what pent-mesh --dim 3 --generator
/// tetgen --edge-length 0.5 makes of the beam's surface.
/// @param cells  4 of TetGen's.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> beam(int cells, Cut cut);

/// Work of the load on what it makes of a beam, over that of a Ritz method of high order. The load
/// is distributed as linear cells would have it.
template <int Dim>
[[nodiscard]] double give(const SimplexMesh<Dim>& beam,
                          simulator::ElementKind elements,
                          double share,
                          Load load);

}  // namespace pent::locking
