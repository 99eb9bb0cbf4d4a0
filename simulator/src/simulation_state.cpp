#include "simulation_state.h"

#include "crossing_error.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <utility>

namespace pent::simulator {

namespace {

// Shortest side of the boxes around bodies at rest, m.
template <int Dim>
double thinnest(const World<Dim>& world) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const SimplexMesh<Dim>& mesh : world.meshes) {
        const Vector<Dim> sides =
            mesh.positions.rowwise().maxCoeff() - mesh.positions.rowwise().minCoeff();
        shortest = std::min(shortest, sides.minCoeff());
    }
    return shortest;
}

}  // namespace

template <int Dim>
Simulation<Dim>::State::State(const Scene& scene,
                              std::vector<SimplexMesh<Dim>> meshes,
                              const SimulationOptions& options)
    : scene_(scene),
      world_(make_world(scene, std::move(meshes))),
      system_(scene, world_, options),
      sleepers_(scene, world_),
      asleep_(sleepers_.asleep()),
      extent_((world_.rest.rowwise().maxCoeff() - world_.rest.rowwise().minCoeff()).norm()),
      thinnest_(thinnest(world_)) {
    current_.positions = world_.rest;
    current_.velocities = start_velocities(scene, world_);
    place_held(world_, 0, current_.positions, &current_.velocities);
    refuse_crossings();
    system_.evaluate(current_);
}

template <int Dim>
BodyState<Dim>& Simulation<Dim>::State::current() {
    if (is_stale_) {
        refuse_crossings();
        renumber();
        is_stale_ = false;
    }
    return current_;
}

template <int Dim>
void Simulation<Dim>::State::set_body(int body,
                                      const Positions<Dim>& positions,
                                      const Positions<Dim>& velocities) {
    const Eigen::Index first = world_.first_vertex[static_cast<std::size_t>(body)];
    // Bodies change places one by one: what lies between may cross, and is not looked at.
    current_.positions.middleCols(first, positions.cols()) = positions;
    current_.velocities.middleCols(first, velocities.cols()) = velocities;
    sleepers_.wake(body);
    is_stale_ = true;
}

template <int Dim>
void Simulation<Dim>::State::set_rest(const std::vector<BodyRest>& rest) {
    sleepers_.set_rest(rest);
    is_stale_ = true;
}

template <int Dim>
StepProblem<Dim> Simulation<Dim>::State::make_problem(double time, double h) const {
    const auto choose = [&] {
        switch (scene_.solver.integrator) {
            case Integrator::Quasistatic:
                return static_problem(current_, h);
            case Integrator::Bdf2:
                if (has_history_ && h == scene_.dt()) {
                    return bdf2_problem(current_, history_, h);
                }
                break;  // the first step, and steps cut in two, which have no even past
            case Integrator::LinearEuler:
            case Integrator::NewtonEuler:
                break;
        }
        return euler_problem(current_, h);
    };
    StepProblem<Dim> problem = choose();
    problem.time = time + h;
    problem.held = current_.positions;
    place_held<Dim>(world_, time + h, problem.held, nullptr);
    return problem;
}

template <int Dim>
void Simulation<Dim>::State::set_velocities(const StepProblem<Dim>& problem, double time) {
    next_.velocities = problem.rate * (next_.positions - problem.origin);
    place_held(world_, time, next_.positions, &next_.velocities);
    still(next_.velocities);
}

// Empty unless the new state is beyond bounds that only a failed step leaves.
template <int Dim>
std::string Simulation<Dim>::State::complaint() const {
    constexpr double kMostExtents = 1e3;
    constexpr double kMostGrowth = 1e2;
    if (!next_.is_finite()
        || (next_.positions - current_.positions).cwiseAbs().maxCoeff() >= kMostExtents * extent_) {
        return "the motion grew beyond all bounds";
    }
    const double before = current_.energies.elastic + current_.energies.kinetic;
    if (!(next_.energies.elastic
          < kMostGrowth * (world_.large_energy + before + next_.energies.kinetic))) {
        return "the elastic energy grew a hundred times; take smaller steps, or newton_euler, which"
               " comes back from far";
    }
    return has_leapt() ? "in contact something moved by more than the extent of the thinnest body:"
                         " bodies could pass through each other unseen; take smaller steps"
                       : "";
}

// Whether penalties, which see only what is near or inside at the end of a step, can have missed something.
template <int Dim>
bool Simulation<Dim>::State::has_leapt() const {
    if (!scene_.contact || scene_.contact->model != ContactModel::Penalty) {
        return false;
    }
    const Positions<Dim> moves = next_.positions - current_.positions;
    const Vector<Dim> mean = moves.rowwise().mean();
    return (moves.colwise() - mean).colwise().norm().maxCoeff() > thinnest_;
}

// Throws unless the barrier finds nothing that crosses.
template <int Dim>
void Simulation<Dim>::State::refuse_crossings() const {
    const std::vector<contact::Crossing> crossings =
        system_.contacts().find_crossings(system_.workers(), current_.positions);
    if (!crossings.empty()) {
        throw crossing_error(world_, system_.contacts(), crossings, current_.positions);
    }
}

