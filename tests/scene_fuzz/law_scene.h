#pragma once

#include <pent/pent_file.h>
#include <pent/simulator/simulation.h>

#include <limits>
#include <vector>

// What several laws of physics need of a scene.

namespace pent::scene_fuzz {

using simulator::Body;
using simulator::Scene;
using simulator::Simulation;

inline constexpr double kForever = std::numeric_limits<double>::infinity();

template <int Dim>
std::vector<SimplexMesh<Dim>> read_meshes(const Scene& scene) {
    std::vector<SimplexMesh<Dim>> meshes;
    for (const Body& body : scene.bodies) {
        meshes.push_back(read_mesh<Dim>(body.mesh).mesh);
    }
    return meshes;
}

inline int step_count(const Scene& scene) {
    return scene.frames * scene.steps_per_frame;
}

// All bodies in one: what `part` gives of each.
template <int Dim, typename Part>
Positions<Dim> of_all(const Simulation<Dim>& simulation, const Part& part) {
    Positions<Dim> all(Dim, 0);
    for (int body = 0; body < simulation.body_count(); ++body) {
        const Positions<Dim> of_body = part(body);
        all.conservativeResize(Dim, all.cols() + of_body.cols());
        all.rightCols(of_body.cols()) = of_body;
    }
    return all;
}

template <int Dim>
double extent_of(const Simulation<Dim>& simulation) {
    const Positions<Dim> all = of_all(
        simulation, [&](int body) -> Positions<Dim> { return simulation.mesh(body).positions; });
    return (all.rowwise().maxCoeff() - all.rowwise().minCoeff()).norm();
}

// One of the two, by the dimension of a scene.
template <typename In3, typename In4>
void in_dimension(const Scene& scene, const In3& in_3, const In4& in_4) {
    if (scene.dimension == 3) {
        in_3();
    } else {
        in_4();
    }
}

}  // namespace pent::scene_fuzz
