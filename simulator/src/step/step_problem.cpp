#include "step/step_problem.h"

#include <pent/dimensions.h>

namespace pent::simulator {

template <int Dim>
StepProblem<Dim> euler_problem(const State<Dim>& now, double h) {
    StepProblem<Dim> problem;
    problem.scale = h * h;
    problem.rate = 1 / h;
    problem.target = now.positions + h * now.velocities;
    problem.origin = now.positions;
    return problem;
}

template <int Dim>
StepProblem<Dim> bdf2_problem(const State<Dim>& now, const State<Dim>& before, double h) {
    StepProblem<Dim> problem;
    problem.scale = 4 * h * h / 9;
    problem.rate = 1.5 / h;
    problem.origin = (4 * now.positions - before.positions) / 3;
    problem.target = problem.origin + (2 * h / 9) * (4 * now.velocities - before.velocities);
    return problem;
}

template <int Dim>
StepProblem<Dim> static_problem(const State<Dim>& now, double h) {
    StepProblem<Dim> problem;
    problem.inertia = 0;
    problem.scale = 1;
    problem.rate = 1 / h;
    problem.target = now.positions;
    problem.origin = now.positions;
    return problem;
}

template <int Dim>
StepProblem<Dim> step_problem(Integrator integrator,
                              const State<Dim>& now,
                              const State<Dim>* before,
                              double h) {
    switch (integrator) {
        case Integrator::Quasistatic:
            return static_problem(now, h);
        case Integrator::Bdf2:
            if (before != nullptr) {
                return bdf2_problem(now, *before, h);
            }
            break;
        case Integrator::LinearEuler:
        case Integrator::NewtonEuler:
            break;
    }
    return euler_problem(now, h);
}

#define PENT_INSTANTIATE(Dim)                                                                \
    template StepProblem<Dim> euler_problem(const State<Dim>&, double);                      \
    template StepProblem<Dim> bdf2_problem(const State<Dim>&, const State<Dim>&, double);    \
    template StepProblem<Dim> static_problem(const State<Dim>&, double);                     \
    template StepProblem<Dim> step_problem(Integrator, const State<Dim>&, const State<Dim>*, \
                                           double);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
