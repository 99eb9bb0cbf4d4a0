#include "model/bodies.h"

#include "model/append_bodies.h"
#include "model/part_bodies.h"
#include "model/rotation.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/simulator/placed_mesh.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace pent::simulator {

namespace {

// Ranks that have the cells of their vertices alone find the masses of these, and tell the others.
template <int Dim>
void lump_masses(const Scene& scene, Bodies<Dim>& bodies) {
    Eigen::Matrix<double, 1, Eigen::Dynamic> masses =
        Eigen::Matrix<double, 1, Eigen::Dynamic>::Zero(bodies.vertex_count());
    for (const CellRange& range : bodies.ranges) {
        const Lame& lame = range.material.lame;
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
            const double volume = cell_volume<Dim>(bodies.rest, bodies.cells, cell);
            const double share = range.material.density * volume / (Dim + 1);
            if (bodies.sharing.owns(bodies.cells(0, cell))) {
                bodies.large_energy += (lame.mu + std::abs(lame.lambda)) * volume;
            }
            for (int corner = 0; corner <= Dim; ++corner) {
                masses[bodies.cells(corner, cell)] += share;
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

// The first step that begins at a time or later; times that differ by this part of a step are the
// same, as they are sums of rounded ones.
std::uint64_t first_step_from(double time, double dt) {
    constexpr double kSameTime = 1e-6;
    constexpr auto kNever = std::numeric_limits<std::uint64_t>::max();
    const double step = std::ceil(time / dt - kSameTime);
    return step < 1e18 ? static_cast<std::uint64_t>(std::max(step, 0.0)) : kNever;
}

// What each motion of a set turns about, by where the set was taken up, and when it begins.
template <int Dim>
void center_motions(const Scene& scene, DirichletSet<Dim>& set) {
    const double start = static_cast<double>(set.first_step) * scene.dt();
    std::vector<Motion> motions = scene.constraints[set.constraint].motion;
    std::erase_if(motions, [&](const Motion& motion) { return motion.to <= start; });
    for (Motion& motion : motions) {
        motion.from = set.begins_later() ? std::max(motion.from, start) : motion.from;
    }
    Vector<Dim> sum = Vector<Dim>::Zero();
    for (const auto place : set.places.colwise()) {
        sum += place;
    }
    set.motions = center<Dim>(motions, sum / static_cast<double>(set.places.cols()));
}

// Whether two sets hold something in one step.
template <int Dim>
bool do_overlap(const DirichletSet<Dim>& a, const DirichletSet<Dim>& b) {
    return a.first_step < b.end_step && b.first_step < a.end_step;
}

// Finds what each constraint holds, and when.
template <int Dim>
void find_dirichlet_sets(const Scene& scene, Bodies<Dim>& bodies) {
    bodies.is_dirichlet.assign(static_cast<std::size_t>(bodies.vertex_count()), false);
    bodies.is_always_held = bodies.is_dirichlet;
    for (const Constraint& constraint : scene.constraints) {
        DirichletSet<Dim> set;
        set.constraint = bodies.dirichlet_sets.size();
        set.body = index_of(scene, constraint.body);
        set.first_step = first_step_from(constraint.from, scene.dt());
        set.end_step = first_step_from(constraint.to, scene.dt());
        const std::vector<std::uint32_t> selected =
            select_vertices(bodies.meshes[set.body], constraint);
        set.places = Positions<Dim>::Zero(Dim, static_cast<Eigen::Index>(selected.size()));
        for (const std::uint32_t vertex : selected) {
            const auto global = static_cast<std::uint32_t>(vertex + bodies.first_vertex[set.body]);
            set.vertices.push_back(global);
        }
        for (const DirichletSet<Dim>& other : bodies.dirichlet_sets) {
            std::vector<std::uint32_t> both;
            std::set_intersection(set.vertices.begin(), set.vertices.end(), other.vertices.begin(),
                                  other.vertices.end(), std::back_inserter(both));
            if (!both.empty() && do_overlap<Dim>(set, other)) {
                throw Error("vertex "
                            + std::to_string(both.front() - bodies.first_vertex[set.body])
                            + " of body \"" + constraint.body
                            + "\" is held by two constraints at one time; make their selections"
                              " disjoint, or let one end before the other begins");
            }
        }
        for (const std::uint32_t vertex : set.vertices) {
            bodies.is_always_held[vertex] =
                bodies.is_always_held[vertex] || (!set.begins_later() && std::isinf(constraint.to));
        }
        bodies.dirichlet_sets.push_back(std::move(set));
    }
}

// Marks what is held in a step.
template <int Dim>
void mark_dirichlet(std::uint64_t step, Bodies<Dim>& bodies) {
    bodies.step = step;
    bodies.is_dirichlet.assign(bodies.is_dirichlet.size(), false);
    for (const DirichletSet<Dim>& set : bodies.dirichlet_sets) {
        for (const std::uint32_t vertex : set.vertices) {
            bodies.is_dirichlet[vertex] = bodies.is_dirichlet[vertex] || set.is_held(step);
        }
    }
    for (const std::uint32_t vertex : bodies.host_holds.vertices) {
        bodies.is_dirichlet[vertex] = true;
    }
}

// Puts what a host holds on the straight way to its target.
template <int Dim>
void place_host_holds(const HostHolds<Dim>& holds,
                      double time,
                      Positions<Dim>& positions,
                      Positions<Dim>* velocities) {
    constexpr double kSameTime = 1e-6;  // parts of a step end at rounded sums
    const double h = holds.end - holds.begin;
    const double part = (time - holds.begin) / h;
    for (std::size_t i = 0; i < holds.vertices.size(); ++i) {
        const std::uint32_t vertex = holds.vertices[i];
        const auto column = static_cast<Eigen::Index>(i);
        const Vector<Dim> way = holds.targets.col(column) - holds.starts.col(column);
        positions.col(vertex) = holds.targets.col(column);
        if (part < 1 - kSameTime) {
            positions.col(vertex) = holds.starts.col(column) + part * way;
        }
        if (velocities != nullptr) {
            velocities->col(vertex) = way / h;
        }
    }
}

// Takes up a set where it is.
template <int Dim>
void take_up(const Scene& scene, const Positions<Dim>& positions, DirichletSet<Dim>& set) {
    for (std::size_t i = 0; i < set.vertices.size(); ++i) {
        set.places.col(static_cast<Eigen::Index>(i)) = positions.col(set.vertices[i]);
    }
    center_motions<Dim>(scene, set);
}

}  // namespace

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
        throw Error("the scene has " + std::to_string(scene.bodies.size()) + " bodies; got "
                    + std::to_string(meshes) + " meshes");
    }
}

template <int Dim>
Bodies<Dim> make_bodies(const Scene& scene, std::vector<SimplexMesh<Dim>> meshes) {
    check_meshes<Dim>(scene, meshes.size());
    Bodies<Dim> bodies;
    bodies.meshes = std::move(meshes);
    append_bodies(scene, bodies);
    bodies.columns = number_columns(bodies.meshes);
    complete(scene, bodies);
    return bodies;
}

template <int Dim>
void complete(const Scene& scene, Bodies<Dim>& bodies) {
    lump_masses(scene, bodies);
    find_dirichlet_sets(scene, bodies);
    for (DirichletSet<Dim>& set : bodies.dirichlet_sets) {
        if (!set.begins_later()) {
            take_up<Dim>(scene, bodies.rest, set);
        }
    }
    mark_dirichlet<Dim>(0, bodies);
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
bool Bodies<Dim>::is_kinematic(std::size_t body) const {
    return std::all_of(is_always_held.begin() + first_vertex[body],
                       is_always_held.begin() + first_vertex[body + 1],
                       [](bool is_held) { return is_held; });
}

template <int Dim>
std::vector<std::size_t> hold(const Scene& scene,
                              std::uint64_t step,
                              const Positions<Dim>& positions,
                              Bodies<Dim>& bodies) {
    std::vector<std::size_t> changed;
    for (DirichletSet<Dim>& set : bodies.dirichlet_sets) {
        if (set.is_held(step) == set.is_held(bodies.step)) {
            continue;
        }
        changed.push_back(set.body);
        if (step == set.first_step && set.begins_later()) {
            take_up<Dim>(scene, positions, set);
        }
    }
    if (changed.empty()) {
        bodies.step = step;
    } else {
        mark_dirichlet<Dim>(step, bodies);
    }
    return changed;
}

template <int Dim>
Positions<Dim> hold_places(const Bodies<Dim>& bodies) {
    Positions<Dim> all(Dim, 0);
    for (const DirichletSet<Dim>& set : bodies.dirichlet_sets) {
        if (set.begins_later()) {
            const Eigen::Index count = all.cols();
            all.conservativeResize(Dim, count + set.places.cols());
            all.rightCols(set.places.cols()) = set.places;
        }
    }
    return all;
}

template <int Dim>
void set_hold_places(const Scene& scene, const Positions<Dim>& places, Bodies<Dim>& bodies) {
    Eigen::Index next = 0;
    for (DirichletSet<Dim>& set : bodies.dirichlet_sets) {
        if (set.begins_later()) {
            set.places = places.middleCols(next, set.places.cols());
            next += set.places.cols();
            center_motions<Dim>(scene, set);
        }
    }
}

template <int Dim>
bool hold_for_host(std::vector<std::uint32_t> vertices,
                   const Positions<Dim>& targets,
                   Bodies<Dim>& bodies) {
    HostHolds<Dim>& holds = bodies.host_holds;
    const bool has_changed = vertices != holds.vertices;
    holds.vertices = std::move(vertices);
    holds.targets = targets;
    if (has_changed) {
        mark_dirichlet<Dim>(bodies.step, bodies);
    }
    return has_changed;
}

template <int Dim>
void begin_host_holds(const Positions<Dim>& positions,
                      double begin,
                      double end,
                      Bodies<Dim>& bodies) {
    HostHolds<Dim>& holds = bodies.host_holds;
    holds.begin = begin;
    holds.end = end;
    holds.starts.resize(Dim, holds.targets.cols());
    for (std::size_t i = 0; i < holds.vertices.size(); ++i) {
        holds.starts.col(static_cast<Eigen::Index>(i)) = positions.col(holds.vertices[i]);
    }
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
        if (!set.is_held(bodies.step)) {
            continue;
        }
        const MotionChain<Dim> chain(set.motions, time);
        for (std::size_t i = 0; i < set.vertices.size(); ++i) {
            const std::uint32_t vertex = set.vertices[i];
            Vector<Dim> point = set.places.col(static_cast<Eigen::Index>(i));
            Vector<Dim> velocity = Vector<Dim>::Zero();
            chain.move(point, velocities != nullptr ? &velocity : nullptr);
            positions.col(vertex) = point;
            if (velocities != nullptr) {
                velocities->col(vertex) = velocity;
            }
        }
    }
    place_host_holds<Dim>(bodies.host_holds, time, positions, velocities);
}

#define PENT_INSTANTIATE(Dim)                                                                     \
    template struct Bodies<Dim>;                                                                  \
    template Columns number_columns<Dim>(const std::vector<SimplexMesh<Dim>>&);                   \
    template void check_meshes<Dim>(const Scene&, std::size_t);                                   \
    template Bodies<Dim> make_bodies<Dim>(const Scene&, std::vector<SimplexMesh<Dim>>);           \
    template void complete<Dim>(const Scene&, Bodies<Dim>&);                                      \
    template std::vector<std::size_t> hold(const Scene&, std::uint64_t, const Positions<Dim>&,    \
                                           Bodies<Dim>&);                                         \
    template Positions<Dim> hold_places(const Bodies<Dim>&);                                      \
    template void set_hold_places(const Scene&, const Positions<Dim>&, Bodies<Dim>&);             \
    template bool hold_for_host(std::vector<std::uint32_t>, const Positions<Dim>&, Bodies<Dim>&); \
    template void begin_host_holds(const Positions<Dim>&, double, double, Bodies<Dim>&);          \
    template Positions<Dim> start_velocities<Dim>(const Scene&, const Bodies<Dim>&);              \
    template void place_dirichlet<Dim>(const Bodies<Dim>&, double, Positions<Dim>&,               \
                                       Positions<Dim>*);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
