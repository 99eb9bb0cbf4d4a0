#include "requested_layers.h"

#include <pent/error.h>
#include <pent/mesher/profile.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

namespace pent::mesher {

namespace {

double round_height(const ExtrusionRequest& request, double largest_side) {
    const double height = request.thickness.value_or(largest_side);
    if (!std::isfinite(height) || height == 0) {
        throw Error("a round body of height " + std::to_string(height)
                    + "; expected a finite number other than 0");
    }
    return height;
}

std::optional<Layers<4>> curved_layers(const ExtrusionRequest& request, const BaseSize& base) {
    if (!request.profile.empty()) {
        return Layers<4>{read_profile(request.profile)};
    }
    if (!request.round) {
        return std::nullopt;
    }
    const int slabs =
        request.layers > 0
            ? request.layers
            : automatic_slabs(extrusion_length(request, base.largest_side), base.edge);
    return Layers<4>{
        round_layers(round_height(request, base.largest_side) / 2, std::max(slabs, 2))};
}

}  // namespace

double extrusion_length(const ExtrusionRequest& request, double largest_side) {
    return request.round ? std::numbers::pi / 2 * std::abs(round_height(request, largest_side))
                         : extrusion_direction<4>(request, largest_side).norm();
}

template <int Dim>
Eigen::Matrix<double, Dim, 1> extrusion_direction(const ExtrusionRequest& request,
                                                  double largest_side) {
    Eigen::Matrix<double, Dim, 1> direction = Eigen::Matrix<double, Dim, 1>::Zero();
    if (request.direction) {
        if (request.direction->size() != Dim) {
            throw Error("an extrusion of " + std::to_string(request.direction->size())
                        + " components; expected " + std::to_string(Dim));
        }
        direction = *request.direction;
    } else {
        direction[Dim - 1] = request.thickness.value_or(0.2 * largest_side);
    }
    if (!direction.allFinite() || direction[Dim - 1] == 0) {
        throw Error("an extrusion by " + std::to_string(direction[Dim - 1]) + " along "
                    + "xyzw"[Dim - 1] + "; expected a finite number other than 0");
    }
    return direction;
}

template <int Dim>
Layers<Dim> requested_layers(const ExtrusionRequest& request, const BaseSize& base) {
    if constexpr (Dim == 4) {
        if (const auto curved = curved_layers(request, base)) {
            return *curved;
        }
    } else if (!request.profile.empty() || request.round) {
        throw Error("profiles and round bodies are for dimension 4");
    }
    const Eigen::Matrix<double, Dim, 1> direction =
        extrusion_direction<Dim>(request, base.largest_side);
    const int slabs =
        request.layers > 0 ? request.layers : automatic_slabs(direction.norm(), base.edge);
    return {straight_layers<Dim>(direction, slabs, request.anchor),
            base.volume * std::abs(direction[Dim - 1])};
}

template Eigen::Vector3d extrusion_direction<3>(const ExtrusionRequest&, double);
template Eigen::Vector4d extrusion_direction<4>(const ExtrusionRequest&, double);
template Layers<3> requested_layers<3>(const ExtrusionRequest&, const BaseSize&);
template Layers<4> requested_layers<4>(const ExtrusionRequest&, const BaseSize&);

}  // namespace pent::mesher
