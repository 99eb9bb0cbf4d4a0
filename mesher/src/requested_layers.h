#pragma once

#include <pent/mesher/make_body.h>

#include <vector>

namespace pent::mesher {

/// What an extrusion needs to know of its base.
struct BaseSize {
    double largest_side = 0;  ///< Of the bounding box, m.
    double volume = 0;        ///< m^(Dim - 1).
    double edge = 0;          ///< Mean length, m.
};

template <int Dim>
[[nodiscard]] double largest_side(const Positions<Dim>& positions) {
    return (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).maxCoeff();
}

/// The whole straight extrusion that is asked for, m. Throws an Error unless it is finite and leads
/// out of the base.
template <int Dim>
[[nodiscard]] Eigen::Matrix<double, Dim, 1> extrusion_direction(const ExtrusionRequest& request,
                                                                double largest_side);

/// Whether the layers follow from the size of the cells, and not from the request alone.
[[nodiscard]] bool has_automatic_layers(const ExtrusionRequest& request);

/// How many slabs suit cells with edges of this length.
[[nodiscard]] int suitable_slabs(const ExtrusionRequest& request, double largest_side, double edge);

/// Along which length layers are counted, m: that of the extrusion, of half a meridian of a round
/// body, or of a profile's way. Throws an Error as extrusion_direction() does.
[[nodiscard]] double extrusion_length(const ExtrusionRequest& request, double largest_side);

/// The layers that are asked for, and what is known of the volume they enclose.
template <int Dim>
struct Layers {
    std::vector<Layer<Dim>> layers;
    double volume = 0;  ///< m^Dim, or 0 where it is not known.

    /// Cells over one of the base: a prism's for every slab, but one where an end is a point.
    [[nodiscard]] double cells_over() const {
        const int points = (layers.front().is_point() ? 1 : 0) + (layers.back().is_point() ? 1 : 0);
        return Dim * (static_cast<double>(layers.size()) - 1 - points) + points;
    }
};
template <int Dim>
[[nodiscard]] Layers<Dim> requested_layers(const ExtrusionRequest& request, const BaseSize& base);

}  // namespace pent::mesher
