#pragma once

#include <pent/simplex_mesh.h>
#include <pent/simulator/scene.h>

namespace pent::simulator::bench {

/// The plain way to do what the kernels do, for a ratio: closed formulas, general-purpose dense and
/// sparse algebra, one thread, double.

/// Energy gradients of all cells: stress of the stable neo-Hookean energy times rest gradients.
///
/// @return  4 x vertices, N.
[[nodiscard]] Positions<4> oracle_forces(const SimplexMesh<4>& mesh,
                                         const Material& material,
                                         const Positions<4>& positions);

/// The 16 x 16 Hessian of the energy density in F, its negative eigenvalues clamped by a dense
/// eigensolver, and carried over to the 20 coordinates of the cell; for the first `count` cells.
///
/// @return  Sum over all matrices of their norms, so that nothing is optimized away.
[[nodiscard]] double oracle_hessians(const SimplexMesh<4>& mesh,
                                     const Material& material,
                                     const Positions<4>& positions,
                                     Eigen::Index count);

/// One linear implicit Euler step of a body held at x = 0: dense projected Hessians, a sparse
/// matrix from triplets, sparse LDL^T.
///
/// @return  Displacements, 4 x vertices, m.
[[nodiscard]] Positions<4> oracle_step(const SimplexMesh<4>& mesh,
                                       const Material& material,
                                       const Eigen::Vector4d& gravity,
                                       double h);

}  // namespace pent::simulator::bench
