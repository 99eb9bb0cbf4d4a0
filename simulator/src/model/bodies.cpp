#include "model/bodies.h"

#include "model/append_bodies.h"
#include "model/part_bodies.h"
#include "model/rotation.h"

#include <pent/counted.h>
#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <cmath>

namespace pent::simulator {

// A rank has all cells of its own vertices: it finds the masses of these, and tells the others.
template <int Dim>
void lump_masses(const Scene& scene, Bodies<Dim>& bodies) {
    Eigen::Matrix<double, 1, Eigen::Dynamic> masses =
        Eigen::Matrix<double, 1, Eigen::Dynamic>::Zero(bodies.vertex_count());
    for (const CellRange& range : bodies.ranges) {
        const Lame& lame = range.material.lame;
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
            const double volume = cell_volume<Dim>(bodies.rest(), bodies.cells(), cell);
            const double share = range.material.density * volume / (Dim + 1);
            if (bodies.sharing.owns(bodies.cells()(0, cell))) {
                bodies.large_energy += (lame.mu + std::abs(lame.lambda)) * volume;
            }
            for (int corner = 0; corner <= Dim; ++corner) {
                masses[bodies.cells()(corner, cell)] += share;
            }
        }
    }
    bodies.sharing.gather(masses);
    bodies.large_energy = bodies.sharing.sum(bodies.large_energy);
    bodies.masses = masses.transpose();
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        for (Eigen::Index v = bodies.first_vertex[body]; v < bodies.first_vertex[body + 1]; ++v) {
            if (!(bodies.masses[v] > 0)) {
                throw Error(scene.bodies[body].mesh + ": vertex "
                            + std::to_string(v - bodies.first_vertex[body]) + " belongs to no "
                            + std::string(cell_name(Dim)) + "; expected every vertex to have mass");
            }
        }
    }
}

template <int Dim>
Columns number_columns(const std::vector<SimplexMesh<Dim>>& meshes) {
    Columns all;
    std::size_t count = 0;
    for (const SimplexMesh<Dim>& mesh : meshes) {
        count += static_cast<std::size_t>(mesh.vertex_count());
    }
    all.columns.reserve(count);
    all.layers.reserve(count);
    std::uint32_t next = 0;
    for (const SimplexMesh<Dim>& mesh : meshes) {
        const auto vertices = static_cast<std::uint32_t>(mesh.vertex_count());
        const bool has_columns = !mesh.columns.empty();
        std::vector<std::uint32_t> sorted = mesh.columns;
        std::sort(sorted.begin(), sorted.end());
        sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
        for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
            std::uint32_t column = vertex;
            if (has_columns) {  // labels are free to have gaps
                const auto at =
                    std::lower_bound(sorted.begin(), sorted.end(), mesh.columns[vertex]);
                column = static_cast<std::uint32_t>(at - sorted.begin());
            }
            all.columns.push_back(next + column);
            all.layers.push_back(mesh.layers.empty() ? vertex : mesh.layers[vertex]);
        }
        next += has_columns ? static_cast<std::uint32_t>(sorted.size()) : vertices;
    }
    return all;
}

template <int Dim>
void check_meshes(const Scene& scene, std::size_t meshes) {
    check(scene);
    if (scene.dimension != Dim) {
        throw Error("the scene has dimension " + std::to_string(scene.dimension) + "; expected "
                    + std::to_string(Dim));
    }
    if (meshes != scene.bodies.size()) {
        throw Error("the scene has " + counted(scene.bodies.size(), "body", "bodies") + "; got "
                    + counted(meshes, "mesh", "meshes"));
    }
}

template <int Dim>
Bodies<Dim> make_bodies(const Scene& scene, std::vector<SimplexMesh<Dim>> meshes) {
    check_meshes<Dim>(scene, meshes.size());
    Bodies<Dim> bodies;
    bodies.meshes = std::move(meshes);
    append_bodies(scene, bodies);
    lump_masses(scene, bodies);
    return bodies;
}

template <int Dim>
typename Bodies<Dim>::Range Bodies<Dim>::elements_of(std::size_t body) const {
    if (quadratic.nodes.cols() == 0) {
        return cells_of(body);
    }
    Range all{-1, 0};
    for (const CellRange& range : quadratic.ranges) {
        if (range.body == body) {
            all.begin = all.begin < 0 ? range.begin : all.begin;
            all.size = range.end - all.begin;
        }
    }
    return all;
}

template <int Dim>
std::size_t Bodies<Dim>::body_of(std::uint32_t vertex) const {
    const auto after = std::upper_bound(first_vertex.begin(), first_vertex.end(), vertex);
    return static_cast<std::size_t>(after - first_vertex.begin()) - 1;
}

template <int Dim>
Positions<Dim> start_velocities(const Scene& scene, const Bodies<Dim>& bodies) {
    Positions<Dim> velocities = Positions<Dim>::Zero(Dim, bodies.vertex_count());
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        const Eigen::Index first = bodies.first_vertex[body];
        const Eigen::Index count = bodies.first_vertex[body + 1] - first;
        const auto rest = bodies.rest().middleCols(first, count);
        const auto masses = bodies.masses.segment(first, count);
        const Vector<Dim> center = rest * masses / masses.sum();
        const Motion motion{
            .translate = Vector<Dim>::Zero(), .rotate = scene.bodies[body].spin, .about = {}};
        velocities.middleCols(first, count) =
            pose_at<Dim>(motion, 0).rate * (rest.colwise() - center);
        if (scene.bodies[body].velocity.size() > 0) {
            const Vector<Dim> velocity = scene.bodies[body].velocity;
            velocities.middleCols(first, count).colwise() += velocity;
        }
    }
    return velocities;
}

#define PENT_INSTANTIATE(Dim)                                                           \
    template struct Bodies<Dim>;                                                        \
    template Columns number_columns<Dim>(const std::vector<SimplexMesh<Dim>>&);         \
    template void check_meshes<Dim>(const Scene&, std::size_t);                         \
    template Bodies<Dim> make_bodies<Dim>(const Scene&, std::vector<SimplexMesh<Dim>>); \
    template void lump_masses<Dim>(const Scene&, Bodies<Dim>&);                         \
    template Positions<Dim> start_velocities<Dim>(const Scene&, const Bodies<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
