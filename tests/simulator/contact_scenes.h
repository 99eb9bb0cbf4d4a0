#pragma once

#include "scenes.h"

#include <pent/simulator/simulation.h>

#include <cmath>

namespace pent::simulator::test {

/// A box of `cells` cells of 0.25 m along every axis.
template <int Dim>
SimplexMesh<Dim> cube(int cells = 2) {
    std::array<int, Dim> count{};
    std::array<double, Dim> size{};
    count.fill(cells);
    size.fill(0.25 * cells);
    return pent::test::kuhn_box<Dim>(count, size);
}

/// Bodies "a" and "b", b above a along y (both cubes of 0.5 m) by `gap` m, without gravity, that
/// see each other at 0.05 m. b is moved sideways a little, so that no vertex is above another.
template <int Dim>
Scene two_cubes(double gap) {
    Scene scene = box_scene<Dim>();
    scene.bodies.push_back(scene.bodies[0]);
    scene.bodies[0].name = "a";
    scene.bodies[1].name = "b";
    scene.bodies[1].place.translate.setConstant(0.04);
    scene.bodies[1].place.translate[1] = 0.5 + gap;
    scene.contact = ContactSettings{.distance = 0.05, .stiffness = 2e3};
    scene.frames_per_second = 100;
    return scene;
}

/// Gives all vertices of a body one velocity along y, m/s.
template <int Dim>
void throw_up(Simulation<Dim>& simulation, int body, double speed) {
    Positions<Dim> velocities = Positions<Dim>::Zero(Dim, simulation.mesh(body).vertex_count());
    velocities.row(1).setConstant(speed);
    simulation.set_state(body, simulation.positions(body), velocities);
}

/// Sum of mass times velocity of all bodies, kg m/s.
template <int Dim>
Eigen::Matrix<double, Dim, 1> momentum(const Simulation<Dim>& simulation) {
    Eigen::Matrix<double, Dim, 1> sum = Eigen::Matrix<double, Dim, 1>::Zero();
    for (int body = 0; body < simulation.body_count(); ++body) {
        sum += simulation.velocities(body) * simulation.masses(body);
    }
    return sum;
}

/// Velocity of the center of mass of a body, m/s.
template <int Dim>
Eigen::Matrix<double, Dim, 1> mean_velocity(const Simulation<Dim>& simulation, int body) {
    return simulation.velocities(body) * simulation.masses(body) / simulation.masses(body).sum();
}

}  // namespace pent::simulator::test
