#pragma once

#include <Eigen/Core>

namespace pent::simulator {

/// The rigid modes of an aggregate: Dim translations, then for each plane p < q the rotation
/// e_q x_p - e_p x_q about its middle, x in units of its size.
template <int Dim>
inline constexpr int kModes = Dim*(Dim + 1) / 2;

/// Where a child lies in its aggregate.
template <int Dim>
struct Arm {
    Eigen::Matrix<double, Dim, 1> x;  ///< From the middle of the aggregate, in units of its size.
    double ratio = 0;                 ///< Size of the child in units of that of the aggregate.
};

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
        for_each_plane([&](int p, int q, int k) {
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
        for_each_plane([&](int p, int q, int k) {
            child[q] += c[k] * arm.x[p];
            child[p] -= c[k] * arm.x[q];
            if constexpr (Rows > Dim) {
                child[k] = c[k] * arm.ratio;
            }
        });
        return child;
    }

private:
    // Calls visit(p, q, k): rotation of axis p to axis q is mode k.
    template <typename Visit>
    static void for_each_plane(const Visit& visit) {
        int k = Dim;
#pragma GCC unroll 4
        for (int p = 0; p < Dim; ++p) {
#pragma GCC unroll 4
            for (int q = p + 1; q < Dim; ++q, ++k) {
                visit(p, q, k);
            }
        }
    }
};

}  // namespace pent::simulator
