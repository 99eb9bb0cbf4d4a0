#pragma once

#include "parallel.h"
#include "rotation.h"
#include "world.h"

#include <pent/simulator/scene.h>

namespace pent::simulator {

/// Signed distance from the half-space at one point, with what the penalty makes of it.
///
/// For l < distance: energy stiffness (distance - l)^2, force 2 stiffness (distance - l) along the
/// normal, Hessian 2 stiffness n n^T; nothing beyond. All are continuous but the Hessian.
template <int Dim>
struct ObstacleContact {
    bool is_active = false;
    double energy = 0;     ///< J.
    Vector<Dim> force;     ///< N.
    double curvature = 0;  ///< Hessian = curvature n n^T, N/m.
};

template <int Dim>
[[nodiscard]] ObstacleContact<Dim> touch(const Obstacle& obstacle, const Vector<Dim>& point) {
    ObstacleContact<Dim> contact;
    const Vector<Dim> normal = obstacle.normal;
    const double gap = obstacle.distance - (normal.dot(point) - obstacle.offset);
    contact.force.setZero();
    if (gap > 0) {
        contact.is_active = true;
        contact.energy = obstacle.stiffness * gap * gap;
        contact.force = 2 * obstacle.stiffness * gap * normal;
        contact.curvature = 2 * obstacle.stiffness;
    }
    return contact;
}

}  // namespace pent::simulator
