#pragma once

#include "model/bodies.h"
#include "model/held_vertices.h"
#include "potentials/scene_energy.h"
#include "step/incremental_potential.h"
#include "step/newton.h"
#include "step/sleep.h"
#include "step/step_problem.h"

#include <pent/parallel.h>
#include <pent/simulator/simulation.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pent::simulator {

/// The implementation of Simulation: its state, how it takes a step, and who sleeps. Between calls
/// the potential energy has been evaluated at the current positions.
template <int Dim>
class Simulation<Dim>::Stepper {
public:
    using Holdings = std::vector<typename HostState<Dim>::Holding>;

    /// @param bodies  Of the scene, shared by the ranks of the options.
    Stepper(const Scene& scene, Bodies<Dim> bodies, const SimulationOptions& options);
    Stepper(const Scene& scene,
            std::vector<SimplexMesh<Dim>> meshes,
            const SimulationOptions& options);

    /// Checks the start for crossings and finds its forces. Throws a CrossingError as the
    /// constructor of Simulation does.
    void start();

    StepReport step();
    void set_body(int body, const Positions<Dim>& positions, const Positions<Dim>& velocities);
    /// Goes on with a scene that differs in its obstacles, and wakes bodies. Throws a
    /// CrossingError, and changes nothing, where a barrier does not allow it.
    void set_obstacles(Scene scene, const std::vector<std::size_t>& woken);
    [[nodiscard]] Snapshot<Dim> save() const;
    void restore(const Snapshot<Dim>& snapshot);

    // What a host does; see Simulation, which checks it.
    void set_held(const std::map<std::uint32_t, Vector>& targets);
    void set_grabs(const Holdings& grabs, std::uint64_t next, int body);  // wakes the body
    [[nodiscard]] const Holdings& grabs() const { return energy_.grabs->holdings(); }
    [[nodiscard]] std::uint64_t next_grab() const { return next_grab_; }
    void set_forces(int body, const Positions<Dim>& forces);
    void set_gravity(const Vector& gravity);
    [[nodiscard]] HostState<Dim> host() const;

    /// Bodies that touch, or are tied to, a body, or that touch an obstacle.
    [[nodiscard]] std::vector<std::size_t> neighbors_of_body(std::size_t body) const;
    [[nodiscard]] std::vector<std::size_t> neighbors_of_obstacle(std::size_t obstacle) const;
    void wake(const std::vector<std::size_t>& bodies);

    [[nodiscard]] double time() const { return static_cast<double>(steps_) * scene_.dt(); }
    [[nodiscard]] std::uint64_t steps() const { return steps_; }
    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const SimulationOptions& options() const { return options_; }
    [[nodiscard]] const Bodies<Dim>& bodies() const { return bodies_; }
    [[nodiscard]] const HeldVertices<Dim>& held() const { return held_; }
    [[nodiscard]] const State<Dim>& current() const { return current_; }
    [[nodiscard]] const Positions<Dim>& forces() const { return forces_; }
    [[nodiscard]] Positions<Dim> contact_forces() const;
    [[nodiscard]] const ContactPotential<Dim>& contact() const { return *energy_.contact; }
    [[nodiscard]] const ActiveStrain<Dim>& strain() const { return energy_.elasticity->strain(); }
    [[nodiscard]] const std::vector<SleepState>& sleep() const { return islands_.states(); }
    [[nodiscard]] Energies energies() const;
    [[nodiscard]] SimulationSize size() const;
    [[nodiscard]] Isa isa() const { return isa_; }

private:
    enum class Method { Linear, Newton, Damped };   // the last where a linear step has diverged
    enum class Outcome { Taken, Astray, Refused };  // astray: diverged, a damped step may succeed
    // What became of one attempt at a step or of several; the outcome is that of the last.
    struct Attempts {
        Outcome outcome = Outcome::Taken;
        std::string failure;  // why the last one that failed did; empty if none did
        int taken = 0;
        int refused = 0;
        int damped = 0;  // of those taken
        int newton_iterations = 0;
        double unbalanced = 0;  // the largest

        void add(const Attempts& later);
        [[nodiscard]] Attempts refuse(std::string reason, Outcome how) const;
    };
    [[nodiscard]] Attempts advance(double time, double h, int depth);
    [[nodiscard]] Attempts attempt(double time, double h, bool is_damped);
    [[nodiscard]] Method choose_method() const;
    [[nodiscard]] double negligible_correction() const;
    void begin(const std::shared_ptr<const StepProblem<Dim>>& problem, double h, Method method);
    [[nodiscard]] NewtonReport solve(const StepProblem<Dim>& problem, Method method);
    [[nodiscard]] NewtonReport minimize(Method method);
    [[nodiscard]] NewtonReport minimize_bounded(const StepProblem<Dim>& problem);
    [[nodiscard]] StepProblem<Dim> make_problem(double time, double h) const;
    void set_velocities(const StepProblem<Dim>& problem, double time);
    [[nodiscard]] std::string excess(const Energies& before, Method method) const;
    [[nodiscard]] std::string tunneling() const;
    [[nodiscard]] bool wake_for(const PrescribedPlaces<Dim>& prescribed);
    void wake_on_obstacles(const TimeSpan& step);
    bool restore_host(const HostState<Dim>& host);
    void break_springs();
    void put_to_sleep();
    void still(Positions<Dim>& velocities) const;
    void number_dofs_of_the_awake();
    void number_dofs_of_the_free();
    void hold_and_release();
    void forget_history() { history_ = {}; }
    void evaluate_current();
    void evaluate_anew();
    [[nodiscard]] TimeSpan last_step() const;
    [[nodiscard]] bool moves_sleepers(const Positions<Dim>& to) const;
    void refuse_crossings(const Positions<Dim>& positions,
                          const HeldVertices<Dim>& held,
                          double time) const;
    void add_work(StepReport& report);
    [[nodiscard]] std::vector<std::uint8_t> broken_springs() const;
    [[nodiscard]] std::vector<RegionSummary> regions() const;
    [[nodiscard]] double kinetic_energy(const Positions<Dim>& velocities) const;

    SimulationOptions options_;
    Scene scene_;
    Workers workers_;
    Isa isa_;
    const Kernels<Dim>* kernels_;
    const Bodies<Dim> bodies_;
    HeldVertices<Dim> held_;
    SceneEnergy<Dim> energy_;
    IncrementalPotential<Dim> potential_;
    Islands<Dim> islands_;
    std::vector<bool> asleep_;  // bodies that have no dofs now
    double extent_;             // diagonal of the box around all bodies at rest, m
    double smallest_;           // the least diagonal of the boxes around bodies at rest, m
    double thinnest_;           // least thickness of bodies at rest, m
    State<Dim> current_;
    State<Dim> next_;
    Positions<Dim> forces_;  // at the current positions, N
    State<Dim> history_;     // one step of full length ago, for BDF2; else no columns
    std::uint64_t steps_ = 0;
    std::optional<Vector> gravity_;  // in place of the scene's, if a host has set it
    std::uint64_t next_grab_ = 1;
};

}  // namespace pent::simulator
