#include "step/step_problem.h"

#include <pent/simulator/words.h>

#include <gtest/gtest.h>

#include <cmath>

namespace pent::simulator {
namespace {

// One particle of mass 1 on a spring of stiffness k: with the numbers of a StepProblem the end of a
// step solves inertia (x - target) + scale k x = 0, and its velocity is rate (x - origin).
State<3> step_of(const StepProblem<3>& problem, double k) {
    State<3> end;
    end.positions = problem.inertia * problem.target / (problem.inertia + problem.scale * k);
    end.velocities = problem.rate * (end.positions - problem.origin);
    return end;
}

State<3> at(double x, double v) {
    return {Eigen::Vector3d::Constant(x), Eigen::Vector3d::Constant(v)};
}

constexpr double kSpring = 4;  // frequency 2

// How far the particle is from cos(2 t) after a second in so many steps.
double error_of(bool is_bdf2, int steps) {
    const double h = 1.0 / steps;
    State<3> before = at(std::cos(2 * h), 2 * std::sin(2 * h));  // at -h
    State<3> now = at(1, 0);
    for (int i = 0; i < steps; ++i) {
        const StepProblem<3> problem =
            is_bdf2 ? bdf2_problem<3>(now, before, h) : euler_problem<3>(now, h);
        before = now;
        now = step_of(problem, kSpring);
    }
    return std::abs(now.positions(0) - std::cos(2.0));
}

TEST(EulerProblem, IsOfFirstOrder) {
    EXPECT_NEAR(error_of(false, 200) / error_of(false, 400), 2, 0.1);
}

TEST(Bdf2Problem, IsOfSecondOrder) {
    EXPECT_NEAR(error_of(true, 200) / error_of(true, 400), 4, 0.2);
}

// A body that nothing pulls at moves on evenly, whatever the formula.
TEST(StepProblem, KeepsEvenMotion) {
    const State<3> before = at(0.1, 0.7);
    const double h = 0.25;
    const State<3> now = at(0.1 + 0.7 * h, 0.7);
    for (const StepProblem<3>& problem :
         {euler_problem<3>(now, h), bdf2_problem<3>(now, before, h)}) {
        const State<3> end = step_of(problem, 0);
        EXPECT_NEAR(end.positions(0), 0.1 + 2 * 0.7 * h, 1e-15);
        EXPECT_NEAR(end.velocities(0), 0.7, 1e-14);
    }
}

TEST(StepProblem, IsThatOfTheIntegrator) {
    const State<3> before = at(0.1, 0.7);
    const State<3> now = at(0.4, 0.5);
    const double h = 0.25;
    const auto target = [&](Integrator integrator, const State<3>* earlier) {
        return step_problem<3>(integrator, now, earlier, h).target(0);
    };
    for (const Integrator one : values<Integrator>()) {
        const double expected = one == Integrator::Bdf2 ? bdf2_problem<3>(now, before, h).target(0)
                                : one == Integrator::Quasistatic ? now.positions(0)
                                                                 : now.positions(0) + h * 0.5;
        EXPECT_EQ(target(one, &before), expected) << word_of(one);
    }
    // Of the first step BDF2 has no past: it is one of Euler's.
    EXPECT_EQ(target(Integrator::Bdf2, nullptr), target(Integrator::NewtonEuler, nullptr));
}

TEST(StaticProblem, HasNoInertiaAndTheVelocityOfTheWay) {
    const StepProblem<3> problem = static_problem<3>(at(0.3, 5), 0.1);
    EXPECT_EQ(problem.inertia, 0);
    EXPECT_GT(problem.scale, 0);
    EXPECT_NEAR(problem.rate * (0.5 - problem.origin(0)), 2, 1e-14);  // 0.2 m in 0.1 s
}

}  // namespace
}  // namespace pent::simulator
