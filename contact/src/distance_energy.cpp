#include "pent/contact/distance_energy.h"

#include <cmath>
#include <limits>

namespace pent::contact {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

bool is_fading(double d, const DistanceEnergy& energy) {
    return energy.law == DistanceLaw::FadingPenalty && d < 0;
}

// Whether a penalty is 0.
bool is_beyond(double d, const DistanceEnergy& energy) {
    return d >= energy.distance
           || (energy.law == DistanceLaw::FadingPenalty && d <= -energy.distance);
}

bool is_barrier(const DistanceEnergy& energy) {
    return energy.law == DistanceLaw::Barrier;
}

bool is_touching(double d, const DistanceEnergy& barrier) {
    return !(d > barrier.separation);
}

double scaled_gap_squared(double d, const DistanceEnergy& barrier) {
    const double scaled = (d - barrier.separation) / barrier.distance;
    return scaled * scaled;
}

// Derivatives of -(y - 1)^2 ln y.
double by_y(double y) {
    return -(y - 1) * (2 * std::log(y) + (y - 1) / y);
}

double by_y_twice(double y) {
    return -2 * std::log(y) + (y - 1) * (y - 1 - 4 * y) / (y * y);
}

double barrier_value(double d, const DistanceEnergy& barrier) {
    const double y = scaled_gap_squared(d, barrier);
    if (is_touching(d, barrier)) {
        return kInfinite;
    }
    return y >= 1 ? 0
                  : -barrier.stiffness * barrier.distance * barrier.distance * (y - 1) * (y - 1)
                        * std::log(y);
}

double barrier_slope(double d, const DistanceEnergy& barrier) {
    const double y = scaled_gap_squared(d, barrier);
    if (is_touching(d, barrier)) {
        return -kInfinite;
    }
    return y >= 1 ? 0 : 2 * barrier.stiffness * (d - barrier.separation) * by_y(y);
}

double barrier_curvature(double d, const DistanceEnergy& barrier) {
    const double y = scaled_gap_squared(d, barrier);
    if (is_touching(d, barrier)) {
        return kInfinite;
    }
    return y >= 1 ? 0 : barrier.stiffness * (2 * by_y(y) + 4 * y * by_y_twice(y));
}

}  // namespace

double DistanceEnergy::value(double d) const {
    if (is_barrier(*this)) {
        return barrier_value(d, *this);
    }
    if (is_beyond(d, *this)) {
        return 0;
    }
    if (is_fading(d, *this)) {
        return stiffness
               * (distance * distance - 2 * distance * d + d * d + 4 * d * d * d / (3 * distance));
    }
    return stiffness * (d - distance) * (d - distance);
}

double DistanceEnergy::slope(double d) const {
    if (is_barrier(*this)) {
        return barrier_slope(d, *this);
    }
    if (is_beyond(d, *this)) {
        return 0;
    }
    if (is_fading(d, *this)) {
        return -2 * stiffness * (distance + d) * (distance - 2 * d) / distance;
    }
    return 2 * stiffness * (d - distance);
}

double DistanceEnergy::curvature(double d) const {
    if (is_barrier(*this)) {
        return barrier_curvature(d, *this);
    }
    if (is_beyond(d, *this)) {
        return 0;
    }
    return is_fading(d, *this) ? 2 * stiffness * (1 + 4 * d / distance) : 2 * stiffness;
}

}  // namespace pent::contact
