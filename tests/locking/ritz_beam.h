#pragma once

#include <pent/simulator/material.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

namespace pent::locking {

/// Integrals over [0, length] of products of Lobatto's polynomials and of their derivatives: 1, P_1
/// and integrals of Legendre's P_1, P_2, ... from end to end, of degrees 0, 1, 2, ..., even or odd
/// about the middle as their degree is. Clamped, all are 0 where x = 0: 1 + P_1 stands for P_1, and
/// none for 1. Those whose degrees differ by more than 2 have no product.
struct Products {
    Eigen::MatrixXd plain;  ///< f g
    Eigen::MatrixXd once;   ///< f' g
    Eigen::MatrixXd twice;  ///< f' g'
    Eigen::VectorXd mean;   ///< f
    Eigen::VectorXd arm;    ///< (x - length / 2) f

    Products(int highest_degree, double length, bool is_clamped) {
        const int count = highest_degree + 1;
        plain.setZero(count, count);
        once = twice = plain;
        mean.setZero(count);
        arm.setZero(count);
        for (const auto& [at, weight] : gauss(count + 1)) {
            const auto [legendre, unused] = legendre_at(at, count);
            Eigen::VectorXd value = legendre;
            Eigen::VectorXd slope = Eigen::VectorXd::Zero(count);
            for (int k = 1; k < count; ++k) {
                slope[k] = legendre[k - 1] * 2 / length;
                if (k > 1) {
                    value[k] = (legendre[k] - legendre[k - 2]) / (2 * k - 1);
                }
            }
            if (is_clamped) {
                value[1] += 1;
                value[0] = 0;
            }
            const double w = weight * length / 2;
            plain += w * value * value.transpose();
            once += w * slope * value.transpose();
            twice += w * slope * slope.transpose();
            mean += w * value;
            arm += w * at * length / 2 * value;
        }
    }

    /// Legendre's polynomials and their derivatives.
    static std::pair<Eigen::VectorXd, Eigen::VectorXd> legendre_at(double at, int count) {
        Eigen::VectorXd value(count);
        Eigen::VectorXd slope(count);
        for (int k = 0; k < count; ++k) {
            value[k] = k == 0   ? 1
                       : k == 1 ? at
                                : ((2 * k - 1) * at * value[k - 1] - (k - 1) * value[k - 2]) / k;
            slope[k] = k == 0 ? 0 : k == 1 ? 1 : slope[k - 2] + (2 * k - 1) * value[k - 1];
        }
        return {value, slope};
    }

    static std::vector<std::pair<double, double>> gauss(int points) {
        std::vector<std::pair<double, double>> rule;
        for (int i = 0; i < points; ++i) {
            double at = std::cos(3.14159265358979 * (i + 0.75) / (points + 0.5));
            for (int step = 0; step < 20; ++step) {
                const auto [value, slope] = legendre_at(at, points + 1);
                at -= value[points] / slope[points];
            }
            const double slope = legendre_at(at, points + 1).second[points];
            rule.emplace_back(at, 2 / ((1 - at * at) * slope * slope));
        }
        return rule;
    }
};

/// A force per volume, steady + turning (x - middle of the cross section).
template <int Dim>
struct BodyForce {
    Eigen::Matrix<double, Dim, 1> steady = Eigen::Matrix<double, Dim, 1>::Zero();
    /// Its first row and column are 0.
    Eigen::Matrix<double, Dim, Dim> turning = Eigen::Matrix<double, Dim, Dim>::Zero();

    [[nodiscard]] Eigen::Matrix<double, Dim, 1> at(const Eigen::Matrix<double, Dim, 1>& x) const {
        return steady + turning * (x.array() - 0.5).matrix();
    }
};

/// Highest degrees of polynomials along the beam and, summed, in the axes across it. They are high
/// because stresses are singular at the edges of the end that is held: ritz_beam_test.cpp finds
/// what is still missing.
struct RitzDegrees {
    int along = 40;
    int across = 12;
};

/// Ritz's method with products of polynomials for a beam [0, 4] x [0, 1]^(Dim - 1) of linear
/// elasticity with Young's modulus 1 that is held where x = 0. Nothing of finite elements.
///
/// The beam is its own mirror image in each axis across it. So displacements fall into classes
/// that know nothing of one another, by what mirrors keep and what they negate; in a class each
/// component is even or odd in each axis.
template <int Dim>
class RitzBeam {
public:
    explicit RitzBeam(double poisson, RitzDegrees degrees = {})
        : lame_(simulator::lame_from_young(Dim, 1, poisson)),
          degrees_(degrees),
          along_(degrees.along, 4, true),
          over_(degrees.across, 1, false) {}

