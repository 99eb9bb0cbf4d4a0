#include "model/part_bodies.h"
#include "step/host_checks.h"
#include "step/stepper.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/simulator/simulation.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pent::simulator {

template <int Dim>
Simulation<Dim>::Simulation(const Scene& scene,
                            std::vector<SimplexMesh<Dim>> meshes,
                            const SimulationOptions& options)
    : stepper_(std::make_shared<Stepper>(scene, std::move(meshes), options)) {
    stepper_->start();
}

template <int Dim>
Simulation<Dim>::Simulation(const Scene& scene,
                            std::vector<MeshPart<Dim>> parts,
                            const SimulationOptions& options)
    : stepper_(std::make_shared<Stepper>(
        scene, make_part_bodies(scene, std::move(parts), options.ranks), options)) {
    stepper_->start();
}

template <int Dim>
Simulation<Dim>::~Simulation() = default;
template <int Dim>
Simulation<Dim>::Simulation(Simulation&&) noexcept = default;
template <int Dim>
Simulation<Dim>& Simulation<Dim>::operator=(Simulation&&) noexcept = default;

template <int Dim>
StepReport Simulation<Dim>::step() {
    return stepper_->step();
}

template <int Dim>
const Scene& Simulation<Dim>::scene() const {
    return stepper_->scene();
}

template <int Dim>
int Simulation<Dim>::body_count() const {
    return static_cast<int>(stepper_->bodies().meshes.size());
}

template <int Dim>
const SimplexMesh<Dim>& Simulation<Dim>::mesh(int body) const {
    return stepper_->bodies().meshes[static_cast<std::size_t>(body)];
}

namespace {

template <int Dim>
Eigen::Map<const Positions<Dim>> view(const Bodies<Dim>& bodies,
                                      const Positions<Dim>& all,
                                      int body) {
    const auto range = bodies.vertices(static_cast<std::size_t>(body));
    return {all.data() + Dim * range.begin, Dim, range.size};
}

template <int Dim>
void check_state(const std::string& what,
                 const Positions<Dim>& positions,
                 const Positions<Dim>& velocities,
                 Eigen::Index count) {
    check_array<Dim>("positions" + what, positions, count);
    check_array<Dim>("velocities" + what, velocities, count);
}

// Checks the stiffness of a barrier.
void check_stiffness(double stiffness, bool may_be_zero) {
    if (!std::isfinite(stiffness) || stiffness < 0 || (stiffness == 0 && !may_be_zero)) {
        throw Error(formatted("a contact stiffness of %g N/m was given; expected a finite one %s 0",
                              stiffness, may_be_zero ? "not below" : "above"));
    }
}

void check_sleep(const std::vector<SleepState>& sleep, std::size_t bodies, bool can_sleep) {
    const bool is_right =
        sleep.size() == bodies
        && (can_sleep || std::all_of(sleep.begin(), sleep.end(), [](const SleepState& body) {
                return body == SleepState();
            }));
    if (!is_right) {
        throw Error("the sleep of " + std::to_string(sleep.size()) + " bodies was given; expected "
                    + std::to_string(bodies)
                    + (can_sleep ? "" : ", all of them awake, as the scene has no [sleep]"));
    }
    for (const SleepState& body : sleep) {
        check_stiffness(body.contact_stiffness, true);
    }
}

void check_springs(const std::vector<std::uint8_t>& broken, std::size_t springs) {
    const bool is_right = broken.size() == springs
                          && std::all_of(broken.begin(), broken.end(),
                                         [](std::uint8_t is_broken) { return is_broken <= 1; });
    if (!is_right) {
        throw Error("the state of " + std::to_string(broken.size())
                    + " springs was given; expected 0 or 1 for each of the "
                    + std::to_string(springs) + " of the attachments");
    }
}

}  // namespace

template <int Dim>
typename Simulation<Dim>::View Simulation<Dim>::positions(int body) const {
    return view(stepper_->bodies(), stepper_->current().positions, body);
}

template <int Dim>
typename Simulation<Dim>::View Simulation<Dim>::velocities(int body) const {
    return view(stepper_->bodies(), stepper_->current().velocities, body);
}

