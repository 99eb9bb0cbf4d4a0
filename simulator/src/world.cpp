#include "world.h"

#include "rotation.h"
#include "selection.h"

#include <pent/error.h>

#include <algorithm>
#include <cmath>
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
        const Lame& lame = range.material.lame;
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
            const double volume = cell_volume<Dim>(world.rest, world.cells, cell);
            const double share = range.material.density * volume / (Dim + 1);
            world.large_energy += (lame.mu + std::abs(lame.lambda)) * volume;
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

// Where a chain of motions takes points.
template <int Dim>
class Chain {
public:
    Chain(const std::vector<CenteredMotion<Dim>>& motions, double time) {
        for (const CenteredMotion<Dim>& held : motions) {
            links_.push_back({pose_at<Dim>(held.motion, time), held.about});
        }
    }

    // Takes the point on; its velocity too unless that is null.
    void move(Vector<Dim>& point, Vector<Dim>* velocity) const {
        for (const auto& [pose, about] : links_) {
            const Vector<Dim> arm = point - about;
            // Written as a change of the position, which a motion at rest keeps to the bit.
            point += (pose.rotation - Matrix<Dim>::Identity()) * arm + pose.shift;
            if (velocity != nullptr) {
                *velocity = (pose.rotation * *velocity + pose.rate * arm + pose.velocity).eval();
            }
        }
    }

private:
    struct Link {
        Pose<Dim> pose;
        Vector<Dim> about;
    };
    std::vector<Link> links_;
};

// Finds what each motion turns about: what it says, or where those before have taken the middle.
template <int Dim>
std::vector<CenteredMotion<Dim>> center(const std::vector<Motion>& motions,
                                        const Vector<Dim>& middle) {
    std::vector<CenteredMotion<Dim>> centered;
    for (const Motion& motion : motions) {
        Vector<Dim> about = middle;
        if (motion.about) {
            about = *motion.about;
        } else {
            Chain<Dim>(centered, motion.from).move(about, nullptr);
        }
        centered.push_back({motion, about});
    }
    return centered;
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
        Vector<Dim> sum = Vector<Dim>::Zero();
        for (const std::uint32_t vertex : select_vertices(world.meshes[body], constraint)) {
            const auto global = static_cast<std::uint32_t>(vertex + world.first_vertex[body]);
            if (is_held[global]) {
                throw Error("vertex " + std::to_string(vertex) + " of body \"" + constraint.body
                            + "\" is selected by two constraints; make their selections disjoint");
            }
            is_held[global] = true;
            held.vertices.push_back(global);
            sum += world.rest.col(global);
        }
        const Vector<Dim> middle = sum / static_cast<double>(held.vertices.size());
        held.motions = center<Dim>(constraint.motion, middle);
        world.held.push_back(std::move(held));
    }
    return is_held;
}

// A mesh without columns has one a vertex.
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
    world.is_held = hold_vertices(scene, world);
    world.columns = number_columns(world);
    world.numbering = number_bodies(world, std::vector<bool>(world.meshes.size(), true));
    return world;
}

template <int Dim>
Numbering number_bodies(const World<Dim>& world, const std::vector<bool>& is_in) {
    std::vector<bool> is_held = world.is_held;
    for (std::size_t body = 0; body < is_in.size(); ++body) {
        if (!is_in[body]) {
            std::fill(is_held.begin() + world.first_vertex[body],
                      is_held.begin() + world.first_vertex[body + 1], true);
        }
    }
    return number_unknowns<Dim>(world.cells, is_held, world.columns.columns, world.columns.layers);
}

template <int Dim>
Positions<Dim> start_velocities(const Scene& scene, const World<Dim>& world) {
    Positions<Dim> velocities = Positions<Dim>::Zero(Dim, world.vertex_count());
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        const Eigen::Index first = world.first_vertex[body];
        const Eigen::Index count = world.first_vertex[body + 1] - first;
        const auto rest = world.rest.middleCols(first, count);
        const auto masses = world.masses.segment(first, count);
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
void place_held(const World<Dim>& world,
                double time,
                Positions<Dim>& positions,
                Positions<Dim>* velocities) {
    for (const HeldSet<Dim>& held : world.held) {
        const Chain<Dim> chain(held.motions, time);
        for (const std::uint32_t vertex : held.vertices) {
            Vector<Dim> point = world.rest.col(vertex);
            Vector<Dim> velocity = Vector<Dim>::Zero();
            chain.move(point, velocities != nullptr ? &velocity : nullptr);
            positions.col(vertex) = point;
            if (velocities != nullptr) {
                velocities->col(vertex) = velocity;
            }
        }
    }
}

template World<3> make_world<3>(const Scene&, std::vector<SimplexMesh<3>>);
template World<4> make_world<4>(const Scene&, std::vector<SimplexMesh<4>>);
template Numbering number_bodies<3>(const World<3>&, const std::vector<bool>&);
template Numbering number_bodies<4>(const World<4>&, const std::vector<bool>&);
template Positions<3> start_velocities<3>(const Scene&, const World<3>&);
template Positions<4> start_velocities<4>(const Scene&, const World<4>&);
template void place_held<3>(const World<3>&, double, Positions<3>&, Positions<3>*);
template void place_held<4>(const World<4>&, double, Positions<4>&, Positions<4>*);

}  // namespace pent::simulator
