#pragma once

#include "linear/line_allocator.h"
#include "linear/rigid_mode_order.h"

#include <Eigen/Core>

#include <vector>

namespace pent::simulator {

/// The lever arm of a child: where it lies in its aggregate. Dim + 1 numbers without padding.
template <int Dim>
struct Arm {
    /// From the centroid of the aggregate, in units of its size.
    Eigen::Matrix<double, Dim, 1, Eigen::DontAlign> x;
    double ratio;  ///< Size of the child in units of that of the aggregate.
};

/// Contiguous, as kernels read them.
template <int Dim>
using Arms = std::vector<Arm<Dim>, LineAllocator<Arm<Dim>>>;

/// The prolongation from an aggregate to one of its children, T: Rows x modes. The unknowns of the
/// child are the Dim coordinates of a vertex, or the modes of an aggregate of the next finer level,
/// which then moves rigidly with this one.
template <int Dim, int Rows>
struct RigidModes {
    static_assert(Rows == Dim || Rows == kModes<Dim>);
    using Child = Eigen::Matrix<double, Rows, 1>;
    using Modes = Eigen::Matrix<double, kModes<Dim>, 1>;

    /// Restriction, T^T r: forces on the child, as forces and moments on the aggregate.
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

    /// Prolongation, T c: how the child moves with the aggregate.
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
