#include "theory/eigen_oracle.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace pent::simulator {

namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// cof F, and its derivative along a matrix q.
struct Cofactors {
    MatrixXd at_zero;
    MatrixXd slope;
};

// The cofactors of F + t q are polynomials in t. Their coefficients of 1 and t by Cauchy's integral
// on |t| = 0.1, by the trapezoidal rule with 16 points, whose errors are the terms from t^16 on:
// 1e-14 even for the q that enlarges all of 100 directions alike. Away from t = 0 the matrix can be
// inverted even where F cannot. Points below the real axis would give conjugate values.
Cofactors cofactors_along(const MatrixXd& F, const MatrixXd& q) {
    constexpr int kPoints = 16;
    constexpr double kRadius = 0.1;
    const Index n = F.rows();
    Cofactors mean{MatrixXd::Zero(n, n), MatrixXd::Zero(n, n)};
    for (int k = 0; k < kPoints / 2; ++k) {
        // Half a step off the real axis, where a real q may make F + t q singular.
        const std::complex<double> t =
            std::polar(kRadius, 2 * std::numbers::pi * (k + 0.5) / kPoints);
        const Eigen::PartialPivLU<MatrixXcd> lu(F.cast<std::complex<double>>() + t * q);
        const MatrixXcd cofactor = lu.determinant() * lu.inverse().transpose();
        mean.at_zero += cofactor.real() / (kPoints / 2);
        mean.slope += (cofactor / t).real() / (kPoints / 2);
    }
    return mean;
}

// The minor of F without one row and column.
double first_minor(const MatrixXd& F, Index row, Index column) {
    const Index n = F.rows();
    MatrixXd minor(n - 1, n - 1);
    for (Index i = 0; i + 1 < n; ++i) {
        for (Index j = 0; j + 1 < n; ++j) {
            minor(i, j) = F(i < row ? i : i + 1, j < column ? j : j + 1);
        }
    }
    return minor.determinant();
}

// cof F = d det F / dF and its derivative along q, by minors of minors: d cof_ij / dF_pq is, up to
// sign, the determinant without rows i, p and columns j, q ([shi2025] section 4.3.4, sign
// corrected).
Cofactors cofactors_by_minors(const MatrixXd& F, const MatrixXd& q) {
    const Index n = F.rows();
    Cofactors result{MatrixXd(n, n), MatrixXd::Zero(n, n)};
    for (Index i = 0; i < n; ++i) {
        for (Index j = 0; j < n; ++j) {
            const double sign = (i + j) % 2 == 0 ? 1 : -1;
            result.at_zero(i, j) = sign * first_minor(F, i, j);
            MatrixXd rest(n - 1, n - 1);
            MatrixXd along(n - 1, n - 1);
            for (Index r = 0; r + 1 < n; ++r) {
                for (Index c = 0; c + 1 < n; ++c) {
                    rest(r, c) = F(r < i ? r : r + 1, c < j ? c : c + 1);
                    along(r, c) = q(r < i ? r : r + 1, c < j ? c : c + 1);
                }
            }
            for (Index r = 0; r + 1 < n; ++r) {
                for (Index c = 0; c + 1 < n; ++c) {
                    if (along(r, c) == 0) {
                        continue;
                    }
                    const double inner = (r + c) % 2 == 0 ? 1 : -1;
                    const double minor = n == 2 ? 1 : first_minor(rest, r, c);
                    result.slope(i, j) += sign * inner * minor * along(r, c);
                }
            }
        }
    }
    return result;
}

constexpr Index kMaxDense = 8;

Cofactors cofactors(const MatrixXd& F, const MatrixXd& q) {
    return F.rows() <= kMaxDense ? cofactors_by_minors(F, q) : cofactors_along(F, q);
}

// Polar decomposition F = R S, R a rotation (the gradient of I1) and S symmetric.
struct Polar {
    MatrixXd R;
    Eigen::SelfAdjointEigenSolver<MatrixXd> S;

    explicit Polar(const MatrixXd& F) : R(invariant_gradient(Invariant::I1, F)) {
        const MatrixXd product = R.transpose() * F;
        S.compute(0.5 * (product + product.transpose()));
    }
};

// The derivative of R along q: R W with W skew, W S + S W = R^T q - q^T R (a Lyapunov equation,
// from differentiating F = R S), solved in the eigenvectors of S.
std::optional<MatrixXd> rotation_slope(const MatrixXd& F, const MatrixXd& q) {
    const Polar polar(F);
    const MatrixXd& Q = polar.S.eigenvectors();
    const VectorXd& s = polar.S.eigenvalues();
    const MatrixXd right = polar.R.transpose() * q - q.transpose() * polar.R;
    MatrixXd W = Q.transpose() * right * Q;
    const double least = 1e-12 * s.cwiseAbs().maxCoeff();
    for (Index i = 0; i < W.rows(); ++i) {
        for (Index j = 0; j < W.cols(); ++j) {
            const double sum = s[i] + s[j];
            if (sum > least) {
                W(i, j) /= sum;
            } else if (std::abs(W(i, j)) > 1e-6) {  // of a q with norm 1
                return std::nullopt;
            } else {
                W(i, j) = 0;
            }
        }
    }
    return polar.R * Q * W * Q.transpose();
}

