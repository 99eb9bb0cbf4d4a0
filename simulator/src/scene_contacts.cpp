#include "scene_contacts.h"

#include "obstacle_shape.h"

#include <algorithm>

namespace pent::simulator {

namespace {

// How far vertices may move before pairs are searched again, over the distance of contact: the
// evaluations of one Newton step stay within it.
constexpr double kMargin = 0.25;

template <int Dim>
std::vector<contact::ContactBody<Dim>> contact_bodies(const Scene& scene, const World<Dim>& world) {
    std::vector<contact::ContactBody<Dim>> bodies;
    for (std::size_t body = 0; body < world.meshes.size(); ++body) {
        const SimplexMesh<Dim>& mesh = world.meshes[body];
        const auto first = static_cast<std::uint32_t>(world.first_vertex[body]);
        const auto end = static_cast<std::uint32_t>(world.first_vertex[body + 1]);
        bool is_kinematic = true;
        for (std::uint32_t vertex = first; vertex < end && is_kinematic; ++vertex) {
            is_kinematic = !world.numbering.is_free(vertex);
        }
        bodies.push_back({scene.bodies[body].name,
                          contact::make_surface<Dim>(mesh.cells, mesh.vertex_count(), first),
                          is_kinematic});
    }
    return bodies;
}

template <int Dim>
std::unique_ptr<contact::ContactFinder<Dim>> make_finder(const Scene& scene,
                                                         const World<Dim>& world) {
    const bool is_searched_often = scene.solver.integrator != Integrator::LinearEuler;
    const Contact& contact = *scene.contact;
    return std::make_unique<contact::ContactFinder<Dim>>(
        contact_bodies(scene, world), world.rest,
        contact::ContactOptions{.distance = contact.distance,
                                .stiffness = contact.stiffness,
                                .self = contact.self,
                                .filter = contact.filter,
                                .margin = is_searched_often ? kMargin * contact.distance : 0});
}

template <int Dim>
std::unique_ptr<contact::BarrierFinder<Dim>> make_barrier(const Scene& scene,
                                                          const World<Dim>& world) {
    std::vector<contact::Obstacle<Dim>> obstacles;
    for (const Obstacle& obstacle : scene.obstacles) {
        obstacles.push_back(to_obstacle<Dim>(obstacle.shape));
    }
    std::vector<bool> is_held;
    for (std::uint32_t vertex = 0; vertex < world.vertex_count(); ++vertex) {
        is_held.push_back(!world.numbering.is_free(vertex));
    }
    return std::make_unique<contact::BarrierFinder<Dim>>(
        contact_bodies(scene, world), std::move(obstacles), std::move(is_held), world.rest,
        contact::BarrierOptions{.distance = scene.contact->distance,
                                .separation = scene.contact->separation,
                                .self = scene.contact->self});
}

// A pair of a barrier for the report and for friction: its force, but not its Hessian.
template <int Dim>
contact::Contact<Dim> listed(const contact::BarrierContact<Dim>& pair,
                             const contact::Stencil<Dim>& points,
                             const contact::Barrier& barrier) {
    contact::Contact<Dim> contact;
    contact.weights.setZero();
    int count = 0;
    for (int i = 0; i < pair.faces.count; ++i) {
        const std::uint32_t vertex = pair.vertices[static_cast<std::size_t>(i)];
        if (vertex != contact::kFixedPoint) {  // the center of a ball does not move
            contact.vertices[static_cast<std::size_t>(count)] = vertex;
            contact.weights[count++] = pair.faces.weights[i];
        }
    }
    for (int i = count; i <= Dim; ++i) {
        contact.vertices[static_cast<std::size_t>(i)] = contact.vertices[0];  // of weight 0
    }
    const double m = pair.mollifier.threshold > 0
                         ? pair.mollifier.value(contact::spanned_volume_squared<Dim>(points))
                         : 1;
    contact.distance = pair.faces.distance - (pair.first_body < 0 ? pair.separation : 0);
    contact.response.energy = m * contact::barrier_energy(pair.faces.distance, barrier);
    contact.response.gradient =
        m * contact::barrier_slope(pair.faces.distance, barrier) * pair.faces.direction;
    contact.response.hessian.setZero();
    contact.kind = pair.faces.first_count == 1 || pair.faces.count - pair.faces.first_count == 1
                       ? contact::ContactKind::PointFacet
                       : contact::ContactKind::Mixed;
    contact.first_body = std::max(pair.first_body, 0);
    contact.second_body = pair.second_body;
    if (pair.first_body < 0) {
        contact.first_body = pair.second_body;
    }
    return contact;
}

// What is counted and measured of the contacts of a state.
template <int Dim>
void sum_up(const contact::ContactReport& report, ContactState<Dim>& state) {
    ContactSummary& summary = state.summary;
    summary.point_facet = report.point_facet;
    summary.mixed = report.mixed;
    summary.self = report.self;
    summary.candidates = report.candidates;
    summary.trees_built = report.trees_built;
    summary.trees_refit = report.trees_refit;
    summary.deepest = report.deepest;
    summary.smallest_distance = report.smallest_distance;
    state.energy = report.energy;
    summary.obstacle = static_cast<std::int64_t>(state.obstacles.size());
    for (const contact::ObstacleContact<Dim>& contact : state.obstacles) {
        state.obstacle_energy += contact.response.energy;
        summary.deepest = std::max(summary.deepest, -contact.distance);
        summary.smallest_distance = std::min(summary.smallest_distance, contact.distance);
    }
}

}  // namespace

template <int Dim>
void ContactState<Dim>::add_forces(Positions<Dim>& forces) const {
    const auto add_obstacles = [&](const std::vector<contact::ObstacleContact<Dim>>& list) {
        for (const contact::ObstacleContact<Dim>& contact : list) {
            forces.col(contact.vertex) -= contact.response.gradient;
        }
    };
    if (barrier_forces.cols() > 0) {
        forces += barrier_forces;
    } else {
        contact::add_forces(pairs, forces);
        add_obstacles(obstacles);
    }
    contact::add_forces(friction.pairs, forces);
    add_obstacles(friction.obstacles);
}

template <int Dim>
SceneContacts<Dim>::SceneContacts(const Scene& scene, const World<Dim>& world) {
    options_ = scene.contact.value_or(Contact{});
    if (options_.friction > 0) {
        friction_ = std::make_unique<LaggedFriction<Dim>>(
            contact::Friction{options_.friction, options_.slip_speed});
    }
    if (scene.contact && options_.model == ContactModel::Barrier) {
        barrier_ = make_barrier(scene, world);
        stiffness_ = options_.stiffness;
        return;
    }
    if (scene.contact && (world.meshes.size() > 1 || scene.contact->self)) {
        finder_ = make_finder(scene, world);
    }
    for (const Obstacle& obstacle : scene.obstacles) {
        obstacles_.push_back({to_obstacle<Dim>(obstacle.shape),
                              {.distance = obstacle.distance,
                               .stiffness = obstacle.stiffness,
                               .reach = contact::Reach::AnyDepth}});
    }
    if (!obstacles_.empty()) {
        free_vertices_ = world.numbering.vertex_of_unknown;
        std::sort(free_vertices_.begin(), free_vertices_.end());
    }
}

template <int Dim>
ContactState<Dim> SceneContacts<Dim>::find(const Workers& workers,
                                           const Positions<Dim>& positions) {
    ContactState<Dim> state;
    contact::ContactReport report;
    workers.run([&] {
        if (finder_) {
            contact::Contacts<Dim> found = finder_->find(positions);
            state.pairs = std::move(found.pairs);
            report = found.report;
            state.summary.searches = 1;
        }
        if (barrier_) {
            find_barrier(positions, state);
        } else {
            state.obstacles = contact::find_obstacle_contacts<Dim>(
                obstacles_, free_vertices_, positions, contact::Filter::Clamp);
            state.summary.obstacle_tests =
                static_cast<std::int64_t>(obstacles_.size() * free_vertices_.size());
        }
    });
    if (friction_) {
        state.friction = friction_->find(positions);
        state.summary.friction = static_cast<std::int64_t>(state.friction.pairs.size()
                                                           + state.friction.obstacles.size());
    }
    if (!barrier_) {
        sum_up(report, state);
    }
    return state;
}

template <int Dim>
void SceneContacts<Dim>::find_barrier(const Positions<Dim>& positions, ContactState<Dim>& state) {
    state.barrier = barrier_->find(positions);
    state.barrier_forces.setZero(Dim, positions.cols());
    barrier_->add_forces(state.barrier, positions, stiffness_, state.barrier_forces);
    ContactSummary& summary = state.summary;
    summary.searches = 1;
    summary.candidates = state.barrier.report.candidates;
    for (const contact::BarrierContact<Dim>& pair : state.barrier.pairs) {
        state.pairs.push_back(
            listed<Dim>(pair, barrier_->points_of(pair, positions),
                        {options_.distance, pair.multiplicity * stiffness_, pair.separation}));
        const contact::Contact<Dim>& contact = state.pairs.back();
        ++(contact.kind == contact::ContactKind::PointFacet ? summary.point_facet : summary.mixed);
        summary.self += pair.first_body == pair.second_body ? 1 : 0;
        summary.smallest_distance = std::min(summary.smallest_distance, contact.distance);
    }
    for (const contact::VertexContact& vertex : state.barrier.vertices) {
        state.obstacles.push_back(
            {vertex.vertex, vertex.obstacle, vertex.distance,
             contact::obstacle_response<Dim>(
                 barrier_->obstacles()[static_cast<std::size_t>(vertex.obstacle)],
                 positions.col(vertex.vertex),
                 contact::Barrier{options_.distance, stiffness_, options_.separation},
                 options_.filter)});
        state.obstacle_energy += state.obstacles.back().response.energy;
        summary.smallest_distance = std::min(summary.smallest_distance, vertex.distance);
    }
    summary.obstacle = static_cast<std::int64_t>(state.obstacles.size());
    state.energy = barrier_->energy(state.barrier, positions, stiffness_) - state.obstacle_energy;
}

template <int Dim>
void SceneContacts<Dim>::begin_step(const ContactState<Dim>& now,
                                    const Positions<Dim>& positions,
                                    const Positions<Dim>* velocities,
                                    double h) {
    if (friction_) {
        friction_->begin_step(now.pairs, now.obstacles, positions, velocities, h);
    }
}

template <int Dim>
std::vector<LocalHessian<Dim>> SceneContacts<Dim>::hessians(const Workers& workers,
                                                            const ContactState<Dim>& state,
                                                            const Positions<Dim>& positions) const {
    constexpr std::size_t kChunk = 64;
    const auto& pairs = state.barrier.pairs;
    std::vector<LocalHessian<Dim>> hessians(pairs.size());
    workers.for_each(static_cast<int>((pairs.size() + kChunk - 1) / kChunk), [&](int chunk) {
        const std::size_t begin = static_cast<std::size_t>(chunk) * kChunk;
        for (std::size_t i = begin; i < std::min(begin + kChunk, pairs.size()); ++i) {
            hessians[i].vertices = pairs[i].vertices;
            hessians[i].count = pairs[i].faces.count;
            hessians[i].matrix =
                barrier_->hessian(pairs[i], positions, stiffness_, options_.filter);
        }
    });
    return hessians;
}

template <int Dim>
contact::StepLimit SceneContacts<Dim>::limit_step(const Workers& workers,
                                                  const Positions<Dim>& from,
                                                  const Positions<Dim>& to) {
    return workers.run(
        [&] { return barrier_ ? barrier_->limit_step(from, to) : contact::StepLimit(); });
}

template <int Dim>
std::vector<contact::Crossing> SceneContacts<Dim>::find_crossings(
    const Workers& workers, const Positions<Dim>& positions) const {
    return workers.run([&] {
        return barrier_ ? barrier_->find_crossings(positions) : std::vector<contact::Crossing>();
    });
}

template <int Dim>
std::string SceneContacts<Dim>::describe(const contact::Crossing& crossing) const {
    return contact::describe<Dim>(crossing, barrier_->bodies());
}

template <int Dim>
std::vector<std::string> SceneContacts<Dim>::warnings() const {
    return finder_ ? finder_->warnings() : std::vector<std::string>();
}

template <int Dim>
std::int64_t SceneContacts<Dim>::bytes() const {
    std::int64_t bytes = static_cast<std::int64_t>(free_vertices_.size() * sizeof(std::uint32_t));
    if (barrier_) {
        for (const contact::ContactBody<Dim>& body : barrier_->bodies()) {
            bytes += body.surface.bytes();
        }
    }
    return bytes + (finder_ ? finder_->bytes() : 0);
}

template struct ContactState<3>;
template struct ContactState<4>;
template class SceneContacts<3>;
template class SceneContacts<4>;

}  // namespace pent::simulator