    /// Work of the load on the displacements it makes: at most the true one, and nearer to it with
    /// higher degrees.
    [[nodiscard]] double work(const BodyForce<Dim>& load) const {
        double sum = 0;
        for (unsigned negated = 0; negated < 1U << Dim; negated += 2) {  // bits: axes across
            sum += work_in_class(load, negated);
        }
        return sum;
    }

private:
    struct Function {
        int component = 0;
        std::array<int, Dim> degree{};
    };
    using Functions = std::vector<Function>;

    [[nodiscard]] const Products& products(int axis) const { return axis == 0 ? along_ : over_; }

    [[nodiscard]] bool is_in_class(const Function& f, unsigned negated) const {
        int across = 0;
        for (int axis = 1; axis < Dim; ++axis) {
            const bool is_negated = (negated >> axis & 1U) != 0;
            const bool is_odd = is_negated != (axis == f.component);
            if (f.degree[axis] % 2 != (is_odd ? 1 : 0)) {
                return false;
            }
            across += f.degree[axis];
        }
        return across <= degrees_.across;
    }

    // Of two degrees along the beam, first and the next. Those of other such blocks have integrals
    // with the block before and the one after, and with no other.
    [[nodiscard]] Functions block(int first, unsigned negated) const {
        Functions made;
        Function f;
        for (f.degree[0] = first; f.degree[0] < first + 2 && f.degree[0] <= degrees_.along;) {
            for (f.component = 0; f.component < Dim; ++f.component) {
                if (is_in_class(f, negated)) {
                    made.push_back(f);
                }
            }
            int axis = Dim - 1;
            for (; ++f.degree[axis] > degrees_.across && axis > 0; --axis) {
                f.degree[axis] = 0;
            }
        }
        return made;
    }

    // Integral of d_i f d_j g.
    [[nodiscard]] double integral(const Function& f, const Function& g, int i, int j) const {
        double product = 1;
        for (int axis = 0; axis < Dim; ++axis) {
            const Products& p = products(axis);
            const int a = f.degree[axis];
            const int b = g.degree[axis];
            product *= axis == i && axis == j ? p.twice(a, b)
                       : axis == i            ? p.once(a, b)
                       : axis == j            ? p.once(b, a)
                                              : p.plain(a, b);
        }
        return product;
    }

    [[nodiscard]] double stiffness(const Function& f, const Function& g) const {
        for (int axis = 0; axis < Dim; ++axis) {
            if (std::abs(f.degree[axis] - g.degree[axis]) > 2) {
                return 0;
            }
        }
        const int i = f.component;
        const int j = g.component;
        double sum = lame_.lambda * integral(f, g, i, j) + lame_.mu * integral(f, g, j, i);
        for (int axis = 0; axis < Dim && i == j; ++axis) {
            sum += lame_.mu * integral(f, g, axis, axis);
        }
        return sum;
    }

    [[nodiscard]] Eigen::MatrixXd stiffness(const Functions& rows, const Functions& columns) const {
        Eigen::MatrixXd K(rows.size(), columns.size());
        for (Eigen::Index g = 0; g < K.cols(); ++g) {
            for (Eigen::Index f = 0; f < K.rows(); ++f) {
                K(f, g) = stiffness(rows[f], columns[g]);
            }
        }
        return K;
    }

    // Integral of f times its component of the load.
    [[nodiscard]] double pull(const Function& f, const BodyForce<Dim>& load) const {
        const auto mean = [&](int arm) {
            double product = 1;
            for (int axis = 0; axis < Dim; ++axis) {
                const Products& p = products(axis);
                product *= (axis == arm ? p.arm : p.mean)[f.degree[axis]];
            }
            return product;
        };
        double sum = load.steady[f.component] * mean(-1);
        for (int arm = 1; arm < Dim; ++arm) {
            sum += load.turning(f.component, arm) * mean(arm);
        }
        return sum;
    }

    // r . K^-1 r with K tridiagonal in blocks.
    [[nodiscard]] double work_in_class(const BodyForce<Dim>& load, unsigned negated) const {
        double work = 0;
        Functions before;
        Eigen::LLT<Eigen::MatrixXd> eliminated;
        Eigen::VectorXd eliminated_pull;
        for (int first = 1; first <= degrees_.along; first += 2) {
            const Functions own = block(first, negated);
            Eigen::VectorXd right(own.size());
            for (Eigen::Index f = 0; f < right.size(); ++f) {
                right[f] = pull(own[f], load);
            }
            if (first == 1 && right.norm() < 1e-12) {
                return 0;  // the load has nothing in this class
            }
            Eigen::MatrixXd K = stiffness(own, own);
            if (first > 1) {
                const Eigen::MatrixXd coupling = stiffness(own, before);
                right -= coupling * eliminated.solve(eliminated_pull);
                K -= coupling * eliminated.solve(coupling.transpose());
            }
            eliminated.compute(K);
            work += right.dot(eliminated.solve(right));
            eliminated_pull = right;
            before = own;
        }
        return work;
    }

    simulator::Lame lame_;
    RitzDegrees degrees_;
    Products along_;
    Products over_;
};

}  // namespace pent::locking
