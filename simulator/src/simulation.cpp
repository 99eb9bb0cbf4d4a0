#include "crossing_error.h"
#include "step_problem.h"
#include "system.h"
#include "world.h"

#include <pent/error.h>
#include <pent/simulator/simulation.h>

#include <chrono>
#include <utility>

namespace pent::simulator {

template <int Dim>
class Simulation<Dim>::State {
public:
    State(const Scene& scene,
          std::vector<SimplexMesh<Dim>> meshes,
          const SimulationOptions& options)
        : scene_(scene),
          world_(make_world(scene, std::move(meshes))),
          system_(scene, world_, options),
          extent_((world_.rest.rowwise().maxCoeff() - world_.rest.rowwise().minCoeff()).norm()) {
        current_.positions = world_.rest;
        current_.velocities = start_velocities(scene, world_);
        place_held(world_, 0, current_.positions, &current_.velocities);
        refuse_crossings();
        system_.evaluate(current_);
    }

    StepReport step();

    [[nodiscard]] double time() const { return static_cast<double>(steps_) * scene_.dt(); }
    [[nodiscard]] const World<Dim>& world() const { return world_; }
    [[nodiscard]] const System<Dim>& system() const { return system_; }
    [[nodiscard]] BodyState<Dim>& current() {
        if (is_stale_) {
            refuse_crossings();
            system_.evaluate(current_);
            is_stale_ = false;
        }
        return current_;
    }
    [[nodiscard]] bool has_history() const { return has_history_; }
    [[nodiscard]] History<Dim>& history() { return history_; }
    void set_has_history() { has_history_ = true; }
    [[nodiscard]] std::uint64_t steps() const { return steps_; }
    void set_steps(std::uint64_t steps) { steps_ = steps; }
    void set_stale() { is_stale_ = true; }

private:
    bool advance(double time, double h, int depth, StepReport& report);
    bool attempt(double time, double h, StepReport& report);
    [[nodiscard]] StepProblem<Dim> make_problem(double time, double h) const;
    void set_velocities(const StepProblem<Dim>& problem, double time);
    [[nodiscard]] bool is_sane() const;
    void refuse_crossings() const;
    [[nodiscard]] ContactSummary contact_summary();

    Scene scene_;
    World<Dim> world_;
    System<Dim> system_;
    double extent_;  // diagonal of the box around all bodies at rest, m
    BodyState<Dim> current_;
    BodyState<Dim> next_;
    History<Dim> history_;  // the state one step of full length ago, for BDF2
    bool has_history_ = false;
    std::uint64_t steps_ = 0;
    bool is_stale_ = false;  // forces and energies do not belong to positions and velocities
};

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
}

// Whether the new state is finite and within bounds that only a failed step leaves.
template <int Dim>
bool Simulation<Dim>::State::is_sane() const {
    constexpr double kMostExtents = 1e3;
    return next_.is_finite()
           && (next_.positions - current_.positions).cwiseAbs().maxCoeff() < kMostExtents * extent_;
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

template <int Dim>
bool Simulation<Dim>::State::attempt(double time, double h, StepReport& report) {
    const StepProblem<Dim> problem = make_problem(time, h);
    const bool is_linear =
        scene_.solver.integrator == Integrator::LinearEuler || world_.numbering.free_count() == 0;
    system_.begin_step(current_, is_linear, h);
    const bool is_solved =
        is_linear ? take_linear_step(system_, world_, problem, current_, next_.positions, report)
                  : minimize(system_, world_, problem, current_, extent_, next_, report);
    if (!is_solved) {
        return false;
    }
    set_velocities(problem, time + h);
    system_.evaluate(next_);
    if (!is_sane()) {
        report.failure = "the motion grew beyond all bounds";
        return false;
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
    const ContactSummary work = system_.take_contact_work();
    ContactSummary summary = current_.contacts ? current_.contacts->summary : ContactSummary();
    summary.searches = work.searches;
    summary.candidates = work.candidates;
    summary.trees_built = work.trees_built;
    summary.trees_refit = work.trees_refit;
    summary.ccd_seconds = work.ccd_seconds;
    summary.stiffness = system_.contacts().stiffness();
    summary.seconds = work.seconds;
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
        report.failure.clear();
    } else {
        current_ = before;
        history_ = history_before;
        has_history_ = had_history;
    }
    report.step = steps_;
    report.time = time();
    report.inverted = current_.inverted;
    report.collapsed = current_.collapsed;
    report.energies = current_.energies;
    report.contact = contact_summary();
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
}

template <int Dim>
Simulation<Dim>::Simulation(const Scene& scene,
                            std::vector<SimplexMesh<Dim>> meshes,
                            const SimulationOptions& options)
    : state_(std::make_unique<State>(scene, std::move(meshes), options)) {}

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
    BodyState<Dim>& current = state_->current();
    current.positions.middleCols(first, count) = positions;
    current.velocities.middleCols(first, count) = velocities;
    state_->set_stale();
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
