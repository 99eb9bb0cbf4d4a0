#pragma once

#include <pent/pent_file.h>
#include <pent/simulator/simulation.h>

#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
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

// The same for a scene that is shrunk elsewhere than at its first mesh.
inline std::uint64_t seed_of(const Scene& scene) {
    const std::string mesh = scene.bodies.front().mesh;
    return std::accumulate(mesh.begin() + static_cast<std::ptrdiff_t>(mesh.rfind('/') + 1),
                           mesh.end(), std::uint64_t{1}, [](std::uint64_t seed, char letter) {
                               return 31 * seed + static_cast<unsigned char>(letter);
                           });
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
Positions<Dim> contact_forces_of(const Simulation<Dim>& simulation) {
    return of_all(simulation,
                  [&](int body) -> Positions<Dim> { return simulation.contact_forces(body); });
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
