#pragma once

#include <pent/simplex_mesh.h>
#include <pent/simulator/mesh_share.h>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// How far every vertex of a mesh is from some of them by ways within the mesh, m; infinite where
/// there is none. Of ranks each knows it of the corners of its own cells, wherever ways lead.
///
/// Every vertex has the least of what waves through the facets opposite to it, in its cells, bring
/// it: the distance at a point of a facet, linear between its corners, and the straight line from
/// there [bornemann2006], here by the plane waves of [kimmel1998] in cells of any dimension. That
/// has one solution, in whatever order vertices are taken. Fast marching takes them in increasing
/// order of their distances; one whose distance falls after it was taken, as it may where angles
/// are obtuse, or by what another rank has found, is taken again, until nothing falls.
///
/// @param sources  At least one, on all ranks the same.
template <int Dim>
[[nodiscard]] Eigen::VectorXd distance_within(const MeshShare<Dim>& share,
                                              const std::vector<std::uint32_t>& sources);

/// The gradient of a function that is linear in a cell, given at its corners, 1/m of its unit.
template <int Dim>
[[nodiscard]] Eigen::Matrix<double, Dim, 1> gradient_in_cell(const SimplexMesh<Dim>& mesh,
                                                             Eigen::Index cell,
                                                             const Eigen::VectorXd& values);

}  // namespace pent::simulator
