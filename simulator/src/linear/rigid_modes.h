#pragma once

#include "linear/line_allocator.h"
#include "linear/rigid_mode_order.h"

#include <Eigen/Core>

#include <vector>

namespace pent::simulator {

/// Where a child lies in its aggregate: Dim + 1 numbers, without gaps.
template <int Dim>
struct Arm {
    /// From the middle of the aggregate, in units of its size.
    Eigen::Matrix<double, Dim, 1, Eigen::DontAlign> x;
    double ratio;  ///< Size of the child in units of that of the aggregate.
};

/// One after the other.
template <int Dim>
using Arms = std::vector<Arm<Dim>, LineAllocator<Arm<Dim>>>;

/// What the modes of an aggregate do to one of its children, T: Rows x modes. The unknowns of the
/// child are Dim coordinates of a vertex, or its own modes; the same motion either way.
template <int Dim, int Rows>
struct RigidModes {
    static_assert(Rows == Dim || Rows == kModes<Dim>);
    using Child = Eigen::Matrix<double, Rows, 1>;
    using Modes = Eigen::Matrix<double, kModes<Dim>, 1>;

    /// T^T r.
    static Modes force(const Child& r, const Arm<Dim>& arm) {
        Modes modes;
        modes.template head<Dim>() = r.template head<Dim>();
        for_each_plane<Dim>([&](int p, int q, int k) {
            modes[k] = arm.x[p] * r[q] - arm.x[q] * r[p];
            if constexpr (Rows > Dim) {
                modes[k] += arm.ratio * r[k];
            }
        });
        return modes;
    }

    /// T c.
    static Child motion(const Modes& c, const Arm<Dim>& arm) {
        Child child;
        child.template head<Dim>() = c.template head<Dim>();
        for_each_plane<Dim>([&](int p, int q, int k) {
            child[q] += c[k] * arm.x[p];
            child[p] -= c[k] * arm.x[q];
            if constexpr (Rows > Dim) {
                child[k] = c[k] * arm.ratio;
            }
        });
        return child;
    }
};

}  // namespace pent::simulator
