#pragma once

#include <pent/simplex_mesh.h>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pent::simulator {

/// How far every vertex of a mesh is from some of them by ways within the mesh, m; infinite where
/// there is none.
///
/// By fast marching: vertices get their values in increasing order, each from the plane wave that
/// passes the corners of a cell that have theirs [kimmel1998], here in cells of any dimension.
///
/// @param sources  At least one.
template <int Dim>
[[nodiscard]] Eigen::VectorXd distance_within(const SimplexMesh<Dim>& mesh,
                                              const std::vector<std::uint32_t>& sources);

/// The gradient of a function that is linear in a cell, given at its corners, 1/m of its unit.
template <int Dim>
[[nodiscard]] Eigen::Matrix<double, Dim, 1> gradient_in_cell(const SimplexMesh<Dim>& mesh,
                                                             Eigen::Index cell,
                                                             const Eigen::VectorXd& values);

}  // namespace pent::simulator
