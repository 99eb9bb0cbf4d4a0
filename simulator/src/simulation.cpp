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
        current_.velocities.setZero(Dim, world_.vertex_count());
        place_held(world_, 0, current_.positions, &current_.velocities);
        system_.evaluate(current_);
    }

    StepReport step();

    [[nodiscard]] double time() const { return static_cast<double>(steps_) * scene_.dt(); }
    [[nodiscard]] const World<Dim>& world() const { return world_; }
    [[nodiscard]] const System<Dim>& system() const { return system_; }
    [[nodiscard]] BodyState<Dim>& current() {
        if (is_stale_) {
            system_.evaluate(current_);
            is_stale_ = false;
        }
        return current_;
    }
    [[nodiscard]] std::uint64_t steps() const { return steps_; }
    void set_steps(std::uint64_t steps) { steps_ = steps; }
    void set_stale() { is_stale_ = true; }

private:
    bool advance(double time, double h, int depth, StepReport& report);
    bool attempt(double time, double h, StepReport& report);
    [[nodiscard]] LinearStep<Dim> linear_euler(double time, double h) const;
    bool take_over(double time, double h, const BlockVector<Dim>& dx, StepReport& report);

    Scene scene_;
    World<Dim> world_;
    System<Dim> system_;
    double extent_;  // diagonal of the box around all bodies at rest, m
    BodyState<Dim> current_;
    BodyState<Dim> next_;
    std::uint64_t steps_ = 0;
    bool is_stale_ = false;  // forces and energies do not belong to positions and velocities
};

// Eq. 3 of [shi2025] ([baraff1998]) in the displacement, with C = a M + b K:
//   ((1 + h a) M + (h^2 + h b) K) dx = h^2 f + h M v.
// The damping terms on its right side cancel against the damping force within f.
template <int Dim>
LinearStep<Dim> Simulation<Dim>::State::linear_euler(double time, double h) const {
    const Damping damping = scene_.damping.value_or(Damping{});
    LinearStep<Dim> step;
    step.mass_factor = 1 + h * damping.mass;
    step.stiffness_factor = h * h + h * damping.stiffness;
    step.held_shift.setZero(Dim, world_.vertex_count());
    Positions<Dim> target = current_.positions;
    place_held<Dim>(world_, time + h, target, nullptr);
    for (const HeldSet<Dim>& held : world_.held) {
        for (const std::uint32_t vertex : held.vertices) {
            step.held_shift.col(vertex) = target.col(vertex) - current_.positions.col(vertex);
        }
    }
    const Numbering& numbering = world_.numbering;
    step.right.resize(Dim, numbering.free_count());
    for (std::uint32_t unknown = 0; unknown < numbering.free_count(); ++unknown) {
        const std::uint32_t vertex = numbering.vertex_of_unknown[unknown];
        step.right.col(unknown) = h * h * current_.forces.col(vertex)
                                  + h * world_.masses[vertex] * current_.velocities.col(vertex);
    }
    return step;
}

// Moves to the end of a step unless it is out of all bounds.
template <int Dim>
bool Simulation<Dim>::State::take_over(double time,
                                       double h,
                                       const BlockVector<Dim>& dx,
                                       StepReport& report) {
    // No step that makes sense moves a vertex by many times the size of the scene.
    constexpr double kMostExtents = 1e3;
    next_.positions = current_.positions;
    next_.velocities = current_.velocities;
    const Numbering& numbering = world_.numbering;
    for (std::uint32_t unknown = 0; unknown < numbering.free_count(); ++unknown) {
        const std::uint32_t vertex = numbering.vertex_of_unknown[unknown];
        next_.positions.col(vertex) += dx.col(unknown);
        next_.velocities.col(vertex) = dx.col(unknown) / h;
    }
    place_held(world_, time + h, next_.positions, &next_.velocities);
    system_.evaluate(next_);
    if (!next_.is_finite()
        || !(dx.size() == 0 || dx.cwiseAbs().maxCoeff() < kMostExtents * extent_)) {
        report.failure = "the motion grew beyond all bounds";
        return false;
    }
    std::swap(current_, next_);
    return true;
}

template <int Dim>
bool Simulation<Dim>::State::attempt(double time, double h, StepReport& report) {
    LinearStep<Dim> step = linear_euler(time, h);
    BlockVector<Dim> dx(Dim, world_.numbering.free_count());
    for (std::uint32_t unknown = 0; unknown < world_.numbering.free_count(); ++unknown) {
        dx.col(unknown) = h * current_.velocities.col(world_.numbering.vertex_of_unknown[unknown]);
    }
    if (dx.cols() > 0) {
        const LinearSolveReport solved = system_.solve_step(current_.positions, step, dx, report);
        if (!solved.has_converged) {
            report.failure = solved.has_broken_down
                                 ? "the matrix was not positive definite"
                                 : "the linear solver did not reach its tolerance";
            return false;
        }
    }
    return take_over(time, h, dx, report);
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

template <int Dim>
StepReport Simulation<Dim>::State::step() {
    const auto start = std::chrono::steady_clock::now();
    const BodyState<Dim> before = current();
    StepReport report;
    report.is_accepted =
        system_.workers().run([&] { return advance(time(), scene_.dt(), 0, report); });
    if (report.is_accepted) {
        ++steps_;
        report.failure.clear();
    } else {
        current_ = before;
    }
    report.step = steps_;
    report.time = time();
    report.inverted = current_.inverted;
    report.energies = current_.energies;
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
    if (positions.cols() != count || velocities.cols() != count || !positions.allFinite()
        || !velocities.allFinite()) {
        throw Error("the state of a body must be finite positions and velocities of its "
                    + std::to_string(count) + " vertices");
    }
    BodyState<Dim>& current = state_->current();
    current.positions.middleCols(first, count) = positions;
    current.velocities.middleCols(first, count) = velocities;
    state_->set_stale();
}

template <int Dim>
void Simulation<Dim>::set_step_count(std::uint64_t steps) {
    state_->set_steps(steps);
}

template class Simulation<3>;
template class Simulation<4>;

}  // namespace pent::simulator
