#pragma once

#include "kernels/kernel_vertices.h"
#include "linear/block_kernels.h"
#include "linear/rigid_mode_order.h"

#include <cstddef>

// Restriction from vertices to the rigid modes of an aggregate, and prolongation back: the formulas
// are those of RigidModes.
//
// The moment in plane p < q is a sum over children of x_p r_q - x_q r_p. To work on whole vertices
// the sums of all x_p r are kept, and the differences taken once at the end.

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

template <int Dim, bool IsVectorized>
void sum_forces(const AggregateChildren& children, const double* r, double* modes) {
    using Vertex = typename VertexOf<Dim, IsVectorized>::Type;
    Vertex sum = {};
    Vertex turned[Dim] = {};  // sums of x_p r
    for (std::size_t i = 0; i < children.count; ++i) {
        const std::size_t child = children.members[i];
        const auto force = loaded<Vertex>(r + child * Dim);
        const double* x = children.arms + i * (Dim + 1);
        sum += force;
        for (int p = 0; p < Dim; ++p) {
            turned[p] += force * x[p];
        }
    }
    store(sum, modes);
    for_each_plane<Dim>([&](int p, int q, int k) { modes[k] = turned[p][q] - turned[q][p]; });
}

template <int Dim, bool IsVectorized>
void add_motions(const AggregateChildren& children, const double* modes, double* x) {
    using Vertex = typename VertexOf<Dim, IsVectorized>::Type;
    const auto shift = loaded<Vertex>(modes);
    Vertex turn[Dim] = {};  // turn[p]: the motion at x = e_p, the skew matrix by columns
    for_each_plane<Dim>([&](int p, int q, int k) {
        turn[p][q] = modes[k];
        turn[q][p] = -modes[k];
    });
    for (std::size_t i = 0; i < children.count; ++i) {
        const std::size_t child = children.members[i];
        const double* arm = children.arms + i * (Dim + 1);
        Vertex motion = shift;
        for (int p = 0; p < Dim; ++p) {
            motion += turn[p] * arm[p];
        }
        store(loaded<Vertex>(x + child * Dim) + motion, x + child * Dim);
    }
}

}  // namespace
}  // namespace pent::simulator
