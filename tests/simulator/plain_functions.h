#pragma once

#include "step/newton.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

// Functions of a few coordinates, for Newton's method without a scene.

namespace pent::simulator::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What to do with a Hessian that is not positive definite.
enum class Curvature { AsItIs, Absolute };

// A function of some coordinates and its derivatives.
struct Formula {
    std::function<double(const Eigen::VectorXd&)> value;
    std::function<Eigen::VectorXd(const Eigen::VectorXd&)> gradient;
    std::function<Eigen::MatrixXd(const Eigen::VectorXd&)> hessian;
};

class PlainFunction : public Objective<3>, public Formula {
public:
    using Vector = Eigen::VectorXd;
    using Matrix = Eigen::MatrixXd;

    explicit PlainFunction(Formula formula = {}) : Formula(std::move(formula)) {}

    std::function<bool(const Vector&)> is_in_domain = [](const Vector&) { return true; };
    Curvature curvature = Curvature::Absolute;
    bool has_kink = false;
    int evaluations = 0;
    int outside = 0;  // evaluations where the function is infinite

    Evaluation<3> evaluate(const Positions<3>& x) override {
        x_ = x.reshaped();
        ++evaluations;
        outside += is_in_domain(x_) ? 0 : 1;
        return {.value = is_in_domain(x_) ? value(x_) : kInfinity,
                .rounding = 0,
                .has_kink = has_kink,
                .gradient = gradient(x_).reshaped(3, x.cols())};
    }

    NewtonDirection<3> solve(const Positions<3>& /*gradient*/,
                             const Positions<3>& /*displacement*/,
                             double /*tolerance*/) override {
        Matrix H = hessian(x_);
        if (curvature == Curvature::Absolute) {
            const Eigen::SelfAdjointEigenSolver<Matrix> parts(H);
            H = parts.eigenvectors() * parts.eigenvalues().cwiseAbs().asDiagonal()
                * parts.eigenvectors().transpose();
        }
        const Vector step = -H.fullPivLu().solve(gradient(x_));
        return {step.reshaped(3, step.size() / 3), ""};
    }

    // The part of the way that stays in the domain, found by halving: nine tenths of it.
    double max_step(const Positions<3>& from, const Positions<3>& to) override {
        double fraction = 1;
        const auto at = [&](double t) { return Vector((from + t * (to - from)).reshaped()); };
        while (!is_in_domain(at(fraction)) && fraction > 1e-12) {
            fraction /= 2;
        }
        return fraction < 1 ? 0.9 * fraction : 1;
    }

private:
    Vector x_;
};

[[nodiscard]] inline Positions<3> point(double a, double b, double c) {
    return Eigen::Vector3d(a, b, c);
}

// sum of 100 (x_(i+1) - x_i^2)^2 + (1 - x_i)^2: a bent valley with its end at (1, 1, 1).
[[nodiscard]] inline Formula rosenbrock() {
    Formula f;
    f.value = [](const Eigen::VectorXd& x) {
        double sum = 0;
        for (int i = 0; i < 2; ++i) {
            sum += 100 * std::pow(x[i + 1] - x[i] * x[i], 2) + std::pow(1 - x[i], 2);
        }
        return sum;
    };
    f.gradient = [](const Eigen::VectorXd& x) {
        Eigen::VectorXd g = Eigen::Vector3d::Zero();
        for (int i = 0; i < 2; ++i) {
            const double off = x[i + 1] - x[i] * x[i];
            g[i] += -400 * x[i] * off - 2 * (1 - x[i]);
            g[i + 1] += 200 * off;
        }
        return g;
    };
    f.hessian = [](const Eigen::VectorXd& x) {
        Eigen::MatrixXd H = Eigen::Matrix3d::Zero();
        for (int i = 0; i < 2; ++i) {
            H(i, i) += 1200 * x[i] * x[i] - 400 * x[i + 1] + 2;
            H(i + 1, i + 1) += 200;
            H(i, i + 1) -= 400 * x[i];
            H(i + 1, i) -= 400 * x[i];
        }
        return H;
    };
    return f;
}

}  // namespace pent::simulator::test
