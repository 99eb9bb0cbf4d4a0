#pragma once

#include "sleepers.h"
#include "step_problem.h"
#include "system.h"
#include "world.h"

#include <pent/simulator/simulation.h>

#include <string>
#include <vector>

namespace pent::simulator {

/// What is behind a Simulation: the state, how it takes a step, and who sleeps.
template <int Dim>
class Simulation<Dim>::State {
public:
    State(const Scene& scene,
          std::vector<SimplexMesh<Dim>> meshes,
          const SimulationOptions& options);

    StepReport step();

    [[nodiscard]] double time() const { return static_cast<double>(steps_) * scene_.dt(); }
    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const World<Dim>& world() const { return world_; }
    [[nodiscard]] const System<Dim>& system() const { return system_; }
    [[nodiscard]] BodyState<Dim>& current();
    [[nodiscard]] bool has_history() const { return has_history_; }
    [[nodiscard]] History<Dim>& history() { return history_; }
    void set_has_history() { has_history_ = true; }
    [[nodiscard]] std::uint64_t steps() const { return steps_; }
    void set_steps(std::uint64_t steps) { steps_ = steps; }
    [[nodiscard]] const std::vector<BodyRest>& rest() const { return sleepers_.rest(); }
    void set_rest(const std::vector<BodyRest>& rest);
    void set_body(int body, const Positions<Dim>& positions, const Positions<Dim>& velocities);

private:
    bool advance(double time, double h, int depth, StepReport& report);
    bool attempt(double time, double h, StepReport& report);
    [[nodiscard]] StepProblem<Dim> make_problem(double time, double h) const;
    void set_velocities(const StepProblem<Dim>& problem, double time);
    [[nodiscard]] std::string complaint() const;
    [[nodiscard]] bool has_leapt() const;
    [[nodiscard]] bool wake(const BodyState<Dim>& state, const StepProblem<Dim>& problem);
    void settle();
    void still(Positions<Dim>& velocities) const;
    void renumber();
    void refuse_crossings() const;
    [[nodiscard]] ContactSummary contact_summary();

    Scene scene_;
    World<Dim> world_;
    System<Dim> system_;
    Sleepers<Dim> sleepers_;
    std::vector<bool> asleep_;  // bodies that the numbering leaves out
    double extent_;             // diagonal of the box around all bodies at rest, m
    double thinnest_;           // shortest side of the boxes around bodies at rest, m
    BodyState<Dim> current_;
    BodyState<Dim> next_;
    History<Dim> history_;  // the state one step of full length ago, for BDF2
    bool has_history_ = false;
    std::uint64_t steps_ = 0;
    // Forces and energies do not belong to positions and velocities, nor unknowns to who sleeps.
    bool is_stale_ = false;
};

}  // namespace pent::simulator