// Gives unknowns to the bodies that are awake, and to no other.
template <int Dim>
void Simulation<Dim>::State::renumber() {
    std::vector<bool> asleep = sleepers_.asleep();
    if (asleep != asleep_) {
        asleep_ = std::move(asleep);
        std::vector<bool> awake = asleep_;
        awake.flip();
        world_.numbering = number_bodies(world_, awake);
        system_.renumber(asleep_, current_.positions);
    }
    system_.evaluate(current_);
}

// What sleeps does not move: exactly, where a formula would leave a rounding error.
template <int Dim>
void Simulation<Dim>::State::still(Positions<Dim>& velocities) const {
    for (std::size_t body = 0; body < sleepers_.rest().size(); ++body) {
        if (sleepers_.rest()[body].is_asleep) {
            const Eigen::Index first = world_.first_vertex[body];
            velocities.middleCols(first, world_.first_vertex[body + 1] - first).setZero();
        }
    }
}

// Wakes bodies that a step from the current state moves or that something touches in `state`.
template <int Dim>
bool Simulation<Dim>::State::wake(const BodyState<Dim>& state, const StepProblem<Dim>& problem) {
    if (!sleepers_.wake(state.contacts.get(), current_.positions, problem.held)) {
        return false;
    }
    renumber();
    return true;
}

// Lets bodies fall asleep at the end of a step.
template <int Dim>
void Simulation<Dim>::State::settle() {
    if (!sleepers_.settle(current_.contacts.get(), current_.velocities)) {
        return;
    }
    still(current_.velocities);
    if (has_history_) {  // what BDF2 looks back to is rest, too
        const Positions<Dim> before = history_.positions;
        history_.positions = current_.positions;
        for (std::size_t body = 0; body < asleep_.size(); ++body) {
            const Eigen::Index first = world_.first_vertex[body];
            const Eigen::Index count = world_.first_vertex[body + 1] - first;
            if (!sleepers_.rest()[body].is_asleep) {
                history_.positions.middleCols(first, count) = before.middleCols(first, count);
            }
        }
        still(history_.velocities);
    }
    renumber();
}

template <int Dim>
bool Simulation<Dim>::State::attempt(double time, double h, StepReport& report) {
    const StepProblem<Dim> problem = make_problem(time, h);
    static_cast<void>(wake(current_, problem));
    const bool is_linear = scene_.solver.integrator == Integrator::LinearEuler
                           || (world_.numbering.free_count() == 0 && sleepers_.count() == 0);
    system_.begin_step(current_, is_linear, h);
    const bool is_solved =
        is_linear ? take_linear_step(system_, world_, problem, current_, next_.positions, report)
                  : minimize(system_, world_, problem, current_, extent_, next_, report);
    if (!is_solved) {
        return false;
    }
    set_velocities(problem, time + h);
    system_.evaluate(next_);
    if (const std::string found = complaint(); !found.empty()) {
        report.failure = found;
        return false;
    }
    // Newton's method has forces at the end of the step: what was run into there has to give way.
    if (!is_linear && wake(next_, problem)) {
        return attempt(time, h, report);
    }
    if (scene_.solver.integrator == Integrator::Bdf2) {
        history_ = {current_.positions, current_.velocities};
        has_history_ = h == scene_.dt();
    }
    std::swap(current_, next_);
    return true;
}

template <int Dim>
bool Simulation<Dim>::State::advance(double time, double h, int depth, StepReport& report) {
    if (attempt(time, h, report)) {
        ++report.substeps;
        return true;
    }
    ++report.refused;
    return depth < scene_.solver.max_halvings && advance(time, h / 2, depth + 1, report)
           && advance(time + h / 2, h / 2, depth + 1, report);
}

// What touches now, and the work of contact since this was last asked.
template <int Dim>
ContactSummary Simulation<Dim>::State::contact_summary() {
    ContactSummary summary = current_.contacts ? current_.contacts->summary : ContactSummary();
    static_cast<ContactWork&>(summary) = system_.take_contact_work();
    summary.stiffness = system_.contacts().stiffness();
    return summary;
}

template <int Dim>
StepReport Simulation<Dim>::State::step() {
    const auto start = std::chrono::steady_clock::now();
    const BodyState<Dim> before = current();
    static_cast<void>(system_.take_contact_work());  // of looking at the state between steps
    const History<Dim> history_before = history_;
    const bool had_history = has_history_;
    StepReport report;
    report.is_accepted =
        system_.workers().run([&] { return advance(time(), scene_.dt(), 0, report); });
    if (report.is_accepted) {
        ++steps_;
        settle();
    } else {
        current_ = before;
        history_ = history_before;
        has_history_ = had_history;
    }
    report.step = steps_;
    report.time = time();
    report.asleep = sleepers_.count();
    report.inverted = system_.count_inverted(current_);
    report.collapsed = current_.collapsed;
    report.energies = current_.energies;
    report.contact = contact_summary();
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

template class Simulation<3>::State;
template class Simulation<4>::State;

}  // namespace pent::simulator
