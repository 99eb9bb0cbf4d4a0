#pragma once

#include <pent/simplex_mesh.h>

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace pent::simulator {

/// A point of a body: it is wherever its cell has taken it.
template <int Dim>
struct BodyPoint {
    int body = 0;
    std::int64_t cell = 0;  ///< Of the body's mesh.
    Eigen::Matrix<double, Dim + 1, 1> weights =
        Eigen::Matrix<double, Dim + 1, 1>::Zero();  ///< Barycentric coordinates; their sum is 1.
};

/// A spring by which a host holds a point of a body and takes it along.
///
/// With the stretch d from the anchor to the point and u their relative velocity it pulls with
/// min(1, max_force / |stiffness d + damping u|) (stiffness d + damping u) at the start of a step:
/// never harder than max_force, however far away the anchor is. The factor is held through the
/// step, in which the energy is a convex quadratic.
template <int Dim>
struct Grab {
    BodyPoint<Dim> point;
    Eigen::Matrix<double, Dim, 1> anchor =
        Eigen::Matrix<double, Dim, 1>::Zero();  ///< m: where it is at the end of the next step.
    double stiffness = 1000;                    ///< N/m, > 0.
    double damping = 0;                         ///< N s/m, >= 0.
    /// N, > 0. Absent: what strains the cells around the point by about one, (2 mu + |lambda|)
    /// V^((Dim - 1) / Dim), V being their volume, each corner weighted as the point is. To pull a
    /// body harder take several grabs.
    std::optional<double> max_force = {};
};

/// What a host does to the bodies of a simulation, from one step to the next. It is part of a
/// Snapshot; one of a host that does nothing has nothing in it.
template <int Dim>
struct HostState {
    /// A grab that is there.
    struct Holding {
        std::uint64_t id = 0;  ///< Increasing; none is used twice.
        Grab<Dim> grab;        ///< With its max_force.
        Eigen::Matrix<double, Dim, 1> from = Eigen::Matrix<double, Dim, 1>::
            Zero();  ///< Its anchor at the start of the next step, m.
    };
    std::optional<Eigen::Matrix<double, Dim, 1>> gravity;  ///< m/s^2; absent: that of the scene.
    Positions<Dim> forces;  ///< Dim x vertices of all bodies, N; no columns without any.
    std::vector<Holding> grabs;
    std::uint64_t next_grab = 1;
    std::vector<std::uint32_t> held;  ///< Vertices of all bodies counted through, increasing.
    Positions<Dim> targets;           ///< Dim x held vertices: where they are to be, m.
};

}  // namespace pent::simulator
