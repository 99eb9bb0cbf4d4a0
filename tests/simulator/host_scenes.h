#pragma once

#include "contact_scenes.h"
#include "potential_laws.h"

#include <pent/simulator/picking.h>

#include <gtest/gtest.h>

#include <vector>

// What tests of a host share.

namespace pent::simulator::test {

inline constexpr Integrator kWithInertia[] = {Integrator::LinearEuler, Integrator::NewtonEuler,
                                              Integrator::Bdf2};

/// Expects the same state to the bit: positions, velocities, and who sleeps.
template <int Dim>
void expect_same(const Simulation<Dim>& a, const Simulation<Dim>& b) {
    ASSERT_EQ(a.body_count(), b.body_count());
    for (int body = 0; body < a.body_count(); ++body) {
        ASSERT_EQ(a.positions(body), b.positions(body)) << "body " << body;
        ASSERT_EQ(a.velocities(body), b.velocities(body)) << "body " << body;
    }
    EXPECT_EQ(a.sleep(), b.sleep());
}

/// A grab of the corner of a body that is farthest along the diagonal, where it is now.
template <int Dim>
Grab<Dim> corner(const Simulation<Dim>& simulation, int body, double stiffness = 1000) {
    const SimplexMesh<Dim>& mesh = simulation.mesh(body);
    Eigen::Index vertex = 0;
    mesh.positions.colwise().sum().maxCoeff(&vertex);
    Grab<Dim> grab;
    grab.stiffness = stiffness;
    grab.anchor = simulation.positions(body).col(vertex);
    grab.point.body = body;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        for (int i = 0; i <= Dim; ++i) {
            if (mesh.cells(i, cell) == vertex) {
                grab.point.cell = cell;
                grab.point.weights.setZero();
                grab.point.weights[i] = 1;
                return grab;
            }
        }
    }
    ADD_FAILURE() << "no cell has the vertex";
    return grab;
}

template <int Dim>
std::vector<std::uint32_t> all_vertices(const Simulation<Dim>& simulation, int body) {
    std::vector<std::uint32_t> all;
    for (std::uint32_t v = 0; v < simulation.mesh(body).vertex_count(); ++v) {
        all.push_back(v);
    }
    return all;
}

/// Vertices of a body at the low end along an axis, at rest.
template <int Dim>
std::vector<std::uint32_t> low_side(const Simulation<Dim>& simulation, int body, int axis = 0) {
    const auto& rest = simulation.mesh(body).positions;
    std::vector<std::uint32_t> side;
    for (const std::uint32_t v : all_vertices(simulation, body)) {
        if (rest(axis, v) < rest.row(axis).minCoeff() + 1e-6) {
            side.push_back(v);
        }
    }
    return side;
}

template <int Dim>
Positions<Dim> places_of(const Simulation<Dim>& simulation,
                         int body,
                         const std::vector<std::uint32_t>& vertices) {
    Positions<Dim> places(Dim, static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        places.col(static_cast<Eigen::Index>(i)) = simulation.positions(body).col(vertices[i]);
    }
    return places;
}

// A cube of 2 cells of 0.25 m, of steps of 10 ms, solved so tightly that only the method is in the
// result.
template <int Dim>
Scene floating_cube(Integrator integrator = Integrator::NewtonEuler) {
    Scene scene = test::box_scene<Dim>();
    scene.frames_per_second = 100;
    scene.solver.integrator = integrator;
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-12;
    scene.solver.newton_tolerance = 1e-9;
    return scene;
}

template <int Dim>
void take_step(Simulation<Dim>& simulation) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(report.is_accepted) << report.failure;
}

}  // namespace pent::simulator::test
