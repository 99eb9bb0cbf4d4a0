#pragma once

#include <pent/simulator/material.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <array>
#include <cmath>
#include <vector>

namespace pent::locking {

/// Integrals over [0, length] of products of x^clamp P_k(2 x / length - 1), P_k being Legendre
/// polynomials, and of their derivatives.
struct Products {
    Eigen::MatrixXd plain;  ///< f g
    Eigen::MatrixXd once;   ///< f' g
    Eigen::MatrixXd twice;  ///< f' g'
    Eigen::VectorXd mean;   ///< f
    Eigen::VectorXd arm;    ///< (x - length / 2) f

    Products(int count, double length, bool is_clamped) {
        constexpr int kPoints = 40;  // Gauss-Legendre by the eigenvalues of Jacobi's matrix
        plain.setZero(count, count);
        once = twice = plain;
        mean.setZero(count);
        arm.setZero(count);
        for (const auto& [at, weight] : gauss(kPoints)) {
            Eigen::VectorXd value(count);
            Eigen::VectorXd slope(count);
            legendre(at, value, slope);
            slope *= 2 / length;
            if (is_clamped) {
                const double x = (at + 1) / 2;
                slope = (slope * x + value / length).eval();
                value *= x;
            }
            const double w = weight * length / 2;
            plain += w * value * value.transpose();
            once += w * slope * value.transpose();
            twice += w * slope * slope.transpose();
            mean += w * value;
            arm += w * at * length / 2 * value;
        }
    }

    static void legendre(double at, Eigen::VectorXd& value, Eigen::VectorXd& slope) {
        for (Eigen::Index k = 0; k < value.size(); ++k) {
            const auto n = static_cast<double>(k);
            value[k] = k == 0   ? 1
                       : k == 1 ? at
                                : ((2 * n - 1) * at * value[k - 1] - (n - 1) * value[k - 2]) / n;
            slope[k] = k == 0 ? 0 : k == 1 ? 1 : slope[k - 2] + (2 * n - 1) * value[k - 1];
        }
    }

    static std::vector<std::pair<double, double>> gauss(int points) {
        std::vector<std::pair<double, double>> rule;
        for (int i = 0; i < points; ++i) {
            double at = std::cos(3.14159265358979 * (i + 0.75) / (points + 0.5));
            Eigen::VectorXd value(points + 1);
            Eigen::VectorXd slope(points + 1);
            for (int step = 0; step < 20; ++step) {
                legendre(at, value, slope);
                at -= value[points] / slope[points];
            }
            legendre(at, value, slope);
            rule.emplace_back(at, 2 / ((1 - at * at) * slope[points] * slope[points]));
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

/// Work of the load on the displacements it makes, for a beam [0, 4] x [0, 1]^(Dim - 1) of linear
/// elasticity with Young's modulus 1 that is held where x = 0: Ritz's method with products of
/// polynomials of degree 10 along the beam and `across` across. Nothing of finite elements.
template <int Dim>
[[nodiscard]] double ritz_work(double poisson, const BodyForce<Dim>& load, int across = 4) {
    const simulator::Lame lame = simulator::lame_from_young(Dim, 1, poisson);
    const Products along(11, 4, true);
    const Products over(across + 1, 1, false);
    // Total degree across is bounded, too: what is above it adds nothing.
    std::vector<std::array<int, Dim>> functions;
    std::array<int, Dim> degree{};
    while (degree[Dim - 1] <= across) {
        int sum = 0;
        for (int axis = 1; axis < Dim; ++axis) {
            sum += degree[axis];
        }
        if (sum <= across + 1) {
            functions.push_back(degree);
        }
        for (int axis = 0; axis < Dim; ++axis) {
            if (++degree[axis] <= (axis == 0 ? 10 : across) || axis + 1 == Dim) {
                break;
            }
            degree[axis] = 0;
        }
    }
    const auto n = static_cast<Eigen::Index>(functions.size());
    // Integral of d_i f d_j g.
    const auto integral = [&](const std::array<int, Dim>& f, const std::array<int, Dim>& g, int i,
                              int j) {
        double product = 1;
        for (int axis = 0; axis < Dim && product != 0; ++axis) {
            const Products& p = axis == 0 ? along : over;
            const int a = f[axis];
            const int b = g[axis];
            if (axis == i && axis == j) {
                product *= p.twice(a, b);
            } else if (axis == i) {
                product *= p.once(a, b);
            } else if (axis == j) {
                product *= p.once(b, a);
            } else {
                product *= p.plain(a, b);
            }
        }
        return product;
    };
    Eigen::MatrixXd K(Dim * n, Dim * n);
    Eigen::VectorXd right(Dim * n);
    for (Eigen::Index f = 0; f < n; ++f) {
        double mean = 1;
        for (int axis = 0; axis < Dim; ++axis) {
            mean *= (axis == 0 ? along : over).mean[functions[f][axis]];
        }
        Eigen::Matrix<double, Dim, 1> arms = Eigen::Matrix<double, Dim, 1>::Zero();
        for (int axis = 1; axis < Dim; ++axis) {
            arms[axis] = 1;
            for (int other = 0; other < Dim; ++other) {
                const Products& p = other == 0 ? along : over;
                const int degree_there = functions[f][other];
                arms[axis] *= other == axis ? p.arm[degree_there] : p.mean[degree_there];
            }
        }
        right.segment<Dim>(Dim * f) = mean * load.steady + load.turning * arms;
        for (Eigen::Index g = 0; g <= f; ++g) {
            Eigen::Matrix<double, Dim, Dim> D;
            for (int i = 0; i < Dim; ++i) {
                for (int j = 0; j < Dim; ++j) {
                    D(i, j) = integral(functions[f], functions[g], i, j);
                }
            }
            const Eigen::Matrix<double, Dim, Dim> block =
                lame.mu * (D.trace() * Eigen::Matrix<double, Dim, Dim>::Identity() + D.transpose())
                + lame.lambda * D;
            K.block(Dim * f, Dim * g, Dim, Dim) = block;
        }
    }
    const Eigen::VectorXd u = K.selfadjointView<Eigen::Lower>().llt().solve(right);
    return right.dot(u);
}

}  // namespace pent::locking
