#include "potential.h"

#include <limits>

namespace pent::simulator {

namespace {

// The linear solves of Newton's method need not be more exact than this: each iteration then gains
// two digits, which is what its quadratic model is good for.
constexpr double kForcing = 1e-2;

}  // namespace

template <int Dim>
Positions<Dim> held_shift(const World<Dim>& world,
                          const StepProblem<Dim>& problem,
                          const Positions<Dim>& x) {
    Positions<Dim> shift = Positions<Dim>::Zero(Dim, x.cols());
    for (const HeldSet<Dim>& held : world.held) {
        for (const std::uint32_t vertex : held.vertices) {
            shift.col(vertex) = problem.held.col(vertex) - x.col(vertex);
        }
    }
    return shift;
}

template <int Dim>
Potential<Dim> potential(const System<Dim>& system,
                         const World<Dim>& world,
                         const StepProblem<Dim>& problem,
                         const BodyState<Dim>& state) {
    const Numbering& numbering = world.numbering;
    const Damping damping = system.damping();
    const double drag = problem.scale * problem.rate * damping.mass;
    const Energies& energies = state.energies;
    Potential<Dim> phi;
    phi.value = problem.scale
                * (energies.elastic + energies.gravity + energies.obstacle + energies.contact
                   + energies.friction);
    phi.rounding = problem.scale * world.large_energy * std::numeric_limits<double>::epsilon();
    phi.gradient.resize(Dim, numbering.free_count());
    BlockVector<Dim> travel(Dim, numbering.free_count());
    for (std::uint32_t unknown = 0; unknown < numbering.free_count(); ++unknown) {
        const std::uint32_t vertex = numbering.vertex_of_unknown[unknown];
        const double mass = world.masses[vertex];
        const Vector<Dim> lag = state.positions.col(vertex) - problem.target.col(vertex);
        travel.col(unknown) = state.positions.col(vertex) - problem.origin.col(vertex);
        phi.value +=
            0.5 * mass
            * (problem.inertia * lag.squaredNorm() + drag * travel.col(unknown).squaredNorm());
        phi.gradient.col(unknown) = problem.inertia * mass * lag + drag * mass * travel.col(unknown)
                                    - problem.scale * state.forces.col(vertex);
    }
    if (damping.stiffness > 0) {
        const double factor = problem.scale * problem.rate * damping.stiffness;
        const BlockVector<Dim> resistance = system.damping_product(travel);
        phi.gradient += factor * (resistance + system.held_damping());
        phi.value += factor
                     * (0.5 * resistance.cwiseProduct(travel).sum()
                        + system.held_damping().cwiseProduct(travel).sum());
    }
    return phi;
}

template <int Dim>
LinearStep<Dim> newton_step(const System<Dim>& system,
                            const StepProblem<Dim>& problem,
                            const Potential<Dim>& phi) {
    const Damping damping = system.damping();
    LinearStep<Dim> step;
    step.mass_factor = problem.inertia + problem.scale * problem.rate * damping.mass;
    step.elastic_factor = problem.scale;
    step.contact_factor = problem.scale;
    step.damping_factor = problem.scale * problem.rate * damping.stiffness;
    step.right = -phi.gradient;
    step.tolerance = kForcing;
    return step;
}

template <int Dim>
void add_to_free(const World<Dim>& world,
                 double factor,
                 const BlockVector<Dim>& dx,
                 Positions<Dim>& x) {
    for (std::uint32_t unknown = 0; unknown < world.numbering.free_count(); ++unknown) {
        x.col(world.numbering.vertex_of_unknown[unknown]) += factor * dx.col(unknown);
    }
}

bool has_solved(const LinearSolveReport& solved, StepReport& report) {
    if (!solved.has_converged) {
        report.failure = solved.has_broken_down ? "the matrix was not positive definite"
                         : solved.has_lost_inertia
                             ? "the stiffness drowns the inertia; take smaller steps, softer"
                               " or denser bodies, or thicker cells"
                             : "the linear solver did not reach its tolerance";
    }
    return solved.has_converged;
}

#define PENT_INSTANTIATE(Dim)                                                          \
    template Potential<Dim> potential(const System<Dim>&, const World<Dim>&,           \
                                      const StepProblem<Dim>&, const BodyState<Dim>&); \
    template Positions<Dim> held_shift(const World<Dim>&, const StepProblem<Dim>&,     \
                                       const Positions<Dim>&);                         \
    template LinearStep<Dim> newton_step(const System<Dim>&, const StepProblem<Dim>&,  \
                                         const Potential<Dim>&);                       \
    template void add_to_free(const World<Dim>&, double, const BlockVector<Dim>&, Positions<Dim>&);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
