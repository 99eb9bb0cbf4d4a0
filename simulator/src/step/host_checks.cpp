#include "step/host_checks.h"

#include "model/rotation.h"

#include <pent/counted.h>
#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/formatted.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pent::simulator {

namespace {

std::string place_of(std::int64_t index, std::int64_t count) {
    return std::to_string(index) + " of " + std::to_string(count);
}

// How far the sum of barycentric coordinates may be from 1, by rounding.
constexpr double kRounding = 1e-9;

}  // namespace

template <int Dim>
void check_body(int body, const Bodies<Dim>& bodies) {
    const auto count = static_cast<int>(bodies.count());
    if (body < 0 || body >= count) {
        throw Error("body " + place_of(body, count) + "; count from 0");
    }
}

template <int Dim>
void check_vertices(int body,
                    const std::vector<std::uint32_t>& vertices,
                    const Bodies<Dim>& bodies) {
    check_body(body, bodies);
    const Eigen::Index count = bodies.vertices(static_cast<std::size_t>(body)).size;
    std::vector<bool> is_seen(static_cast<std::size_t>(count), false);
    for (const std::uint32_t vertex : vertices) {
        if (vertex >= count) {
            throw Error("vertex " + place_of(vertex, count) + " of body " + std::to_string(body)
                        + "; count from 0");
        }
        if (is_seen[vertex]) {
            throw Error("vertex " + std::to_string(vertex) + " is in the list twice");
        }
        is_seen[vertex] = true;
    }
}

template <int Dim>
void check_array(const std::string& what,
                 const Positions<Dim>& array,
                 Eigen::Index count,
                 const std::vector<std::uint32_t>& vertices) {
    if (array.cols() != count) {
        throw Error(what + " were given for " + counted(array.cols(), "vertex", "vertices")
                    + "; expected " + std::to_string(Dim) + " numbers for each of "
                    + std::to_string(count));
    }
    for (Eigen::Index i = 0; i < array.size(); ++i) {
        const double number = array.data()[i];
        if (!std::isfinite(number)) {
            const Eigen::Index column = i / Dim;
            throw Error(what + formatted(": found %g for ", number) + "xyzw"[i % Dim]
                        + " of vertex "
                        + std::to_string(
                            vertices.empty() ? column : vertices[static_cast<std::size_t>(column)])
                        + "; expected finite numbers");
        }
    }
}

template <int Dim>
void check_grab(const Grab<Dim>& grab, const Bodies<Dim>& bodies) {
    const BodyPoint<Dim>& point = grab.point;
    check_body(point.body, bodies);
    const Eigen::Index cells = bodies.meshes[static_cast<std::size_t>(point.body)].cell_count();
    if (point.cell < 0 || point.cell >= cells) {
        throw Error("cell " + place_of(point.cell, cells) + " of body " + std::to_string(point.body)
                    + "; count from 0");
    }
    if (!(std::abs(point.weights.sum() - 1) <= kRounding
          && point.weights.minCoeff() >= -kRounding)) {
        throw Error("barycentric coordinates of a grab have the sum "
                    + formatted("%.10g", point.weights.sum())
                    + formatted(" and the least is %.3g", point.weights.minCoeff())
                    + "; expected numbers from 0 to 1 with the sum 1");
    }
    if (!grab.anchor.allFinite()) {
        throw Error("the anchor of a grab must be finite");
    }
    const double most = grab.max_force.value_or(1);
    if (!(std::isfinite(grab.stiffness) && grab.stiffness > 0 && std::isfinite(grab.damping)
          && grab.damping >= 0 && std::isfinite(most) && most > 0)) {
        throw Error("a grab has the " + formatted("stiffness %.3g, ", grab.stiffness)
                    + formatted("damping %.3g ", grab.damping)
                    + formatted("and max_force %.3g", most)
                    + "; expected finite numbers, > 0 (damping >= 0)");
    }
}

template <int Dim>
void check_host(const HostState<Dim>& host, const Bodies<Dim>& bodies) {
    if (!host.gravity.value_or(Vector<Dim>::Zero()).allFinite()) {
        throw Error("gravity must be finite");
    }
    check_array<Dim>("forces", host.forces, host.forces.cols() == 0 ? 0 : bodies.vertex_count());
    check_array<Dim>("targets", host.targets, static_cast<Eigen::Index>(host.held.size()),
                     host.held);
    const auto is_not_after = [](auto a, auto b) { return a >= b; };
    if (std::adjacent_find(host.held.begin(), host.held.end(), is_not_after) != host.held.end()
        || (!host.held.empty() && host.held.back() >= bodies.vertex_count())) {
        throw Error("vertices that a host holds must increase and be below "
                    + std::to_string(bodies.vertex_count()));
    }
    std::uint64_t next = 1;
    for (const auto& [id, grab, from] : host.grabs) {
        check_grab(grab, bodies);
        if (id < next || id >= host.next_grab || !from.allFinite() || !grab.max_force) {
            throw Error(
                "grab " + std::to_string(id)
                + " is not one that a snapshot can have; expected numbers that increase from "
                + std::to_string(next) + " to " + std::to_string(host.next_grab - 1)
                + ", finite anchors, and a max_force");
        }
        next = id + 1;
    }
}

#define PENT_INSTANTIATE(Dim)                                                                 \
    template void check_body(int, const Bodies<Dim>&);                                        \
    template void check_vertices(int, const std::vector<std::uint32_t>&, const Bodies<Dim>&); \
    template void check_array<Dim>(const std::string&, const Positions<Dim>&, Eigen::Index,   \
                                   const std::vector<std::uint32_t>&);                        \
    template void check_grab(const Grab<Dim>&, const Bodies<Dim>&);                           \
    template void check_host(const HostState<Dim>&, const Bodies<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
