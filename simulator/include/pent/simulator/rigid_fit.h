#pragma once

#include <pent/simplex_mesh.h>

namespace pent::simulator {

/// How far a body is from having moved rigidly: 0 for a rotation and translation of its start.
///
/// The mass-weighted RMS distance between `now` and the best-fitting rigid motion of `start`,
/// divided by the RMS distance of `start` from its centroid [kabsch1976].
///
/// @param masses  One a vertex, > 0.
template <int Dim>
[[nodiscard]] double non_rigid(const Eigen::Ref<const Positions<Dim>>& start,
                               const Eigen::Ref<const Positions<Dim>>& now,
                               const Eigen::Ref<const Eigen::VectorXd>& masses);

}  // namespace pent::simulator
