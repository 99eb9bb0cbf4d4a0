#pragma once

#include "model/bodies.h"

#include <pent/simulator/host.h>

#include <vector>

namespace pent::simulator {

// What a host hands over is checked once, here. Each throws an Error.

template <int Dim>
void check_body(int body, const Bodies<Dim>& bodies);

/// Vertices of a body, each once, in any order.
template <int Dim>
void check_vertices(int body,
                    const std::vector<std::uint32_t>& vertices,
                    const Bodies<Dim>& bodies);

/// An array for so many vertices.
template <int Dim>
void check_array(const char* what, const Positions<Dim>& array, Eigen::Index count);

template <int Dim>
void check_grab(const Grab<Dim>& grab, const Bodies<Dim>& bodies);

template <int Dim>
void check_host(const HostState<Dim>& host, const Bodies<Dim>& bodies);

}  // namespace pent::simulator