template <int Dim>
typename Simulation<Dim>::View Simulation<Dim>::forces(int body) const {
    return view(stepper_->bodies(), stepper_->forces(), body);
}

template <int Dim>
Positions<Dim> Simulation<Dim>::contact_forces(int body) const {
    return view(stepper_->bodies(), stepper_->contact_forces(), body);
}

template <int Dim>
std::span<const contact::Contact<Dim>> Simulation<Dim>::contacts() const {
    return stepper_->contact().contacts().list;
}

template <int Dim>
const std::vector<pent::ObstacleShape<Dim>>& Simulation<Dim>::obstacles() const {
    return stepper_->contact().obstacles();
}

template <int Dim>
std::shared_ptr<const void> Simulation<Dim>::arrays() const {
    return stepper_;
}

template <int Dim>
std::int64_t Simulation<Dim>::first_vertex(int body) const {
    return stepper_->bodies().first_vertex[static_cast<std::size_t>(body)];
}

template <int Dim>
std::vector<std::string> Simulation<Dim>::warnings() const {
    return stepper_->contact().warnings();
}

template <int Dim>
Eigen::Map<const Eigen::VectorXd> Simulation<Dim>::masses(int body) const {
    const Bodies<Dim>& bodies = stepper_->bodies();
    const auto range = bodies.vertices(static_cast<std::size_t>(body));
    return {bodies.masses.data() + range.begin, range.size};
}

template <int Dim>
double Simulation<Dim>::time() const {
    return stepper_->time();
}

template <int Dim>
std::uint64_t Simulation<Dim>::step_count() const {
    return stepper_->steps();
}

template <int Dim>
Energies Simulation<Dim>::energies() const {
    return stepper_->energies();
}

template <int Dim>
SimulationSize Simulation<Dim>::size() const {
    return stepper_->size();
}

template <int Dim>
std::string Simulation<Dim>::isa() const {
    return std::string(isa_name(stepper_->isa()));
}

template <int Dim>
void Simulation<Dim>::set_state(int body,
                                const Positions<Dim>& positions,
                                const Positions<Dim>& velocities) {
    check_body(body, stepper_->bodies());
    const Eigen::Index count = stepper_->bodies().vertices(static_cast<std::size_t>(body)).size;
    check_state(" of body " + std::to_string(body), positions, velocities, count);
    stepper_->set_body(body, positions, velocities);
}

template <int Dim>
const std::vector<SleepState>& Simulation<Dim>::sleep() const {
    return stepper_->sleep();
}

template <int Dim>
Snapshot<Dim> Simulation<Dim>::save() const {
    return stepper_->save();
}

template <int Dim>
void Simulation<Dim>::restore(const Snapshot<Dim>& snapshot) {
    const double time_step = stepper_->scene().dt();
    if (snapshot.time_step != time_step) {
        throw Error(
            formatted("the state is of a simulation with steps of %.9g s; this one has steps",
                      snapshot.time_step)
            + formatted(" of %.9g s: set positions and velocities instead", time_step));
    }
    const Eigen::Index vertices = stepper_->bodies().vertex_count();
    check_state(" in a snapshot", snapshot.positions, snapshot.velocities, vertices);
    if (snapshot.previous_positions.cols() > 0 || snapshot.previous_velocities.cols() > 0) {
        check_state(" one step ago in a snapshot", snapshot.previous_positions,
                    snapshot.previous_velocities, vertices);
    }
    const Snapshot<Dim> now = stepper_->save();
    check_springs(snapshot.broken_springs, now.broken_springs.size());
    if (snapshot.hold_places.cols() != now.hold_places.cols()
        || !snapshot.hold_places.allFinite()) {
        throw Error("the places where constraints took up "
                    + std::to_string(snapshot.hold_places.cols())
                    + " vertices were given; expected finite ones of "
                    + std::to_string(now.hold_places.cols()));
    }
    check_host(snapshot.host, stepper_->bodies());
    check_stiffness(snapshot.contact_stiffness, now.contact_stiffness == 0);
    check_sleep(snapshot.sleep, stepper_->sleep().size(), stepper_->scene().sleep.has_value());
    stepper_->restore(snapshot);
}

#define PENT_INSTANTIATE(Dim) template class Simulation<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
