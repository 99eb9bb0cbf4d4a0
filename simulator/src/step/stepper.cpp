#include "step/stepper.h"

#include "potentials/vertex_chunks.h"
#include "step/balance.h"
#include "step/crossing_error.h"
#include "step/rank_agreement.h"

#include <pent/dimensions.h>
#include <pent/error.h>
#include <pent/simulator/thickness.h>
#include <pent/stopwatch.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pent::simulator {

namespace {

template <int Dim>
double diagonal(const Positions<Dim>& positions) {
    return (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).norm();
}

// The least of what a function gives for the vertices of bodies at rest, m.
template <int Dim, typename Length>
double least(const Bodies<Dim>& bodies, const Length& length) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const SimplexMesh<Dim>& mesh : bodies.meshes) {
        shortest = std::min(shortest, length(mesh.positions));
    }
    return shortest;
}

}  // namespace

template <int Dim>
Simulation<Dim>::Stepper::Stepper(const Scene& scene,
                                  std::vector<SimplexMesh<Dim>> meshes,
                                  const SimulationOptions& options)
    : Stepper(scene, share(scene, make_bodies(scene, std::move(meshes)), options.ranks), options) {}

template <int Dim>
Simulation<Dim>::Stepper::Stepper(const Scene& scene,
                                  Bodies<Dim> bodies,
                                  const SimulationOptions& options)
    : options_(options),
      scene_(scene),
      workers_(options.tasks ? Workers(*options.tasks) : Workers(options.threads)),
      isa_(choose_isa(options.isa, options.ranks.get())),
      kernels_(&kernels<Dim>(isa_)),
      bodies_(std::move(bodies)),
      held_(scene, bodies_),
      energy_(workers_, *kernels_, bodies_, held_, scene),
      potential_(workers_, *kernels_, bodies_, held_, scene, energy_),
      islands_(scene, bodies_, held_),
      asleep_(islands_.asleep()),
      extent_(diagonal<Dim>(bodies_.rest())),
      smallest_(least(bodies_, diagonal<Dim>)),
      thinnest_(least(bodies_, thickness<Dim>)) {
    potential_.refuse_unsolvable(options.memory);
    potential_.set_observer(options.on_iterate);
    current_.positions = bodies_.rest();
    current_.velocities = start_velocities(scene, bodies_);
    held_.place(0, current_.positions, &current_.velocities);
}

template <int Dim>
void Simulation<Dim>::Stepper::start() {
    refuse_crossings(current_.positions, held_, time());
    evaluate_current();
}

// The step that has led here.
template <int Dim>
TimeSpan Simulation<Dim>::Stepper::last_step() const {
    return {std::max(0.0, time() - scene_.dt()), time()};
}

template <int Dim>
void Simulation<Dim>::Stepper::evaluate_current() {
    energy_.sum.set_time(last_step());
    energy_.sum.update(current_.positions);
    energy_.elasticity->evaluate_held(current_.positions);
    forces_ = -energy_.sum.gradient();
    if (energy_.elasticity->held_gradient().cols() > 0) {
        forces_ -= energy_.elasticity->held_gradient();
    }
}

// The same for a state that no step has led to, as after a restore, or where a step was refused:
// what terms hold from the start of a step (walls of pressure) is still that of another state, and
// is taken anew from this one; friction has no slip to go by, and is left out.
template <int Dim>
void Simulation<Dim>::Stepper::evaluate_anew() {
    evaluate_current();
    const Positions<Dim> none = Positions<Dim>::Zero(Dim, current_.positions.cols());
    energy_.sum.begin_step({.positions = current_.positions,
                            .velocities = current_.velocities,
                            .origin = current_.positions,
                            .prescribed_displacement = none});
    evaluate_current();
}

template <int Dim>
Snapshot<Dim> Simulation<Dim>::Stepper::save() const {
    return {.positions = current_.positions,
            .velocities = current_.velocities,
            .previous_positions = history_.positions,
            .previous_velocities = history_.velocities,
            .sleep = islands_.states(),
            .steps = steps_,
            .time_step = scene_.dt(),
            .contact_stiffness = energy_.contact->stiffness(),
            .hold_places = held_.places(),
            .broken_springs = broken_springs(),
            .host = host()};
}

template <int Dim>
std::vector<std::uint8_t> Simulation<Dim>::Stepper::broken_springs() const {
    return energy_.attachments != nullptr ? energy_.attachments->broken()
                                          : std::vector<std::uint8_t>();
}

