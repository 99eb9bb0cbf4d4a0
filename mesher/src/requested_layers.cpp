#include "requested_layers.h"

#include "layer_places.h"

#include <pent/error.h>
#include <pent/mesher/profile.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
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

// What the layers that are listed sum to, or else a share of the base.
double default_thickness(const ExtrusionRequest& request, double largest_side) {
    if (request.layer_heights.empty()) {
        return 0.2 * largest_side;
    }
    const double sum =
        std::accumulate(request.layer_heights.begin(), request.layer_heights.end(), 0.0);
    return request.anchor == Anchor::Middle ? 2 * sum : sum;
}

// Where w = 0 divides the extrusion.
double slice_of(const ExtrusionRequest& request) {
    if (!request.profile.empty()) {
        return slice_on_path(read_profile(request.profile));
    }
    return request.round || request.anchor == Anchor::Middle ? 0.5 : 0;
}

int slabs_of_length(const ExtrusionRequest& request, double length, double edge) {
    if (!request.profile.empty() && length == 0) {
        throw Error(request.profile.string()
                    + ": its layers have one middle, so that no number of layers along w suits"
                      " them; list all of them in the file");
    }
    return request.grade == 1 ? automatic_slabs(length, edge)
                              : graded_slabs(0.7 * edge / length, request.grade, slice_of(request));
}

std::vector<double> requested_places(const ExtrusionRequest& request,
                                     double length,
                                     double edge,
                                     int least_slabs = 1) {
    const double slice = slice_of(request);
    if (!request.layer_heights.empty()) {
        return listed_places(request.layer_heights, slice);
    }
    const int slabs = request.layers > 0 ? request.layers : slabs_of_length(request, length, edge);
    return graded_places(std::max(slabs, least_slabs), request.grade, slice);
}

std::vector<Layer<4>> profile_layers(const ExtrusionRequest& request, const BaseSize& base) {
    std::vector<Layer<4>> layers = read_profile(request.profile);
    if (request.layers == 0 && request.grade == 1 && request.layer_heights.empty()) {
        return layers;
    }
    std::vector<double> places = requested_places(request, path_length(layers), base.edge);
    for (double& place : places) {
        place += slice_on_path(layers);
    }
    try {
        return relayer(layers, places);
    } catch (const Error& error) {
        throw Error(request.profile.string() + ": " + error.what());
    }
}

std::optional<Layers<4>> curved_layers(const ExtrusionRequest& request, const BaseSize& base) {
    if (!request.profile.empty()) {
        return Layers<4>{profile_layers(request, base)};
    }
    if (!request.round) {
        return std::nullopt;
    }
    return Layers<4>{round_layers(
        round_height(request, base.largest_side) / 2,
        requested_places(request, extrusion_length(request, base.largest_side), base.edge, 2))};
}

}  // namespace

double extrusion_length(const ExtrusionRequest& request, double largest_side) {
    if (!request.profile.empty()) {
        return path_length(read_profile(request.profile));
    }
    return request.round ? std::numbers::pi / 2 * std::abs(round_height(request, largest_side))
                         : extrusion_direction<4>(request, largest_side).norm();
}

bool has_automatic_layers(const ExtrusionRequest& request) {
    return request.layers == 0 && request.layer_heights.empty()
           && (request.profile.empty() || request.grade != 1);
}

int suitable_slabs(const ExtrusionRequest& request, double largest_side, double edge) {
    return slabs_of_length(request, extrusion_length(request, largest_side), edge);
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
        direction[Dim - 1] = request.thickness.value_or(default_thickness(request, largest_side));
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
    return {straight_layers<Dim>(direction, requested_places(request, direction.norm(), base.edge)),
            base.volume * std::abs(direction[Dim - 1])};
}

template Eigen::Vector3d extrusion_direction<3>(const ExtrusionRequest&, double);
template Eigen::Vector4d extrusion_direction<4>(const ExtrusionRequest&, double);
template Layers<3> requested_layers<3>(const ExtrusionRequest&, const BaseSize&);
template Layers<4> requested_layers<4>(const ExtrusionRequest&, const BaseSize&);

}  // namespace pent::mesher
