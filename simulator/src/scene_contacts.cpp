#include "scene_contacts.h"

#include <algorithm>
#include <chrono>

namespace pent::simulator {

namespace {

// How far vertices may move before pairs are searched again, over the distance of contact: the
// evaluations of one Newton step stay within it.
constexpr double kMargin = 0.25;

template <int Dim>
contact::Obstacle<Dim> fixed_size(const ObstacleShape& shape) {
    struct Convert {
        contact::Obstacle<Dim> operator()(const HalfSpaceObstacle& plane) const {
            return contact::HalfSpace<Dim>{plane.normal, plane.offset};
        }
        contact::Obstacle<Dim> operator()(const BallObstacle& ball) const {
            return contact::Ball<Dim>{ball.center, ball.radius};
        }
        contact::Obstacle<Dim> operator()(const CavityObstacle& cavity) const {
            return contact::Cavity<Dim>{cavity.center, cavity.radius};
        }
        contact::Obstacle<Dim> operator()(const BowlObstacle& bowl) const {
            return contact::Bowl<Dim>{bowl.center, bowl.radius, bowl.up};
        }
    };
    return std::visit(Convert{}, shape);
}

template <int Dim>
std::unique_ptr<contact::ContactFinder<Dim>> make_finder(const Scene& scene,
                                                         const World<Dim>& world) {
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
    const bool is_searched_often = scene.solver.integrator != Integrator::LinearEuler;
    const Contact& contact = *scene.contact;
    return std::make_unique<contact::ContactFinder<Dim>>(
        std::move(bodies), world.rest,
        contact::ContactOptions{.distance = contact.distance,
                                .stiffness = contact.stiffness,
                                .self = contact.self,
                                .filter = contact.filter,
                                .tilt = is_searched_often,
                                .margin = is_searched_often ? kMargin * contact.distance : 0});
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
    contact::add_forces(pairs, forces);
    for (const contact::ObstacleContact<Dim>& contact : obstacles) {
        forces.col(contact.vertex) -= contact.response.gradient;
    }
}

template <int Dim>
SceneContacts<Dim>::SceneContacts(const Scene& scene, const World<Dim>& world) {
    if (scene.contact && (world.meshes.size() > 1 || scene.contact->self)) {
        finder_ = make_finder(scene, world);
    }
    for (const Obstacle& obstacle : scene.obstacles) {
        obstacles_.push_back({fixed_size<Dim>(obstacle.shape),
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
    const auto start = std::chrono::steady_clock::now();
    ContactState<Dim> state;
    contact::ContactReport report;
    workers.run([&] {
        if (finder_) {
            contact::Contacts<Dim> found = finder_->find(positions);
            state.pairs = std::move(found.pairs);
            report = found.report;
            state.summary.searches = 1;
        }
        state.obstacles = contact::find_obstacle_contacts<Dim>(obstacles_, free_vertices_,
                                                               positions, contact::Filter::Clamp);
    });
    sum_up(report, state);
    state.summary.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return state;
}

template <int Dim>
std::vector<std::string> SceneContacts<Dim>::warnings() const {
    return finder_ ? finder_->warnings() : std::vector<std::string>();
}

template <int Dim>
std::int64_t SceneContacts<Dim>::bytes() const {
    return (finder_ ? finder_->bytes() : 0)
           + static_cast<std::int64_t>(free_vertices_.size() * sizeof(std::uint32_t));
}

template struct ContactState<3>;
template struct ContactState<4>;
template class SceneContacts<3>;
template class SceneContacts<4>;

}  // namespace pent::simulator
