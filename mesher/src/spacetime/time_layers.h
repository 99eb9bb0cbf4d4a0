#pragma once

#include <pent/mesher/edge_order.h>
#include <pent/mesher/space_time.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace pent::mesher {

/// A layer of vertices: on the way from a frame to the next one.
struct TimeLayer {
    std::size_t frame = 0;
    double share = 0;  ///< Of the way, from 0 to below 1; 0 at the last frame.
};

/// Six times the volume of a tetrahedron whose corners move on straight ways from one place to
/// another, as a polynomial in Bernstein form: the coefficients of (1 - s)^3, 3 s (1 - s)^2,
/// 3 s^2 (1 - s) and s^3.
using VolumePolynomial = std::array<double, 4>;
[[nodiscard]] VolumePolynomial volume_on_the_way(const Eigen::Matrix<double, 3, 4>& from,
                                                 const Eigen::Matrix<double, 3, 4>& to);

/// The first s from 0 to 1 at which the polynomial is not above 0, to 2^-40; nothing if it is above
/// 0 everywhere.
[[nodiscard]] std::optional<double> first_inversion(const VolumePolynomial& volume);

/// Places of the vertices in a layer.
[[nodiscard]] Positions<3> positions_in(const MovingMesh& moving, const TimeLayer& layer);

/// The layers that make_space_time() needs, every one of the frames among them; which errors it
/// throws stands there.
[[nodiscard]] std::vector<TimeLayer> choose_layers(const MovingMesh& moving,
                                                   const OrderedCells<3>& ordered,
                                                   const SpaceTimeOptions& options);

}  // namespace pent::mesher