template <int Dim>
void Simulation<Dim>::Stepper::restore(const Snapshot<Dim>& snapshot) {
    const double time = static_cast<double>(snapshot.steps) * scene_.dt();
    // Until the next step begins, vertices are held as they were in the last one.
    const std::uint64_t last_step = std::max<std::uint64_t>(snapshot.steps, 1) - 1;
    HeldVertices<Dim> held = held_;
    static_cast<void>(held.hold(last_step, snapshot.positions));
    static_cast<void>(held.hold_for_host(snapshot.host.held, snapshot.host.targets));
    refuse_crossings(snapshot.positions, held, time);
    energy_.sum.set_time({std::max(0.0, time - scene_.dt()), time});
    if (moves_sleepers(snapshot.positions)) {
        asleep_.clear();  // numbers dofs anew, so that their forces are those of where they lie now
    }
    current_.positions = snapshot.positions;
    current_.velocities = snapshot.velocities;
    history_ = {snapshot.previous_positions, snapshot.previous_velocities};
    islands_.set_states(snapshot.sleep);
    steps_ = snapshot.steps;
    if (energy_.contact->stiffness() != snapshot.contact_stiffness) {
        energy_.contact->set_stiffness(snapshot.contact_stiffness);
        energy_.sum.invalidate();
    }
    if (broken_springs() != snapshot.broken_springs) {
        energy_.attachments->set_broken(snapshot.broken_springs);
        energy_.sum.invalidate();
    }
    bool has_changed = !held_.hold(last_step, current_.positions).empty();
    has_changed = restore_host(snapshot.host) || has_changed;
    held_.set_places(snapshot.hold_places);
    if (has_changed) {
        number_dofs_of_the_free();
    } else {
        number_dofs_of_the_awake();
    }
    evaluate_anew();
}

template <int Dim>
double Simulation<Dim>::Stepper::kinetic_energy(const Positions<Dim>& velocities) const {
    return sum_vertices(workers_, velocities.cols(), [&](Eigen::Index v) {
        return 0.5 * bodies_.masses[v] * velocities.col(v).squaredNorm();
    });
}

template <int Dim>
Energies Simulation<Dim>::Stepper::energies() const {
    return {kinetic_energy(current_.velocities), energy_.sum.energies()};
}

// Throws unless the barrier finds nothing that crosses at a time, where these vertices are held.
template <int Dim>
void Simulation<Dim>::Stepper::refuse_crossings(const Positions<Dim>& positions,
                                                const HeldVertices<Dim>& held,
                                                double time) const {
    const std::vector<contact::Crossing> crossings =
        energy_.contact->find_crossings(scene_, bodies_, held, positions, time);
    if (!crossings.empty()) {
        throw crossing_error(bodies_, *energy_.contact, crossings, positions);
    }
}

// Whether something that sleeps now would lie elsewhere.
template <int Dim>
bool Simulation<Dim>::Stepper::moves_sleepers(const Positions<Dim>& to) const {
    for (std::size_t body = 0; body < asleep_.size(); ++body) {
        const auto range = bodies_.vertices(body);
        if (asleep_[body]
            && to.middleCols(range.begin, range.size)
                   != current_.positions.middleCols(range.begin, range.size)) {
            return true;
        }
    }
    return false;
}

// Gives dofs to the bodies that are awake, and to no other; what sleeps keeps its forces.
template <int Dim>
void Simulation<Dim>::Stepper::number_dofs_of_the_awake() {
    std::vector<bool> asleep = islands_.asleep();
    if (asleep != asleep_) {
        asleep_ = std::move(asleep);
        potential_.renumber(held_, asleep_, current_.positions);
    }
    if (energy_.contact->set_sleepers(islands_.stiffness_of_sleepers())) {
        energy_.sum.invalidate();
    }
}

// Gives dofs to what is free now, and to nothing that is held.
template <int Dim>
void Simulation<Dim>::Stepper::number_dofs_of_the_free() {
    asleep_ = islands_.asleep();
    potential_.renumber(held_, asleep_, current_.positions);
    energy_.contact->set_held(scene_, bodies_, held_);
    static_cast<void>(energy_.contact->set_sleepers(islands_.stiffness_of_sleepers()));
}

