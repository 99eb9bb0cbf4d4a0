#include "world.h"

#include "rotation.h"
#include "selection.h"

#include <pent/error.h>

#include <algorithm>
#include <numeric>

namespace pent::simulator {

namespace {

template <int Dim>
void append_bodies(const Scene& scene, World<Dim>& world) {
    world.first_vertex.push_back(0);
    Eigen::Index cells = 0;
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        SimplexMesh<Dim>& mesh = world.meshes[body];
        mesh = place(std::move(mesh), scene.bodies[body]);
        world.first_vertex.push_back(world.first_vertex.back() + mesh.vertex_count());
        world.ranges.push_back({cells, cells + mesh.cell_count(), scene.bodies[body].material});
        cells += mesh.cell_count();
    }
    world.rest.resize(Dim, world.first_vertex.back());
    world.cells.resize(Dim + 1, cells);
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        const SimplexMesh<Dim>& mesh = world.meshes[body];
        const Eigen::Index first = world.first_vertex[body];
        world.rest.middleCols(first, mesh.vertex_count()) = mesh.positions;
        world.cells.middleCols(world.ranges[body].begin, mesh.cell_count()) =
            mesh.cells.array() + static_cast<std::uint32_t>(first);
    }
}

template <int Dim>
void lump_masses(const Scene& scene, World<Dim>& world) {
    world.masses.setZero(world.vertex_count());
    for (const CellRange& range : world.ranges) {
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
            const double share = range.material.density
                                 * cell_volume<Dim>(world.rest, world.cells, cell) / (Dim + 1);
            for (int corner = 0; corner <= Dim; ++corner) {
                world.masses[world.cells(corner, cell)] += share;
            }
        }
    }
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        for (Eigen::Index v = world.first_vertex[body]; v < world.first_vertex[body + 1]; ++v) {
            if (!(world.masses[v] > 0)) {
                throw Error(scene.bodies[body].mesh + ": vertex "
                            + std::to_string(v - world.first_vertex[body]) + " belongs to no "
                            + std::string(cell_name(Dim)) + "; expected every vertex to have mass");
            }
        }
    }
}

// Marks what each constraint holds; returns which vertices are held.
template <int Dim>
std::vector<bool> hold_vertices(const Scene& scene, World<Dim>& world) {
    std::vector<bool> is_held(static_cast<std::size_t>(world.vertex_count()), false);
    for (const Constraint& constraint : scene.constraints) {
        const auto found = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                        [&](const Body& b) { return b.name == constraint.body; });
        const auto body = static_cast<std::size_t>(found - scene.bodies.begin());
        HeldSet<Dim> held;
        held.motion = constraint.motion;
        held.about.setZero();
        for (const std::uint32_t vertex : select_vertices(world.meshes[body], constraint)) {
            const auto global = static_cast<std::uint32_t>(vertex + world.first_vertex[body]);
            if (is_held[global]) {
                throw Error("vertex " + std::to_string(vertex) + " of body \"" + constraint.body
                            + "\" is selected by two constraints; make their selections disjoint");
            }
            is_held[global] = true;
            held.vertices.push_back(global);
            held.about += world.rest.col(global);
        }
        held.about /= static_cast<double>(held.vertices.size());
        if (constraint.motion.about) {
            held.about = *constraint.motion.about;
        }
        world.held.push_back(std::move(held));
    }
    return is_held;
}

struct Columns {
    std::vector<std::uint32_t> columns;
    std::vector<std::uint32_t> layers;
};

// Extrusion columns of all bodies, numbered through; a mesh without them has one a vertex.
template <int Dim>
Columns number_columns(const World<Dim>& world) {
    Columns all;
    std::uint32_t next = 0;
    for (const SimplexMesh<Dim>& mesh : world.meshes) {
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
World<Dim> make_world(const Scene& scene, std::vector<SimplexMesh<Dim>> meshes) {
    check(scene);
    if (scene.dimension != Dim) {
        throw Error("the scene has dimension " + std::to_string(scene.dimension) + "; expected "
                    + std::to_string(Dim));
    }
    if (meshes.size() != scene.bodies.size()) {
        throw Error("the scene has " + std::to_string(scene.bodies.size()) + " bodies; got "
                    + std::to_string(meshes.size()) + " meshes");
    }
    World<Dim> world;
    world.meshes = std::move(meshes);
    append_bodies(scene, world);
    lump_masses(scene, world);
    const std::vector<bool> is_held = hold_vertices(scene, world);
    const Columns columns = number_columns(world);
    world.numbering = number_unknowns<Dim>(world.cells, is_held, columns.columns, columns.layers);
    return world;
}

template <int Dim>
void place_held(const World<Dim>& world,
                double time,
                Positions<Dim>& positions,
                Positions<Dim>* velocities) {
    for (const HeldSet<Dim>& held : world.held) {
        const Pose<Dim> pose = pose_at<Dim>(held.motion, time);
        for (const std::uint32_t vertex : held.vertices) {
            const Vector<Dim> arm = world.rest.col(vertex) - held.about;
            // Written as a change of the rest position, which a motion at rest keeps to the bit.
            positions.col(vertex) =
                world.rest.col(vertex)
                + ((pose.rotation - Matrix<Dim>::Identity()) * arm + pose.shift);
            if (velocities != nullptr) {
                velocities->col(vertex) = pose.rate * arm + pose.velocity;
            }
        }
    }
}

template World<3> make_world<3>(const Scene&, std::vector<SimplexMesh<3>>);
template World<4> make_world<4>(const Scene&, std::vector<SimplexMesh<4>>);
template void place_held<3>(const World<3>&, double, Positions<3>&, Positions<3>*);
template void place_held<4>(const World<4>&, double, Positions<4>&, Positions<4>*);

}  // namespace pent::simulator
