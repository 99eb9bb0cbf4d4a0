#include "step/newton.h"

#include "plain_functions.h"

#include <pent/contact/friction.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

// Newton's method on plain functions: no scene, no bodies, no contact.

namespace pent::simulator {
namespace {

using test::Curvature;
using test::Formula;
using test::kInfinity;
using test::PlainFunction;
using test::point;
using test::rosenbrock;

// Along a bent valley, in which whole steps lead up its sides: downhill all the way.
TEST(Newton, FindsTheEndOfRosenbrocksValleyDownhill) {
    struct Downhill : PlainFunction {
        using PlainFunction::PlainFunction;
        std::vector<double> values;
        bool accept(const Positions<3>& at) override {
            values.push_back(value(at.reshaped()));
            return false;
        }
    };
    Downhill f(rosenbrock());
    Positions<3> x = point(-1.2, 1, 1);
    f.values = {f.value(x.reshaped())};
    const NewtonReport report = newton<3>(f, {.tolerance = 1e-12}, x);
    EXPECT_TRUE(report.has_converged) << report.failure_reason;
    EXPECT_LT((x - point(1, 1, 1)).norm(), 1e-10);
    EXPECT_LE(report.residual, 1e-12);
    ASSERT_EQ(static_cast<int>(f.values.size()), report.iterations + 1);
    EXPECT_TRUE(std::is_sorted(f.values.rbegin(), f.values.rend()));
    EXPECT_GT(f.evaluations, report.iterations + 1);  // some steps had to be cut
    EXPECT_LT(report.iterations, 60);
}

// Where a step has no room the next one has none, either: it is said at once, not after all the
// iterations there may be. Unless the function has changed in between.
TEST(Newton, DoesNotRepeatAStepWithoutRoom) {
    struct Walled : PlainFunction {
        using PlainFunction::PlainFunction;
        int walls = 0;  // that accept() takes away, one after the other
        double max_step(const Positions<3>& /*from*/, const Positions<3>& /*to*/) override {
            return walls > 0 ? 0 : 1;
        }
        bool accept(const Positions<3>& /*at*/) override { return is_moving && walls-- > 0; }
        bool is_moving = false;
    };
    for (const bool may_stop_short : {false, true}) {
        Walled f(rosenbrock());
        f.walls = 1;
        Positions<3> x = point(-1.2, 1, 1);
        const NewtonReport report = newton<3>(f, {.may_stop_short = may_stop_short}, x);
        EXPECT_FALSE(report.has_converged);
        EXPECT_EQ(report.failure_reason, "the line search found no decrease");
        EXPECT_EQ(report.iterations, 1);
        EXPECT_EQ(x, point(-1.2, 1, 1));
    }
    Walled f(rosenbrock());
    f.walls = 3;
    f.is_moving = true;
    Positions<3> x = point(-1.2, 1, 1);
    const NewtonReport report = newton<3>(f, {.tolerance = 1e-12}, x);
    EXPECT_TRUE(report.has_converged) << report.failure_reason;
    EXPECT_LT((x - point(1, 1, 1)).norm(), 1e-10);
}

// From near the end digits double with every iteration: two more of them for 1e-3 to 1e-12.
TEST(Newton, GainsDigitsQuadratically) {
    const auto iterations = [](double tolerance) {
        PlainFunction f(rosenbrock());
        Positions<3> x = point(1.001, 1.002, 1.003);
        const NewtonReport report = newton<3>(f, {.tolerance = tolerance}, x);
        EXPECT_TRUE(report.has_converged);
        return report.iterations;
    };
    EXPECT_LE(iterations(1e-12), iterations(1e-3) + 2);
}

// A stiff x^2, which one iteration solves, beside a soft y^4, of whose gradient each leaves 8/27.
// In the norm of all the soft part is nothing from the first; in one of its own 1e-4 is left after
// eight: log 1e-4 / log 8/27 is 7.6.
TEST(Newton, GoesOnUntilEveryNormIsSmall) {
    const auto iterations = [](bool has_own_norm) {
        struct Two : PlainFunction {
            bool has_own_norm = false;
            GradientNorms norms(const Positions<3>& of) const override {
                return has_own_norm ? GradientNorms{of.norm(), of.col(0).tail(1).norm()}
                                    : PlainFunction::norms(of);
            }
        };
        Two f;
        f.has_own_norm = has_own_norm;
        f.value = [](const Eigen::VectorXd& x) { return 1e9 * x[0] * x[0] + std::pow(x[2], 4); };
        f.gradient = [](const Eigen::VectorXd& x) {
            return Eigen::VectorXd(Eigen::Vector3d(2e9 * x[0], 0, 4 * std::pow(x[2], 3)));
        };
        f.hessian = [](const Eigen::VectorXd& x) {
            return Eigen::MatrixXd(Eigen::Vector3d(2e9, 1, 12 * x[2] * x[2]).asDiagonal());
        };
        Positions<3> x = point(1, 0, 1);
        const NewtonReport report = newton<3>(f, {.tolerance = 1e-4}, x);
        EXPECT_TRUE(report.has_converged) << report.failure_reason;
        EXPECT_LE(report.residual, 1e-4);
        return report.iterations;
    };
    EXPECT_EQ(iterations(false), 1);
    EXPECT_EQ(iterations(true), 8);
}

// m/2 (x - c)^2 + friction: a mass that is to come to rest where it started, m |c| being half of
// what friction can hold. With the Hessian alone it goes to and fro across the place. With the
// secant each iteration at least halves the slip: x_next = m c / (m + F / |x|), so that ten of them
// lead from 1 to e, and a few where it sticks to the end.
TEST(Newton, StopsAMassThatFrictionHolds) {
    static constexpr double kMass = 10;
    static constexpr double kForce = 4;
    const Eigen::Vector3d center(-0.2, 0, 0);
    contact::LaggedFriction<3> friction({.coefficient = 1, .slip_speed = 1e-3});
    contact::Contact<3> touch;
    touch.count = 1;
    touch.weights.setZero();
    touch.weights[0] = 1;
    touch.direction = Eigen::Vector3d::UnitY();
    touch.slope = -kForce;
    friction.begin_step({touch}, point(0, 0, 0), nullptr, 1);
    Positions<3> force = point(0, 0, 0);
    PlainFunction f;
    f.value = [&](const Eigen::VectorXd& x) {
        return 0.5 * kMass * (x - center).squaredNorm() + friction.add_gradient(x, force);
    };
    f.gradient = [&](const Eigen::VectorXd& x) {
        force.setZero();
        friction.add_gradient(x, force);
        return Eigen::VectorXd(kMass * (x - center) + force.col(0));
    };
    f.hessian = [&](const Eigen::VectorXd& x) {
        return Eigen::MatrixXd(kMass * Eigen::Matrix3d::Identity()
                               + friction.hessians(x).weighted[0].block);
    };
    Positions<3> x = point(1, 0, 0.1);
    const NewtonReport report = newton<3>(f, {.tolerance = 1e-10}, x);
    EXPECT_TRUE(report.has_converged) << report.failure_reason;
    EXPECT_LT(x.norm(), 1e-3);
    EXPECT_LE(report.iterations, 18);
}

// sum of x_i - m log x_i: the lowest point is m, and there is no value below 0.
TEST(Newton, NeverLeavesTheDomainOfALogBarrier) {
    static constexpr double kWeight = 1e-3;
    PlainFunction f;
    f.is_in_domain = [](const Eigen::VectorXd& x) { return x.minCoeff() > 0; };
    f.value = [](const Eigen::VectorXd& x) {
        return (x.array() - kWeight * x.array().log()).sum();
    };
    f.gradient = [](const Eigen::VectorXd& x) { return Eigen::VectorXd(1 - kWeight / x.array()); };
    f.hessian = [](const Eigen::VectorXd& x) {
        return Eigen::MatrixXd((kWeight / x.array().square()).matrix().asDiagonal());
    };
    Positions<3> x = point(5, 0.3, 1e-5);
    const NewtonReport report = newton<3>(f, {.tolerance = 1e-10, .max_iterations = 150}, x);
    EXPECT_TRUE(report.has_converged) << report.failure_reason;
    EXPECT_EQ(f.outside, 0);
    EXPECT_LT((x.array() - kWeight).abs().maxCoeff(), 1e-9);
}

// 50 (x - a)^2 + |x|, lowest at the kink for small a: the gradient jumps from -1 to 1 there and
// vanishes nowhere.
TEST(Newton, EndsAtAKinkWhereNoGradientVanishes) {
    const Eigen::Vector3d a(0.003, -0.004, 0.002);
    PlainFunction f;
    f.has_kink = true;
    f.value = [&](const Eigen::VectorXd& x) { return 50 * (x - a).squaredNorm() + x.lpNorm<1>(); };
    f.gradient = [&](const Eigen::VectorXd& x) {
        return Eigen::VectorXd(100 * (x - a) + x.cwiseSign());
    };
    f.hessian = [](const Eigen::VectorXd&) {
        return Eigen::MatrixXd(100 * Eigen::Matrix3d::Identity());
    };
    Positions<3> x = point(1, -2, 0.5);
    const double start = f.value(x);
    const NewtonReport report = newton<3>(f, {.tolerance = 1e-10, .max_iterations = 50}, x);
    EXPECT_TRUE(report.has_converged) << report.failure_reason;
    EXPECT_LT(x.lpNorm<Eigen::Infinity>(), 0.02);
    EXPECT_LT(f.value(x) - 50 * a.squaredNorm(), 1e-3 * start);
    EXPECT_GT(report.residual, 0);  // and says so
    EXPECT_LT(report.residual, 0.1);
    EXPECT_LT(report.iterations, 50);
}

// 50 y^2 + z^2 / 2 + max(x - 1/2, 2 - 4 x): the whole first step leads to less than half
// the gradient and a higher value.
TEST(Newton, DoesNotGoUpBehindAKinkForASmallerGradient) {
    PlainFunction f;
    f.has_kink = true;
    f.value = [](const Eigen::VectorXd& x) {
        return std::max(x[0] - 0.5, 2 - 4 * x[0]) + 50 * x[1] * x[1] + x[2] * x[2] / 2;
    };
    f.gradient = [](const Eigen::VectorXd& x) {
        return Eigen::VectorXd(Eigen::Vector3d(x[0] > 0.5 ? 1 : -4, 100 * x[1], x[2]));
    };
    f.hessian = [](const Eigen::VectorXd&) {
        return Eigen::MatrixXd(Eigen::Vector3d(1, 100, 1).asDiagonal());
    };
    Positions<3> x = point(1, 0.1, 0);
    const double start = f.value(x.reshaped());
    ASSERT_GT(f.value(point(0, 0, 0).reshaped()), start);
    ASSERT_LT(f.gradient(point(0, 0, 0).reshaped()).norm(), f.gradient(x.reshaped()).norm() / 2);
    const NewtonReport report = newton<3>(f, {.tolerance = 1e-10, .max_iterations = 1}, x);
    EXPECT_EQ(report.iterations, 1);
    EXPECT_LT(f.value(x.reshaped()), start);
}

// Forces of which a part is held are no derivative of the value: near kinks their work counts,
// wherever the value has its lowest point.
TEST(Newton, EndsWhereTheGradientVanishesThoughTheValueRises) {
    PlainFunction f;
    f.value = [](const Eigen::VectorXd& x) { return x.squaredNorm(); };
    f.gradient = [](const Eigen::VectorXd& x) {
        return Eigen::VectorXd(x - Eigen::Vector3d(2, 1, 0));
    };
    f.hessian = [](const Eigen::VectorXd&) { return Eigen::MatrixXd(Eigen::Matrix3d::Identity()); };
    for (const bool has_kink : {false, true}) {
        f.has_kink = has_kink;
        Positions<3> x = point(1, 1, 0);
        const NewtonReport report = newton<3>(f, {.tolerance = 1e-10}, x);
        EXPECT_EQ(report.has_converged, has_kink);
        EXPECT_EQ(x == point(2, 1, 0), has_kink);
    }
}

// The same without saying that there is a kink: it ends where it is right to say that no part of
// the direction, whole or halved so often, leads down by what is asked of it.
TEST(Newton, FailsOnAnAbsoluteValueThatItWasNotTold) {
    PlainFunction f;
    f.value = [](const Eigen::VectorXd& x) { return x.lpNorm<1>(); };
    f.gradient = [](const Eigen::VectorXd& x) { return Eigen::VectorXd(x.cwiseSign()); };
    f.hessian = [](const Eigen::VectorXd&) { return Eigen::MatrixXd(Eigen::Matrix3d::Identity()); };
    Positions<3> x = point(0.3, -2.4, 0.5);
    const NewtonReport report = newton<3>(f, {.tolerance = 1e-8, .max_iterations = 60}, x);
    EXPECT_FALSE(report.has_converged);
    EXPECT_EQ(report.failure_reason, "the line search found no decrease");
    EXPECT_LT(report.iterations, 60);
    for (int halvings = 0; halvings < 40; ++halvings) {
        const Positions<3> step = -std::ldexp(1.0, -halvings) * x.cwiseSign();
        EXPECT_GT((x + step).lpNorm<1>() - x.lpNorm<1>(), -1e-4 * step.lpNorm<1>()) << halvings;
    }
    EXPECT_LT(x.lpNorm<1>(), 3.2);  // lower than where it began, all the same
}

// x^2 + (y^2 - 1)^2 + z^2 bends downwards along y near the start.
TEST(Newton, GoesDownWhereTheHessianIsIndefinite) {
    PlainFunction f;
    f.value = [](const Eigen::VectorXd& x) {
        return x[0] * x[0] + std::pow(x[1] * x[1] - 1, 2) + x[2] * x[2];
    };
    f.gradient = [](const Eigen::VectorXd& x) {
        return Eigen::VectorXd(Eigen::Vector3d(2 * x[0], 4 * x[1] * (x[1] * x[1] - 1), 2 * x[2]));
    };
    f.hessian = [](const Eigen::VectorXd& x) {
        return Eigen::MatrixXd(Eigen::Vector3d(2, 12 * x[1] * x[1] - 4, 2).asDiagonal());
    };
    Positions<3> x = point(0.5, 0.1, -1);
    const NewtonReport report = newton<3>(f, {.tolerance = 1e-10}, x);
    EXPECT_TRUE(report.has_converged) << report.failure_reason;
    EXPECT_LT((x - point(0, 1, 0)).norm(), 1e-8);

    // With the Hessian as it is the direction leads up to y = 0, where nothing is won.
    f.curvature = Curvature::AsItIs;
    x = point(0, 0.1, 0);
    const NewtonReport raw = newton<3>(f, {.tolerance = 1e-10}, x);
    EXPECT_FALSE(raw.has_converged);
    EXPECT_EQ(raw.failure_reason, "the line search found no decrease");
    EXPECT_EQ(x, point(0, 0.1, 0));
}

// x^2 - y^2 has no lowest point.
TEST(Newton, GivesUpOnAFunctionWithoutALowestPoint) {
    PlainFunction f;
    f.value = [](const Eigen::VectorXd& x) { return x[0] * x[0] - x[1] * x[1] + x[2] * x[2]; };
    f.gradient = [](const Eigen::VectorXd& x) {
        return Eigen::VectorXd(Eigen::Vector3d(2 * x[0], -2 * x[1], 2 * x[2]));
    };
    f.hessian = [](const Eigen::VectorXd&) {
        return Eigen::MatrixXd(Eigen::Vector3d(2, -2, 2).asDiagonal());
    };
    Positions<3> x = point(1, 0.1, 1);
    const NewtonReport report = newton<3>(f, {.max_iterations = 40}, x);
    EXPECT_FALSE(report.has_converged);
    EXPECT_EQ(report.iterations, 40);
    EXPECT_LT(f.value(x.reshaped()), -1);
}

TEST(Newton, SaysWhereAValueIsNotANumber) {
    PlainFunction f(rosenbrock());
    f.value = [](const Eigen::VectorXd&) { return std::nan(""); };
    Positions<3> x = point(0, 0, 0);
    const NewtonReport report = newton<3>(f, {}, x);
    EXPECT_FALSE(report.has_converged);
    EXPECT_EQ(report.failure_reason, "the energy grew beyond all bounds");
}

// 1/2 x A x - b x, in which the first step is the solution.
Formula quadratic(const Eigen::Matrix3d& A, const Eigen::Vector3d& b) {
    Formula f;
    f.value = [=](const Eigen::VectorXd& x) { return 0.5 * x.dot(A * x) - b.dot(x); };
    f.gradient = [=](const Eigen::VectorXd& x) { return Eigen::VectorXd(A * x - b); };
    f.hessian = [=](const Eigen::VectorXd&) { return Eigen::MatrixXd(A); };
    return f;
}

Eigen::Matrix3d definite() {
    Eigen::Matrix3d A;
    A << 4, 1, 0, 1, 3, -1, 0, -1, 2;
    return A;
}

TEST(NewtonStep, SolvesAQuadraticAtOnce) {
    const Eigen::Vector3d b(1, -2, 3);
    PlainFunction f(quadratic(definite(), b));
    Positions<3> x = point(7, 8, 9);
    const NewtonReport report = newton_step<3>(f, x);
    EXPECT_TRUE(report.has_converged);
    EXPECT_EQ(report.iterations, 1);
    EXPECT_LT((x - definite().ldlt().solve(b)).norm(), 1e-13);
    EXPECT_EQ(f.evaluations, 1);
}

// The step of the last iteration that it may take counts as any other.
TEST(Newton, SolvesAQuadraticInTheOneIterationThatItMayTake) {
    const Eigen::Vector3d b(1, -2, 3);
    PlainFunction f(quadratic(definite(), b));
    Positions<3> x = point(7, 8, 9);
    const NewtonReport report = newton<3>(f, {.max_iterations = 1}, x);
    EXPECT_TRUE(report.has_converged) << report.failure_reason;
    EXPECT_EQ(report.iterations, 1);
    EXPECT_LE(report.residual, 1e-4);
    EXPECT_LT((x - definite().ldlt().solve(b)).norm(), 1e-13);
}

TEST(NewtonStep, IsTheFirstIterationOfNewtonsMethod) {
    PlainFunction f(rosenbrock());
    Positions<3> step = point(1.1, 1.2, 1.4);
    ASSERT_TRUE(newton_step<3>(f, step).has_converged);
    Positions<3> x = point(1.1, 1.2, 1.4);
    static_cast<void>(newton<3>(f, {.max_iterations = 1}, x));
    EXPECT_EQ(x, step);
}

// A Hessian four times too stiff gains a quarter of the way in each iteration, unless steps go on.
TEST(Newton, StretchesStepsOfAHessianThatIsTooStiff) {
    const auto iterations = [](bool extends) {
        PlainFunction f(quadratic(definite(), Eigen::Vector3d(1, -2, 3)));
        f.hessian = [](const Eigen::VectorXd&) { return Eigen::MatrixXd(4 * definite()); };
        Positions<3> x = point(7, 8, 9);
        const NewtonReport report =
            newton<3>(f, {.tolerance = 1e-8, .max_iterations = 200, .extends_steps = extends}, x);
        EXPECT_TRUE(report.has_converged);
        EXPECT_LT((x - definite().ldlt().solve(Eigen::Vector3d(1, -2, 3))).norm(), 1e-6);
        return report.iterations;
    };
    EXPECT_GT(iterations(false), 40);
    EXPECT_LT(iterations(true), 10);
}

// What adapts when a point is accepted looks at where it was evaluated last: never at a stretch
// that was tried and given up.
TEST(Newton, AcceptsThePointThatItEvaluatedLast) {
    struct Watchful : PlainFunction {
        using PlainFunction::PlainFunction;
        Positions<3> last;
        int accepted = 0;
        Evaluation<3> evaluate(const Positions<3>& x) override {
            last = x;
            return PlainFunction::evaluate(x);
        }
        bool accept(const Positions<3>& x) override {
            ++accepted;
            EXPECT_EQ(last, x);
            return false;
        }
    };
    // Half as stiff as its Hessian, and a wall from 1.2 on: a full step ends at 1, where the slope
    // is still half of that at the start, and a stretched one in the wall.
    Watchful f({.value = [](const auto& x) -> double {
                    const double wall = std::max(0.0, x[0] - 1.2);
                    return 0.25 * x[0] * x[0] - x[0] + 100 * wall * wall;
                },
                .gradient = [](const auto& x) -> Eigen::VectorXd {
                    return (0.5 * x[0] - 1 + 200 * std::max(0.0, x[0] - 1.2)) * x.Unit(3, 0);
                },
                .hessian = [](const auto& x) -> Eigen::MatrixXd {
                    return Eigen::MatrixXd::Identity(x.size(), x.size());
                }});
    Positions<3> x = point(0, 0, 0);
    static_cast<void>(newton<3>(f, {.max_iterations = 1, .extends_steps = true}, x));
    EXPECT_EQ(x, point(1, 0, 0));
    EXPECT_EQ(f.accepted, 1);
    EXPECT_EQ(f.evaluations, 4);  // the start, the full step, the stretch, and the step once more
}

// A function that stiffens when it is told of a point, as barriers do.
class Stiffening : public PlainFunction {
public:
    Stiffening() : PlainFunction(quadratic(definite(), Eigen::Vector3d(1, -2, 3))) {
        const auto soft_value = value;
        const auto soft_gradient = gradient;
        const auto soft_hessian = hessian;
        value = [=, this](const Eigen::VectorXd& x) {
            return soft_value(x) + 0.5 * stiffness_ * x.squaredNorm();
        };
        gradient = [=, this](const Eigen::VectorXd& x) {
            return Eigen::VectorXd(soft_gradient(x) + stiffness_ * x);
        };
        hessian = [=, this](const Eigen::VectorXd& x) {
            return Eigen::MatrixXd(soft_hessian(x) + stiffness_ * Eigen::Matrix3d::Identity());
        };
    }
    bool accept(const Positions<3>& /*x*/) override {
        if (told_++ >= 3) {
            return false;
        }
        stiffness_ = 2 * stiffness_ + 1;
        return true;
    }
    [[nodiscard]] double stiffness() const { return stiffness_; }

private:
    double stiffness_ = 0;
    int told_ = 0;
};

TEST(Newton, GoesOnFromAFunctionThatHasChanged) {
    Stiffening f;
    Positions<3> x = point(7, 8, 9);
    const NewtonReport report = newton<3>(f, {.tolerance = 1e-12}, x);
    EXPECT_TRUE(report.has_converged) << report.failure_reason;
    EXPECT_EQ(f.stiffness(), 7);
    const Eigen::Matrix3d A = definite() + 7 * Eigen::Matrix3d::Identity();
    EXPECT_LT((x - A.ldlt().solve(Eigen::Vector3d(1, -2, 3))).norm(), 1e-10);
}

// -x^2 - x: its Hessian taken as positive, every step goes twice as far as the last.
TEST(Newton, EndsWhereTheWayLeadsFartherThanItsBoundAndAcceptsNothingBeyond) {
    class Falling : public PlainFunction {
    public:
        using PlainFunction::PlainFunction;
        bool accept(const Positions<3>& x) override {
            farthest = std::max(farthest, x.cwiseAbs().maxCoeff());
            return false;
        }
        double farthest = 0;
    };
    const auto run = [](double bound) {
        Falling function(
            {.value = [](const auto& x) { return -x.squaredNorm() - x.sum(); },
             .gradient = [](const auto& x) -> Eigen::VectorXd { return -2 * x.array() - 1; },
             .hessian = [](const auto& x) -> Eigen::MatrixXd {
                 return -2 * Eigen::MatrixXd::Identity(x.size(), x.size());
             }});
        Positions<3> x = point(0, 0, 0);
        const NewtonReport report = newton<3>(function, {.bound = bound}, x);
        EXPECT_FALSE(report.has_converged);
        return std::pair(report.failure_reason, function.farthest);
    };
    const auto [reason, farthest] = run(1000);
    EXPECT_EQ(reason, "the motion grew beyond all bounds");
    EXPECT_GT(farthest, 100);
    EXPECT_LT(farthest, 1000);
    EXPECT_GT(run(kInfinity).second, 1000);
}

// Whatever little is left of each: a third in a row ends it, before a way is asked for.
TEST(Newton, EndsWhereCorrectionAfterCorrectionIsFartherThanItsBoundHoweverShortTheyAreCut) {
    struct Blocked : PlainFunction {
        std::vector<double> lengths;  // of corrections, one after the other
        std::size_t corrections = 0;
        int ways = 0;
        Blocked() {
            value = [](const Eigen::VectorXd& x) { return -x[0]; };
            gradient = [](const Eigen::VectorXd& x) { return Eigen::VectorXd(-x.Unit(3, 0)); };
        }
        NewtonDirection<3> solve(const Positions<3>& /*gradient*/,
                                 const Positions<3>& /*displacement*/,
                                 double /*tolerance*/) override {
            return {point(lengths[corrections++ % lengths.size()], 0, 0), ""};
        }
        double max_step(const Positions<3>& from, const Positions<3>& to) override {
            ++ways;
            return 1 / std::max(1.0, (to - from).norm());
        }
    };
    const auto run = [](const std::vector<double>& lengths, int max_astray) {
        Blocked f;
        f.lengths = lengths;
        Positions<3> x = point(0, 0, 0);
        const NewtonReport report =
            newton<3>(f, {.bound = 1000, .max_astray = max_astray, .max_iterations = 60}, x);
        EXPECT_FALSE(report.has_converged);
        EXPECT_EQ(report.failure_reason, report.iterations < 60
                                             ? "the motion grew beyond all bounds"
                                             : "Newton's method did not reach its tolerance");
        EXPECT_EQ(x(0, 0), f.ways);
        return f.ways;
    };
    EXPECT_EQ(run({1024, 0x1p30, 1, 1024, 0x1p30, 0x1p30}, 3), 5);
    EXPECT_EQ(run({1024, 1024, 512}, 3), 60);
    EXPECT_EQ(run({0x1p30}, 3), 2);
    EXPECT_EQ(run({0x1p30}, 0), 60);
}

// What a damped step asks for: as many iterations as it allows, each below the one before.
TEST(Newton, MayStopShortOfItsTolerance) {
    PlainFunction valley(rosenbrock());
    double value = valley.value(Eigen::Vector3d(-1.2, 1, 1));
    for (const int iterations : {1, 2, 4, 8}) {
        Positions<3> x = point(-1.2, 1, 1);
        EXPECT_FALSE(newton<3>(valley, {.max_iterations = iterations}, x).has_converged);
        x = point(-1.2, 1, 1);
        const NewtonReport report =
            newton<3>(valley, {.max_iterations = iterations, .may_stop_short = true}, x);
        EXPECT_TRUE(report.has_converged) << report.failure_reason;
        EXPECT_EQ(report.iterations, iterations);
        EXPECT_GT(report.residual, 1e-4);
        EXPECT_LT(valley.value(x.reshaped()), value);
        value = valley.value(x.reshaped());
    }
}

}  // namespace
}  // namespace pent::simulator