MatrixXd green_strain(const MatrixXd& F) {
    return 0.5 * (F.transpose() * F - MatrixXd::Identity(F.rows(), F.cols()));
}

std::optional<MatrixXd> invariant_product(Invariant which, const MatrixXd& F, const MatrixXd& q) {
    switch (which) {
        case Invariant::I1:
            return rotation_slope(F, q);
        case Invariant::I2:
            return 2 * q;
        case Invariant::I3:
            break;
    }
    return cofactors(F, q).slope;
}

// The part of mu that the second invariant carries is c2 = mu part / (2 (n - 2)), in the plane
// mu part / 2.
double second_coefficient(const Material& material, Index n) {
    return material.lame.mu * material.second_invariant
           / static_cast<double>(2 * std::max<Index>(n - 2, 1));
}

// The product rule on the stress of each energy.
std::optional<MatrixXd> model_product(Model model, const MatrixXd& F, const MatrixXd& q) {
    const Material material = proof_material(model);
    const auto [lambda, mu] = material.lame;
    const MatrixXd identity = MatrixXd::Identity(F.rows(), F.cols());
    switch (model) {
        case Model::StableNeoHookean: {
            const Cofactors c = cofactors(F, q);
            const double J = F.determinant();
            return mu * q + (lambda + mu) * c.at_zero.cwiseProduct(q).sum() * c.at_zero
                   + ((lambda + mu) * (J - 1) - mu) * c.slope;
        }
        case Model::MooneyRivlin: {
            // The neo-Hookean one and what c2 adds to it; the gradient of II is
            // 2 (|F|^2 F - F F^T F).
            const double c2 = second_coefficient(material, F.rows());
            const auto n = static_cast<double>(F.rows());
            const MatrixXd of_second =
                2
                * (2 * F.cwiseProduct(q).sum() * F + F.squaredNorm() * q - q * F.transpose() * F
                   - F * q.transpose() * F - F * F.transpose() * q);
            const Cofactors c = cofactors(F, q);
            const double J = F.determinant();
            const double bulk = lambda + mu - 2 * c2;
            return (mu - 2 * (n - 2) * c2) * q + c2 * of_second
                   + bulk * c.at_zero.cwiseProduct(q).sum() * c.at_zero
                   + (bulk * (J - 1) - mu - 2 * c2) * c.slope;
        }
        case Model::Arap: {
            const std::optional<MatrixXd> slope = rotation_slope(F, q);
            return slope ? std::optional<MatrixXd>(2 * mu * (q - *slope)) : std::nullopt;
        }
        case Model::StVenantKirchhoff: {
            const MatrixXd E = green_strain(F);
            const MatrixXd dE = 0.5 * (q.transpose() * F + F.transpose() * q);
            return q * (2 * mu * E + lambda * E.trace() * identity)
                   + F * (2 * mu * dE + lambda * dE.trace() * identity);
        }
        case Model::Linear:
            break;
    }
    return mu * (q + q.transpose()) + lambda * q.trace() * identity;
}

double model_trace(Model model, const MatrixXd& F) {
    const Material material = proof_material(model);
    const auto [lambda, mu] = material.lame;
    const auto n = static_cast<double>(F.rows());
    switch (model) {
        case Model::StableNeoHookean: {  // the second derivative of det has no diagonal
            const MatrixXd any = MatrixXd::Identity(F.rows(), F.cols());
            return mu * n * n
                   + (lambda + mu) * cofactors(F, any / std::sqrt(n)).at_zero.squaredNorm();
        }
        case Model::MooneyRivlin: {
            // II is a sum of squares of 2 x 2 minors; each entry of F is in (n - 1)^2 of them,
            // opposite to every entry of another row and column.
            const MatrixXd any = MatrixXd::Identity(F.rows(), F.cols());
            const double c2 = second_coefficient(material, F.rows());
            return (mu - 2 * (n - 2) * c2) * n * n + 2 * c2 * (n - 1) * (n - 1) * F.squaredNorm()
                   + (lambda + mu - 2 * c2)
                         * cofactors(F, any / std::sqrt(n)).at_zero.squaredNorm();
        }
        case Model::Arap:
            return 2 * mu * (n * n - hessian_trace(Invariant::I1, F));
        case Model::StVenantKirchhoff: {
            const double strain = green_strain(F).trace();
            return n * (2 * mu + n * lambda) * strain + (mu * (n + 1) + lambda) * F.squaredNorm();
        }
        case Model::Linear:
            break;
    }
    return mu * n * (n + 1) + lambda * n;
}

