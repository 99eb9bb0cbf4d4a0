#pragma once

#include "linear/hessian_stencil.h"
#include "model/rotation.h"

#include <pent/simplex_mesh.h>

#include <array>
#include <cstdint>

namespace pent::simulator {

/// How strong a spring is.
struct SpringLaw {
    double stiffness = 0;  ///< N/m.
    double damping = 0;    ///< N s/m.
};

/// A spring from a weighted sum of vertices to an anchor. With the stretch d = sum of w_i x_i -
/// anchor its energy is
///
///     k/2 |d|^2 + c / (2 rate) |u|^2,     u = d' = rate (d - d at the origin of the step),
///
/// a convex quadratic with the Hessian (k + c rate) w_i w_j I.
template <int Dim>
struct Spring {
    std::array<std::uint32_t, Dim + 2> vertices{};
    Eigen::Matrix<double, Dim + 2, 1> weights;
    std::int32_t count = 0;                      // in use
    Vector<Dim> anchor = Vector<Dim>::Zero();    // at the end of the step, m
    Vector<Dim> velocity = Vector<Dim>::Zero();  // of it there, m/s
    Vector<Dim> start = Vector<Dim>::Zero();     // u = rate (sum of w_i x_i) - start
    Vector<Dim> stretch = Vector<Dim>::Zero();   // d where last evaluated, m

    /// Adds one more vertex, unless its weight is 0.
    void add(std::uint32_t vertex, double weight) {
        if (weight != 0) {
            vertices[static_cast<std::size_t>(count)] = vertex;
            weights[count++] = weight;
        }
    }

    /// The weighted sum of vectors that are given for all vertices.
    [[nodiscard]] Vector<Dim> weighted_sum(const Positions<Dim>& x) const {
        Vector<Dim> sum = weights[0] * x.col(vertices[0]);
        for (std::int32_t i = 1; i < count; ++i) {
            sum += weights[i] * x.col(vertices[static_cast<std::size_t>(i)]);
        }
        return sum;
    }

    /// Sets what u is measured from at the start of a step.
    void begin_step(double rate, const Positions<Dim>& origin) {
        start = rate * weighted_sum(origin) + velocity;
    }

    struct Energy {
        double elastic = 0;  // J
        double damping = 0;
    };

    /// Returns the energy, and adds the gradient.
    ///
    /// @param rate  1/s; 0 outside of steps, where nothing is damped.
    Energy evaluate(const SpringLaw& law,
                    double rate,
                    const Positions<Dim>& x,
                    Positions<Dim>& gradient) {
        const Vector<Dim> sum = weighted_sum(x);
        stretch = sum - anchor;
        Vector<Dim> pull = law.stiffness * stretch;
        Energy energy{0.5 * pull.dot(stretch), 0};
        if (rate > 0 && law.damping > 0) {
            const Vector<Dim> u = rate * sum - start;
            pull += law.damping * u;
            energy.damping = 0.5 * law.damping / rate * u.squaredNorm();
        }
        add_pull(pull, gradient);
        return energy;
    }

    /// Adds the gradient of a force on the weighted sum, N.
    void add_pull(const Vector<Dim>& pull, Positions<Dim>& gradient) const {
        for (std::int32_t i = 0; i < count; ++i) {
            gradient.col(vertices[static_cast<std::size_t>(i)]) += weights[i] * pull;
        }
    }

    /// weight times w_i w_j K; K and this must last until the system is assembled.
    [[nodiscard]] HessianStencil stencil(double weight, const Matrix<Dim>& K) const {
        return {.vertices = vertices.data(),
                .weights = weights.data(),
                .numbers = K.data(),
                .count = count,
                .stride = Dim,
                .scale = weight,
                .is_checked = true};
    }
};

}  // namespace pent::simulator
