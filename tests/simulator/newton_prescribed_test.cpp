#include "step/newton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

// Newton's method where some points are to be brought to their places.

namespace pent::simulator {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Three points on a line, joined by springs of rest length 1; the first is to be brought to a
// place. A wall may be in its way.
class Chain : public Objective<3> {
public:
    explicit Chain(double goal, double wall = kInfinity) : goal_(goal), wall_(wall) {}

    Evaluation<3> evaluate(const Positions<3>& x) override {
        x_ = x;
        Evaluation<3> at;
        at.gradient.setZero(3, 3);
        for (int i = 0; i < 2; ++i) {
            const Eigen::Vector3d off = x.col(i + 1) - x.col(i) - Eigen::Vector3d::UnitX();
            at.value += 0.5 * off.squaredNorm();
            at.gradient.col(i + 1) += off;
            at.gradient.col(i) -= off;
        }
        at.gradient.col(0).setZero();
        farthest_ = std::max(farthest_, x(0, 0));
        return at;
    }
    NewtonDirection<3> solve(const Positions<3>& /*gradient*/,
                             const Positions<3>& displacement,
                             double /*tolerance*/) override {
        // Where springs are at rest behind the first point, wherever that goes.
        Positions<3> step = displacement;
        step.col(1) = x_.col(0) + displacement.col(0) + Eigen::Vector3d::UnitX() - x_.col(1);
        step.col(2) = x_.col(1) + step.col(1) + Eigen::Vector3d::UnitX() - x_.col(2);
        return {step, ""};
    }
    Positions<3> prescribed_displacement(const Positions<3>& x) const override {
        Positions<3> displacement = Positions<3>::Zero(3, 3);
        displacement(0, 0) = goal_ - x(0, 0);
        return displacement;
    }
    double max_step(const Positions<3>& from, const Positions<3>& to) override {
        const double way = to(0, 0) - from(0, 0);
        const double most = way > 0 ? (wall_ - from(0, 0)) / way : 1;
        return most > 1 ? 1 : 0.5 * most;
    }
    [[nodiscard]] double farthest() const { return farthest_; }

private:
    double goal_;
    double wall_;
    double farthest_ = -kInfinity;
    Positions<3> x_;
};

Positions<3> chain_at_rest() {
    Positions<3> x = Positions<3>::Zero(3, 3);
    x.row(0) << 0, 1, 2;
    return x;
}

TEST(Newton, BringsPrescribedPointsToTheirPlaces) {
    Chain chain(3);
    Positions<3> x = chain_at_rest();
    const NewtonReport report = newton<3>(chain, {.tolerance = 1e-10, .arrival = 1e-12}, x);
    EXPECT_TRUE(report.has_converged) << report.failure_reason;
    EXPECT_LT((x.row(0) - Eigen::RowVector3d(3, 4, 5)).norm(), 1e-9);
}

TEST(Newton, SaysWherePrescribedPointsAreStuck) {
    Chain chain(3, 1.5);
    Positions<3> x = chain_at_rest();
    const NewtonReport report = newton<3>(chain, {.arrival = 1e-12, .max_iterations = 150}, x);
    EXPECT_FALSE(report.has_converged);
    EXPECT_TRUE(report.has_blocked_points);
    EXPECT_LT(chain.farthest(), 1.5);
    EXPECT_GT(x(0, 0), 1.4);  // as far as it gets
}

}  // namespace
}  // namespace pent::simulator