void keep_largest(double value, double& largest) {
    largest = larger_error(largest, value);
}

// Which modes to check: all up to n = 8, else a sample that includes the last flip and twist.
std::vector<Index> chosen_modes(Index n) {
    std::vector<Index> modes;
    const Index count = n * n;
    const Index step = n <= kMaxDense ? 1 : std::max<Index>(1, n / 3);
    for (Index k = 0; k < n; k += step) {
        modes.push_back(k);
    }
    const Index pair_step = n <= kMaxDense ? 1 : (count - n) / 9;
    for (Index k = n; k < count; k += pair_step) {
        modes.push_back(k);
    }
    for (const Index k : {count - 2, count - 1}) {
        if (modes.back() < k) {
            modes.push_back(k);
        }
    }
    return modes;
}

// The largest error of eigenvalues against those of the dense matrix by a general solver, which
// does not know of its structure.
double value_error(const EigenFunction& function, const MatrixXd& F, const VectorXd& values) {
    if (values.hasNaN()) {  // which has no place in an order
        return std::numeric_limits<double>::quiet_NaN();
    }
    const Index n = F.rows();
    MatrixXd H(n * n, n * n);
    for (Index k = 0; k < n * n; ++k) {
        MatrixXd unit = MatrixXd::Zero(n, n);
        unit(k % n, k / n) = 1;
        const std::optional<MatrixXd> column = hessian_product(function, F, unit);
        H.col(k) = column->reshaped();
    }
    VectorXd sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(0.5 * (H + H.transpose()));
    return (sorted - solver.eigenvalues()).cwiseAbs().maxCoeff();
}

}  // namespace

Material proof_material(Model model) {
    return {.model = model, .lame = {.lambda = 1.3, .mu = 0.7}, .second_invariant = 0.4};
}

std::optional<MatrixXd> hessian_product(const EigenFunction& function,
                                        const MatrixXd& F,
                                        const MatrixXd& q) {
    if (const auto* which = std::get_if<Invariant>(&function)) {
        return invariant_product(*which, F, q);
    }
    return model_product(std::get<Model>(function), F, q);
}

double hessian_trace(const EigenFunction& function, const MatrixXd& F) {
    if (const auto* model = std::get_if<Model>(&function)) {
        return model_trace(*model, F);
    }
    const auto n = static_cast<double>(F.rows());
    switch (std::get<Invariant>(function)) {
        case Invariant::I1: {
            const VectorXd s = Polar(F).S.eigenvalues();
            double sum = 0;
            for (Index i = 0; i < s.size(); ++i) {
                for (Index j = i + 1; j < s.size(); ++j) {
                    sum += 2 / (s[i] + s[j]);
                }
            }
            return sum;
        }
        case Invariant::I2:
            return 2 * n * n;
        case Invariant::I3:
            break;
    }
    return 0;
}

double larger_error(double a, double b) {
    return a >= b || std::isnan(a) ? a : b;
}

void compare(const EigenFunction& function,
             const MatrixXd& F,
             const HessianFrame& frame,
             const std::string& name,
             EigenProof& proof) {
    const Index n = F.rows();
    const Eigensystem system(frame);
    const double largest = system.values().cwiseAbs().maxCoeff();
    const double scale = largest > 0 ? largest : 1;  // in the plane H of I1 may be zero
    const std::vector<Index> chosen = chosen_modes(n);
    std::vector<MatrixXd> modes;
    Index undefined = 0;
    for (const Index k : chosen) {
        const MatrixXd q = system.mode(k);
        const std::optional<MatrixXd> product = hessian_product(function, F, q);
        if (product) {
            keep_largest((*product - system.values()[k] * q).norm() / scale, proof.residual);
        } else {
            ++undefined;
        }
        for (const MatrixXd& other : modes) {
            keep_largest(std::abs(q.cwiseProduct(other).sum()), proof.orthogonality);
        }
        keep_largest(std::abs(q.squaredNorm() - 1), proof.orthogonality);
        modes.push_back(q);
    }
    proof.dim = static_cast<int>(n);
    ++proof.states;
    proof.modes += static_cast<std::int64_t>(chosen.size()) - undefined;
    if (undefined > 0) {
        proof.undefined.push_back({name, undefined});
        return;  // no trace, no dense matrix
    }
    const double size = system.values().cwiseAbs().sum();
    keep_largest(std::abs(system.values().sum() - hessian_trace(function, F)) / size, proof.trace);
    if (n <= kMaxDense) {
        keep_largest(value_error(function, F, system.values()) / scale, proof.values);
    }
}

}  // namespace pent::simulator