// Takes hold of vertices, and lets go of them, as constraints ask for in the step that begins.
template <int Dim>
void Simulation<Dim>::Stepper::hold_and_release() {
    const std::vector<std::size_t> changed = held_.hold(steps_, current_.positions);
    for (const std::size_t body : changed) {
        islands_.wake(static_cast<int>(body));
    }
    if (!changed.empty()) {
        number_dofs_of_the_free();
        forget_history();  // what is let go had another acceleration, which BDF2 would carry on
    }
}

// Sets velocities of sleeping bodies to exactly zero, where a formula would leave a rounding error.
template <int Dim>
void Simulation<Dim>::Stepper::still(Positions<Dim>& velocities) const {
    for (std::size_t body = 0; body < bodies_.count(); ++body) {
        if (islands_.states()[body].is_asleep) {
            const auto range = bodies_.vertices(body);
            velocities.middleCols(range.begin, range.size).setZero();
        }
    }
}

// Wakes bodies that a step from the current state moves, or that something touches where the energy
// was evaluated last.
template <int Dim>
bool Simulation<Dim>::Stepper::wake_for(const PrescribedPlaces<Dim>& prescribed) {
    if (islands_.asleep_count() == 0) {
        return false;
    }
    Positions<Dim> to = current_.positions;
    prescribed.put_into(to);
    if (!islands_.wake(energy_.sum.couplings(), current_.positions, to)) {
        return false;
    }
    number_dofs_of_the_awake();
    return true;
}

// Wakes what lies on obstacles that are about to move: at the end of the step, where contacts are
// evaluated, it may be far from them.
template <int Dim>
void Simulation<Dim>::Stepper::wake_on_obstacles(const TimeSpan& step) {
    if (islands_.asleep_count() > 0
        && islands_.wake({.pairs = {}, .driven = energy_.contact->on_moving_obstacles(step)},
                         current_.positions, current_.positions)) {
        number_dofs_of_the_awake();
    }
}

// Breaks what pulls too hard at the end of a step; what it was tied to is awake.
template <int Dim>
void Simulation<Dim>::Stepper::break_springs() {
    if (energy_.attachments == nullptr) {
        return;
    }
    const std::vector<std::size_t> bodies = energy_.attachments->break_springs();
    if (!bodies.empty()) {
        wake(bodies);
        energy_.sum.invalidate();
        evaluate_current();
    }
}

// Lets bodies fall asleep at the end of a step.
template <int Dim>
void Simulation<Dim>::Stepper::put_to_sleep() {
    if (!islands_.is_on()
        || !islands_.put_to_sleep(energy_.sum.couplings(), held_, current_.velocities,
                                  energy_.contact->stiffness())) {
        return;
    }
    still(current_.velocities);
    if (history_.positions.cols() > 0) {  // what BDF2 looks back to is rest, too
        for (std::size_t body = 0; body < bodies_.count(); ++body) {
            if (islands_.states()[body].is_asleep) {
                const auto range = bodies_.vertices(body);
                history_.positions.middleCols(range.begin, range.size) =
                    current_.positions.middleCols(range.begin, range.size);
            }
        }
        still(history_.velocities);
    }
    number_dofs_of_the_awake();
    evaluate_current();
}

template <int Dim>
void Simulation<Dim>::Stepper::add_work(StepReport& report) {
    const SolveWork work = potential_.take_work();
    report.iterations = work.iterations;
    report.residual = work.residual;
    report.unknowns = work.unknowns;
    report.hessians = work.hessians;
    report.filtered = bodies_.sharing.sum(work.filtered);
    report.damping_hessians = potential_.take_damping_hessians();
    report.assembly_seconds = work.assembly_seconds;
    report.solve_seconds = work.solve_seconds;
    report.contact = energy_.contact->summary();
    static_cast<ContactWork&>(report.contact) = energy_.contact->take_work();
    report.contact.seconds += energy_.contact->is_empty() ? 0 : work.stencil_seconds;
    report.contact.friction = energy_.friction != nullptr ? energy_.friction->take_count() : 0;
    report.contact.stiffness = energy_.contact->stiffness();
}

