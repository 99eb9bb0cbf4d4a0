#include "model/bodies.h"

#include "model/rotation.h"

#include <pent/error.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pent::simulator {

namespace {

template <int Dim>
void append_bodies(const Scene& scene, Bodies<Dim>& bodies) {
    bodies.first_vertex.push_back(0);
    Eigen::Index cells = 0;
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        SimplexMesh<Dim>& mesh = bodies.meshes[body];
        mesh = place(std::move(mesh), scene.bodies[body]);
        bodies.first_vertex.push_back(bodies.first_vertex.back() + mesh.vertex_count());
        bodies.ranges.push_back({cells, cells + mesh.cell_count(), scene.bodies[body].material});
        cells += mesh.cell_count();
    }
    bodies.rest.resize(Dim, bodies.first_vertex.back());
    bodies.cells.resize(Dim + 1, cells);
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        const SimplexMesh<Dim>& mesh = bodies.meshes[body];
        const Eigen::Index first = bodies.first_vertex[body];
        bodies.rest.middleCols(first, mesh.vertex_count()) = mesh.positions;
        bodies.cells.middleCols(bodies.ranges[body].begin, mesh.cell_count()) =
            mesh.cells.array() + static_cast<std::uint32_t>(first);
    }
}

template <int Dim>
void lump_masses(const Scene& scene, Bodies<Dim>& bodies) {
    bodies.masses.setZero(bodies.vertex_count());
    for (const CellRange& range : bodies.ranges) {
        const Lame& lame = range.material.lame;
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
            const double volume = cell_volume<Dim>(bodies.rest, bodies.cells, cell);
            const double share = range.material.density * volume / (Dim + 1);
            bodies.large_energy += (lame.mu + std::abs(lame.lambda)) * volume;
            for (int corner = 0; corner <= Dim; ++corner) {
                bodies.masses[bodies.cells(corner, cell)] += share;
            }
        }
    }
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

// Marks what each constraint holds; returns which vertices have a given place.
template <int Dim>
std::vector<bool> mark_dirichlet(const Scene& scene, Bodies<Dim>& bodies) {
    std::vector<bool> is_dirichlet(static_cast<std::size_t>(bodies.vertex_count()), false);
    for (const Constraint& constraint : scene.constraints) {
        const std::uint32_t body = index_of(scene, constraint.body);
        DirichletSet<Dim> held;
        Vector<Dim> sum = Vector<Dim>::Zero();
        for (const std::uint32_t vertex : select_vertices(bodies.meshes[body], constraint)) {
            const auto global = static_cast<std::uint32_t>(vertex + bodies.first_vertex[body]);
            if (is_dirichlet[global]) {
                throw Error("vertex " + std::to_string(vertex) + " of body \"" + constraint.body
                            + "\" is selected by two constraints; make their selections disjoint");
            }
            is_dirichlet[global] = true;
            held.vertices.push_back(global);
            sum += bodies.rest.col(global);
        }
        const Vector<Dim> middle = sum / static_cast<double>(held.vertices.size());
        held.motions = center<Dim>(constraint.motion, middle);
        bodies.dirichlet_sets.push_back(std::move(held));
    }
    return is_dirichlet;
}

// A mesh without columns has one a vertex.
template <int Dim>
Columns number_columns(const Bodies<Dim>& bodies) {
    Columns all;
    std::uint32_t next = 0;
    for (const SimplexMesh<Dim>& mesh : bodies.meshes) {
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

}  // namespace

template <int Dim>
Bodies<Dim> make_bodies(const Scene& scene, std::vector<SimplexMesh<Dim>> meshes) {
    check(scene);
    if (scene.dimension != Dim) {
        throw Error("the scene has dimension " + std::to_string(scene.dimension) + "; expected "
                    + std::to_string(Dim));
    }
    if (meshes.size() != scene.bodies.size()) {
        throw Error("the scene has " + std::to_string(scene.bodies.size()) + " bodies; got "
                    + std::to_string(meshes.size()) + " meshes");
    }
    Bodies<Dim> bodies;
    bodies.meshes = std::move(meshes);
    append_bodies(scene, bodies);
    lump_masses(scene, bodies);
    bodies.is_dirichlet = mark_dirichlet(scene, bodies);
    bodies.columns = number_columns(bodies);
    return bodies;
}

template <int Dim>
std::size_t Bodies<Dim>::body_of(std::uint32_t vertex) const {
    const auto after = std::upper_bound(first_vertex.begin(), first_vertex.end(), vertex);
    return static_cast<std::size_t>(after - first_vertex.begin()) - 1;
}

template <int Dim>
bool Bodies<Dim>::is_kinematic(std::size_t body) const {
    return std::all_of(is_dirichlet.begin() + first_vertex[body],
                       is_dirichlet.begin() + first_vertex[body + 1],
                       [](bool is_given) { return is_given; });
}

template <int Dim>
DofMap number_dofs(const Bodies<Dim>& bodies, const std::vector<bool>& is_in) {
    std::vector<bool> is_fixed = bodies.is_dirichlet;
    for (std::size_t body = 0; body < is_in.size(); ++body) {
        if (!is_in[body]) {
            std::fill(is_fixed.begin() + bodies.first_vertex[body],
                      is_fixed.begin() + bodies.first_vertex[body + 1], true);
        }
    }
    return number_dofs<Dim>(bodies.cells, is_fixed, bodies.columns);
}

template <int Dim>
Positions<Dim> start_velocities(const Scene& scene, const Bodies<Dim>& bodies) {
    Positions<Dim> velocities = Positions<Dim>::Zero(Dim, bodies.vertex_count());
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        const Eigen::Index first = bodies.first_vertex[body];
        const Eigen::Index count = bodies.first_vertex[body + 1] - first;
        const auto rest = bodies.rest.middleCols(first, count);
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

template <int Dim>
void place_dirichlet(const Bodies<Dim>& bodies,
                     double time,
                     Positions<Dim>& positions,
                     Positions<Dim>* velocities) {
    for (const DirichletSet<Dim>& set : bodies.dirichlet_sets) {
        const MotionChain<Dim> chain(set.motions, time);
        for (const std::uint32_t vertex : set.vertices) {
            Vector<Dim> point = bodies.rest.col(vertex);
            Vector<Dim> velocity = Vector<Dim>::Zero();
            chain.move(point, velocities != nullptr ? &velocity : nullptr);
            positions.col(vertex) = point;
            if (velocities != nullptr) {
                velocities->col(vertex) = velocity;
            }
        }
    }
}

#define PENT_INSTANTIATE(Dim)                                                           \
    template struct Bodies<Dim>;                                                        \
    template Bodies<Dim> make_bodies<Dim>(const Scene&, std::vector<SimplexMesh<Dim>>); \
    template DofMap number_dofs<Dim>(const Bodies<Dim>&, const std::vector<bool>&);     \
    template Positions<Dim> start_velocities<Dim>(const Scene&, const Bodies<Dim>&);    \
    template void place_dirichlet<Dim>(const Bodies<Dim>&, double, Positions<Dim>&,     \
                                       Positions<Dim>*);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
