#include "simulation_state.h"

#include <pent/error.h>
#include <pent/simulator/simulation.h>

#include <algorithm>
#include <utility>

namespace pent::simulator {

template <int Dim>
Simulation<Dim>::Simulation(const Scene& scene,
                            std::vector<SimplexMesh<Dim>> meshes,
                            const SimulationOptions& options)
    : state_(workers_of(options).run(
        [&] { return std::make_unique<State>(scene, std::move(meshes), options); })) {}

template <int Dim>
Simulation<Dim>::~Simulation() = default;
template <int Dim>
Simulation<Dim>::Simulation(Simulation&&) noexcept = default;
template <int Dim>
Simulation<Dim>& Simulation<Dim>::operator=(Simulation&&) noexcept = default;

template <int Dim>
StepReport Simulation<Dim>::step() {
    return state_->step();
}

template <int Dim>
int Simulation<Dim>::body_count() const {
    return static_cast<int>(state_->world().meshes.size());
}

template <int Dim>
const SimplexMesh<Dim>& Simulation<Dim>::mesh(int body) const {
    return state_->world().meshes[static_cast<std::size_t>(body)];
}

namespace {

template <int Dim>
Eigen::Map<const Positions<Dim>> view(const World<Dim>& world,
                                      const Positions<Dim>& all,
                                      int body) {
    const Eigen::Index first = world.first_vertex[static_cast<std::size_t>(body)];
    const Eigen::Index last = world.first_vertex[static_cast<std::size_t>(body) + 1];
    return {all.data() + Dim * first, Dim, last - first};
}

template <int Dim>
void check_state(const Positions<Dim>& positions,
                 const Positions<Dim>& velocities,
                 Eigen::Index count) {
    if (positions.cols() != count || velocities.cols() != count || !positions.allFinite()
        || !velocities.allFinite()) {
        throw Error("the state of a body must be finite positions and velocities of its "
                    + std::to_string(count) + " vertices");
    }
}

}  // namespace

template <int Dim>
typename Simulation<Dim>::View Simulation<Dim>::positions(int body) const {
    return view(state_->world(), state_->current().positions, body);
}

template <int Dim>
typename Simulation<Dim>::View Simulation<Dim>::velocities(int body) const {
    return view(state_->world(), state_->current().velocities, body);
}

template <int Dim>
typename Simulation<Dim>::View Simulation<Dim>::forces(int body) const {
    return view(state_->world(), state_->current().forces, body);
}

template <int Dim>
Positions<Dim> Simulation<Dim>::contact_forces(int body) const {
    const BodyState<Dim>& current = state_->current();
    Positions<Dim> all = Positions<Dim>::Zero(Dim, current.positions.cols());
    if (current.contacts) {
        current.contacts->add_forces(all);
    }
    return view(state_->world(), all, body);
}

template <int Dim>
std::span<const contact::Contact<Dim>> Simulation<Dim>::contacts() const {
    const auto& contacts = state_->current().contacts;
    return contacts ? std::span<const contact::Contact<Dim>>(contacts->pairs)
                    : std::span<const contact::Contact<Dim>>();
}

template <int Dim>
std::span<const contact::ObstacleContact<Dim>> Simulation<Dim>::obstacle_contacts() const {
    const auto& contacts = state_->current().contacts;
    return contacts ? std::span<const contact::ObstacleContact<Dim>>(contacts->obstacles)
                    : std::span<const contact::ObstacleContact<Dim>>();
}

template <int Dim>
std::int64_t Simulation<Dim>::first_vertex(int body) const {
    return state_->world().first_vertex[static_cast<std::size_t>(body)];
}

template <int Dim>
std::vector<std::string> Simulation<Dim>::warnings() const {
    return state_->system().contacts().warnings();
}

template <int Dim>
Eigen::Map<const Eigen::VectorXd> Simulation<Dim>::masses(int body) const {
    const World<Dim>& world = state_->world();
    const Eigen::Index first = world.first_vertex[static_cast<std::size_t>(body)];
    const Eigen::Index last = world.first_vertex[static_cast<std::size_t>(body) + 1];
    return {world.masses.data() + first, last - first};
}

template <int Dim>
double Simulation<Dim>::time() const {
    return state_->time();
}

template <int Dim>
std::uint64_t Simulation<Dim>::step_count() const {
    return state_->steps();
}

template <int Dim>
Energies Simulation<Dim>::energies() const {
    return state_->current().energies;
}

template <int Dim>
SimulationSize Simulation<Dim>::size() const {
    return state_->system().size();
}

template <int Dim>
std::string Simulation<Dim>::isa() const {
    return std::string(isa_name(state_->system().isa()));
}

template <int Dim>
void Simulation<Dim>::set_state(int body,
                                const Positions<Dim>& positions,
                                const Positions<Dim>& velocities) {
    const World<Dim>& world = state_->world();
    const Eigen::Index first = world.first_vertex[static_cast<std::size_t>(body)];
    const Eigen::Index count = world.first_vertex[static_cast<std::size_t>(body) + 1] - first;
    check_state(positions, velocities, count);
    state_->set_body(body, positions, velocities);
}

template <int Dim>
const std::vector<BodyRest>& Simulation<Dim>::rest() const {
    return state_->rest();
}

template <int Dim>
void Simulation<Dim>::set_rest(const std::vector<BodyRest>& rest) {
    const bool can_sleep = state_->scene().sleep.has_value();
    const bool is_right =
        rest.size() == state_->rest().size()
        && (can_sleep || std::all_of(rest.begin(), rest.end(), [](const BodyRest& body) {
                return body == BodyRest();
            }));
    if (!is_right) {
        throw Error("the rest of " + std::to_string(rest.size()) + " bodies was given; expected "
                    + std::to_string(state_->rest().size())
                    + (can_sleep ? "" : ", none of them at rest, as the scene has no [sleep]"));
    }
    state_->set_rest(rest);
}

template <int Dim>
bool Simulation<Dim>::has_history() const {
    return state_->has_history();
}

template <int Dim>
typename Simulation<Dim>::View Simulation<Dim>::previous_positions(int body) const {
    return view(state_->world(), state_->history().positions, body);
}

template <int Dim>
typename Simulation<Dim>::View Simulation<Dim>::previous_velocities(int body) const {
    return view(state_->world(), state_->history().velocities, body);
}

template <int Dim>
void Simulation<Dim>::set_history(int body,
                                  const Positions<Dim>& positions,
                                  const Positions<Dim>& velocities) {
    const World<Dim>& world = state_->world();
    const Eigen::Index first = world.first_vertex[static_cast<std::size_t>(body)];
    const Eigen::Index count = world.first_vertex[static_cast<std::size_t>(body) + 1] - first;
    check_state(positions, velocities, count);
    History<Dim>& history = state_->history();
    history.positions.conservativeResize(Dim, world.vertex_count());
    history.velocities.conservativeResize(Dim, world.vertex_count());
    history.positions.middleCols(first, count) = positions;
    history.velocities.middleCols(first, count) = velocities;
    state_->set_has_history();
}

template <int Dim>
void Simulation<Dim>::set_step_count(std::uint64_t steps) {
    state_->set_steps(steps);
}

template class Simulation<3>;
template class Simulation<4>;

}  // namespace pent::simulator