template <int Dim>
StepReport Simulation<Dim>::Stepper::step() {
    const Stopwatch watch;
    refuse_disagreement(bodies_.sharing, current_.positions, steps_);
    hold_and_release();
    const TimeSpan span{time(), time() + scene_.dt()};
    wake_on_obstacles(span);
    held_.begin_step_of_host(current_.positions, span.begin, span.end);
    // Positions at the start, for the work of activations, if there is any in the step.
    const bool is_driven = !strain().changing_bodies(span.begin, span.end).empty();
    const Positions<Dim> start = is_driven ? current_.positions : Positions<Dim>(Dim, 0);
    const double stiffness_before = energy_.contact->stiffness();
    StepReport work_between;  // what was evaluated between steps counts in no step: dropped
    add_work(work_between);
    StepReport report;
    const Attempts attempts = workers_.run([&] { return advance(time(), scene_.dt(), 0); });
    report.is_accepted = attempts.outcome == Outcome::Taken;
    report.failure = attempts.failure;
    report.substeps = attempts.taken;
    report.refused = attempts.refused;
    report.damped = attempts.damped;
    report.newton_iterations = attempts.newton_iterations;
    report.unbalanced = attempts.unbalanced;
    if (report.is_accepted) {
        if (is_driven) {
            report.activation_work =
                energy_.elasticity->activation_work(start, current_.positions, span);
        }
        ++steps_;
        energy_.grabs->arrive();
        evaluate_current();
        break_springs();
        put_to_sleep();
    } else {
        energy_.contact->set_stiffness(stiffness_before);
        energy_.sum.invalidate();
        evaluate_anew();
    }
    report.step = steps_;
    report.time = time();
    report.asleep = islands_.asleep_count();
    report.inverted = energy_.elasticity->inverted_cells(current_.positions);
    report.collapsed = energy_.elasticity->collapsed();
    report.energies = energies();
    if (scene_.output.balance) {
        report.momentum = momentum<Dim>(bodies_.masses, current_.velocities);
        report.angular_momentum =
            angular_momentum<Dim>(bodies_.masses, current_.positions, current_.velocities);
    }
    report.constraints = constraint_summaries(held_, current_.positions, forces_);
    if (energy_.attachments != nullptr) {
        report.attachments = energy_.attachments->summaries();
    }
    report.regions = regions();
    add_work(report);
    report.seconds = watch.seconds();
    return report;
}

template <int Dim>
std::vector<RegionSummary> Simulation<Dim>::Stepper::regions() const {
    std::vector<RegionSummary> all;
    const std::vector<double> elastic = energy_.elasticity->energy_of_ranges();
    for (std::size_t range = 0; range < bodies_.ranges.size(); ++range) {
        if (bodies_.ranges[range].region > 0) {
            all.push_back({elastic[range]});
        }
    }
    return all;
}

template <int Dim>
Positions<Dim> Simulation<Dim>::Stepper::contact_forces() const {
    Positions<Dim> all = Positions<Dim>::Zero(Dim, bodies_.vertex_count());
    if (energy_.contact->is_empty()) {
        return all;
    }
    all = -energy_.contact->gradient();
    if (energy_.friction != nullptr && energy_.friction->gradient().cols() > 0) {
        all -= energy_.friction->gradient();
    }
    return all;
}

template <int Dim>
SimulationSize Simulation<Dim>::Stepper::size() const {
    SimulationSize size;
    size.vertices = bodies_.vertex_count();
    size.cells = bodies_.cell_count;
    size.own_vertices = bodies_.sharing.own_count(bodies_.vertex_count());
    size.ghosts = energy_.elasticity->ghost_count();
    size.free_vertices = potential_.dofs().count();
    size.elements = energy_.elasticity->element_count();
    size.matrix_blocks = energy_.elasticity->block_count();
    // Per vertex: positions, velocities, forces and their copies; per unknown: the solver's.
    constexpr std::int64_t kVertexVectors = 8;
    constexpr std::int64_t kUnknownVectors = 6;
    size.element_bytes = energy_.elasticity->bytes();
    size.matrix_bytes =
        size.matrix_blocks * potential_.bytes_per_block() + potential_.factor_bytes();
    size.contact_bytes = energy_.contact->bytes();
    size.bytes = size.element_bytes + size.contact_bytes + size.matrix_bytes
                 + potential_.tangent_bytes()
                 + static_cast<std::int64_t>(sizeof(double)) * Dim
                       * (kVertexVectors * size.vertices + kUnknownVectors * size.free_vertices);
    return size;
}

#define PENT_INSTANTIATE(Dim) template class Simulation<Dim>::Stepper;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
