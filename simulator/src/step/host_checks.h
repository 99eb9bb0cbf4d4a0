#pragma once

#include "model/bodies.h"

#include <pent/simulator/host.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pent::simulator {

// What a host hands over is checked here, once. Each function throws an Error.

template <int Dim>
void check_body(int body, const Bodies<Dim>& bodies);

/// Vertices of a body, each once, in any order.
template <int Dim>
void check_vertices(int body,
                    const std::vector<std::uint32_t>& vertices,
                    const Bodies<Dim>& bodies);

/// An array for so many vertices, of finite numbers.
///
/// @param vertices  Which they are, for messages; empty for all from 0.
template <int Dim>
void check_array(const std::string& what,
                 const Positions<Dim>& array,
                 Eigen::Index count,
                 const std::vector<std::uint32_t>& vertices = {});

template <int Dim>
void check_grab(const Grab<Dim>& grab, const Bodies<Dim>& bodies);

template <int Dim>
void check_host(const HostState<Dim>& host, const Bodies<Dim>& bodies);

}  // namespace pent::simulator
