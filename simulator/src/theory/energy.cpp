#include <pent/simulator/energy.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace pent::simulator {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Below this sum of two singular values (F is dimensionless) the rotation of F is not unique.
constexpr double kNoRotation = 1e-13;

struct SignedSvd {
    MatrixXd U;
    VectorXd sigma;
    MatrixXd V;
};

SignedSvd signed_svd(const MatrixXd& F) {
    const Eigen::JacobiSVD<MatrixXd> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    SignedSvd result{svd.matrixU(), svd.singularValues(), svd.matrixV()};
    const Index last = F.rows() - 1;  // singular values come in decreasing order
    if (result.V.determinant() < 0) {
        result.V.col(last) *= -1;
        result.sigma[last] *= -1;
    }
    if (result.U.determinant() < 0) {
        result.U.col(last) *= -1;
        result.sigma[last] *= -1;
    }
    return result;
}

double product_without(const VectorXd& sigma, Index i, Index j) {
    double product = 1;
    for (Index k = 0; k < sigma.size(); ++k) {
        if (k != i && k != j) {
            product *= sigma[k];
        }
    }
    return product;
}

// dI3 / d sigma_i: the product of all other singular values.
VectorXd growth_of(const VectorXd& sigma) {
    VectorXd growth(sigma.size());
    for (Index i = 0; i < sigma.size(); ++i) {
        growth[i] = product_without(sigma, i, i);
    }
    return growth;
}

MatrixXd symmetric_part(const MatrixXd& A) {
    return 0.5 * (A + A.transpose());
}

MatrixXd green_strain(const MatrixXd& F) {
    return 0.5 * (F.transpose() * F - MatrixXd::Identity(F.rows(), F.rows()));
}

// Half of |F|^4 - |F^T F|^2: the sum of the squares of all 2 x 2 minors of F.
double second_invariant(const MatrixXd& F) {
    const double norm = F.squaredNorm();
    return 0.5 * (norm * norm - (F.transpose() * F).squaredNorm());
}

// The coefficients of c1 (|F|^2 - n) + c2 (II - n (n - 1) / 2) - p (J - 1) + k/2 (J - 1)^2. In the
// plane II = J^2 and resists no shear, so that c1 is mu / 2 there.
struct MooneyRivlin {
    double c1;
    double c2;
    double p;
    double k;

    MooneyRivlin(const Material& material, Index n) {
        const auto& [lambda, mu] = material.lame;
        const auto pairs = static_cast<double>(n - 2);
        c2 = mu * material.second_invariant / (2 * std::max(pairs, 1.0));
        c1 = mu / 2 - pairs * c2;
        p = mu + 2 * c2;
        k = lambda + mu - 2 * c2;
    }
};

HessianFrame empty_frame(const SignedSvd& svd) {
    const Index n = svd.sigma.size();
    return {svd.U, svd.V, MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), MatrixXd::Zero(n, n)};
}

// Fills in flip or twist, symmetric matrices of pairs, from value(i, j), i < j.
template <typename Value>
void set_pairs(MatrixXd& pairs, const Value& value) {
    for (Index i = 0; i < pairs.rows(); ++i) {
        for (Index j = i + 1; j < pairs.rows(); ++j) {
            pairs(i, j) = value(i, j);
            pairs(j, i) = pairs(i, j);
        }
    }
}

double rotation_twist(const VectorXd& sigma, Index i, Index j) {
    const double sum = sigma[i] + sigma[j];
    return sum > kNoRotation ? 2 / sum : 0;
}

HessianFrame determinant_hessian(const SignedSvd& svd) {
    HessianFrame frame = empty_frame(svd);
    const auto others = [&](Index i, Index j) { return product_without(svd.sigma, i, j); };
    set_pairs(frame.stretch, others);
    set_pairs(frame.flip, [&](Index i, Index j) { return -others(i, j); });
    set_pairs(frame.twist, others);
    return frame;
}

HessianFrame neo_hookean_hessian(const Lame& lame, const SignedSvd& svd) {
    HessianFrame frame = determinant_hessian(svd);
    const Index n = svd.sigma.size();
    const double lambda = lame.lambda + lame.mu;
    const double pressure = lambda * (svd.sigma.prod() - 1) - lame.mu;
    const VectorXd growth = growth_of(svd.sigma);
    frame.stretch = lame.mu * MatrixXd::Identity(n, n) + lambda * growth * growth.transpose()
                    + pressure * frame.stretch;
    const MatrixXd twist = frame.twist;
    set_pairs(frame.flip, [&](Index i, Index j) { return lame.mu - pressure * twist(i, j); });
    set_pairs(frame.twist, [&](Index i, Index j) { return lame.mu + pressure * twist(i, j); });
    return frame;
}

HessianFrame mooney_rivlin_hessian(const Material& material, const SignedSvd& svd) {
    HessianFrame frame = determinant_hessian(svd);
    const VectorXd& sigma = svd.sigma;
    const MooneyRivlin law(material, sigma.size());
    const double along = 2 * law.c1 + 2 * law.c2 * sigma.squaredNorm();
    const double pressure = law.k * (sigma.prod() - 1) - law.p;
    const VectorXd growth = growth_of(sigma);
    frame.stretch = pressure * frame.stretch + law.k * growth * growth.transpose()
                    + 4 * law.c2 * sigma * sigma.transpose();
    frame.stretch.diagonal().array() += along - 6 * law.c2 * sigma.array().square();
    const MatrixXd curl = pressure * frame.twist;
    const auto pair = [&](Index i, Index j, double sign) {
        return along
               - 2 * law.c2
                     * (sigma[i] * sigma[i] + sigma[j] * sigma[j] + sign * sigma[i] * sigma[j])
               - sign * curl(i, j);
    };
    set_pairs(frame.flip, [&](Index i, Index j) { return pair(i, j, 1); });
    set_pairs(frame.twist, [&](Index i, Index j) { return pair(i, j, -1); });
    return frame;
}

HessianFrame arap_hessian(const Lame& lame, const SignedSvd& svd) {
    HessianFrame frame = empty_frame(svd);
    frame.stretch.diagonal().setConstant(2 * lame.mu);
    set_pairs(frame.flip, [&](Index /*i*/, Index /*j*/) { return 2 * lame.mu; });
    set_pairs(frame.twist, [&](Index i, Index j) {
        const double twist = rotation_twist(svd.sigma, i, j);
        return twist > 0 ? 2 * lame.mu * (1 - twist) : 0;
    });
    return frame;
}

HessianFrame st_venant_kirchhoff_hessian(const Lame& lame, const SignedSvd& svd) {
    HessianFrame frame = empty_frame(svd);
    const VectorXd& sigma = svd.sigma;
    const double trace = 0.5 * (sigma.squaredNorm() - static_cast<double>(sigma.size()));
    const double base = lame.lambda * trace - lame.mu;
    frame.stretch = lame.lambda * sigma * sigma.transpose();
    frame.stretch.diagonal().array() += base + 3 * lame.mu * sigma.array().square();
    const auto pair = [&](Index i, Index j, double sign) {
        return base
               + lame.mu * (sigma[i] * sigma[i] + sigma[j] * sigma[j] + sign * sigma[i] * sigma[j]);
    };
    set_pairs(frame.flip, [&](Index i, Index j) { return pair(i, j, 1); });
    set_pairs(frame.twist, [&](Index i, Index j) { return pair(i, j, -1); });
    return frame;
}

HessianFrame linear_hessian(const Lame& lame, Index n) {
    HessianFrame frame =
        empty_frame({MatrixXd::Identity(n, n), VectorXd::Ones(n), MatrixXd::Identity(n, n)});
    frame.stretch.setConstant(lame.lambda);
    frame.stretch.diagonal().array() += 2 * lame.mu;
    set_pairs(frame.flip, [&](Index /*i*/, Index /*j*/) { return 2 * lame.mu; });
    return frame;
}

double filtered_value(double value, Filter filter) {
    switch (filter) {
        case Filter::Clamp:
            return std::max(value, 0.0);
        case Filter::Absolute:
            return std::abs(value);
        case Filter::None:
            break;
    }
    return value;
}

}  // namespace

double invariant(Invariant which, const MatrixXd& F) {
    switch (which) {
        case Invariant::I1:
            return signed_svd(F).sigma.sum();
        case Invariant::I2:
            return F.squaredNorm();
        case Invariant::I3:
            break;
    }
    return F.determinant();
}

MatrixXd invariant_gradient(Invariant which, const MatrixXd& F) {
    if (which == Invariant::I2) {
        return 2 * F;
    }
    const SignedSvd svd = signed_svd(F);
    if (which == Invariant::I1) {
        return svd.U * svd.V.transpose();
    }
    return svd.U * growth_of(svd.sigma).asDiagonal() * svd.V.transpose();
}

double energy_density(const Material& material, const MatrixXd& F) {
    const auto n = static_cast<double>(F.rows());
    const auto& [lambda, mu] = material.lame;
    switch (material.model) {
        case Model::StableNeoHookean: {
            const double growth = F.determinant() - 1;
            return 0.5 * mu * (F.squaredNorm() - n) - mu * growth
                   + 0.5 * (lambda + mu) * growth * growth;
        }
        case Model::MooneyRivlin: {
            const MooneyRivlin law(material, F.rows());
            const double growth = F.determinant() - 1;
            return law.c1 * (F.squaredNorm() - n) + law.c2 * (second_invariant(F) - n * (n - 1) / 2)
                   - law.p * growth + 0.5 * law.k * growth * growth;
        }
        case Model::Arap:
            return mu * (F - invariant_gradient(Invariant::I1, F)).squaredNorm();
        case Model::StVenantKirchhoff: {
            const MatrixXd E = green_strain(F);
            return mu * E.squaredNorm() + 0.5 * lambda * E.trace() * E.trace();
        }
        case Model::Linear:
            break;
    }
    const MatrixXd strain = symmetric_part(F) - MatrixXd::Identity(F.rows(), F.rows());
    return mu * strain.squaredNorm() + 0.5 * lambda * strain.trace() * strain.trace();
}

MatrixXd stress(const Material& material, const MatrixXd& F) {
    const MatrixXd identity = MatrixXd::Identity(F.rows(), F.rows());
    const auto& [lambda, mu] = material.lame;
    switch (material.model) {
        case Model::StableNeoHookean: {
            const double pressure = (lambda + mu) * (F.determinant() - 1) - mu;
            return mu * F + pressure * invariant_gradient(Invariant::I3, F);
        }
        case Model::MooneyRivlin: {
            const MooneyRivlin law(material, F.rows());
            const double pressure = law.k * (F.determinant() - 1) - law.p;
            return (2 * law.c1 + 2 * law.c2 * F.squaredNorm()) * F
                   - 2 * law.c2 * F * F.transpose() * F
                   + pressure * invariant_gradient(Invariant::I3, F);
        }
        case Model::Arap:
            return 2 * mu * (F - invariant_gradient(Invariant::I1, F));
        case Model::StVenantKirchhoff: {
            const MatrixXd E = green_strain(F);
            return F * (2 * mu * E + lambda * E.trace() * identity);
        }
        case Model::Linear:
            break;
    }
    const MatrixXd strain = symmetric_part(F) - identity;
    return 2 * mu * strain + lambda * strain.trace() * identity;
}

double collapse_scale(const Material& material, int dim) {
    const bool is_neo_hookean = material.model == Model::StableNeoHookean;
    if (dim < 3 || !(is_neo_hookean || material.model == Model::MooneyRivlin)) {
        return 0;
    }
    Material one = material;
    one.second_invariant = is_neo_hookean ? 0 : material.second_invariant;
    const MooneyRivlin law(one, dim);
    const auto excess = [&](double s) {
        const double power = std::pow(s, dim - 2);
        return 2 * law.c1 + 2 * (dim - 1) * law.c2 * s * s
               - (law.p + law.k * (1 - power * s * s)) * power;
    };
    // Bisection, with excess > 0 at `low` (unless there is no such minimum: then low stays 0). At
    // s = 1 excess is 0, too, but negative just below, as the material is stable at rest.
    double low = 0;
    double high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (excess(middle) > 0 ? low : high) = middle;
    }
    return low;
}

HessianFrame invariant_hessian(Invariant which, const MatrixXd& F) {
    const SignedSvd svd = signed_svd(F);
    if (which == Invariant::I3) {
        return determinant_hessian(svd);
    }
    HessianFrame frame = empty_frame(svd);
    if (which == Invariant::I2) {
        frame.stretch.diagonal().setConstant(2);
        set_pairs(frame.flip, [](Index /*i*/, Index /*j*/) { return 2.0; });
        frame.twist = frame.flip;
    } else {
        set_pairs(frame.twist, [&](Index i, Index j) { return rotation_twist(svd.sigma, i, j); });
    }
    return frame;
}

HessianFrame hessian(const Material& material, const MatrixXd& F) {
    switch (material.model) {
        case Model::StableNeoHookean:
            return neo_hookean_hessian(material.lame, signed_svd(F));
        case Model::MooneyRivlin:
            return mooney_rivlin_hessian(material, signed_svd(F));
        case Model::Arap:
            return arap_hessian(material.lame, signed_svd(F));
        case Model::StVenantKirchhoff:
            return st_venant_kirchhoff_hessian(material.lame, signed_svd(F));
        case Model::Linear:
            break;
    }
    return linear_hessian(material.lame, F.rows());
}

HessianFrame filtered(const HessianFrame& frame, Filter filter) {
    HessianFrame result = frame;
    const auto filter_one = [&](double value) { return filtered_value(value, filter); };
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(frame.stretch);
    result.stretch = solver.eigenvectors() * solver.eigenvalues().unaryExpr(filter_one).asDiagonal()
                     * solver.eigenvectors().transpose();
    result.flip = frame.flip.unaryExpr(filter_one);
    result.twist = frame.twist.unaryExpr(filter_one);
    return result;
}

MatrixXd apply(const HessianFrame& frame, const MatrixXd& dF) {
    const MatrixXd D = frame.U.transpose() * dF * frame.V;
    MatrixXd result = 0.5
                      * (frame.flip.cwiseProduct(D + D.transpose())
                         + frame.twist.cwiseProduct(D - D.transpose()));
    result.diagonal() = frame.stretch * D.diagonal();
    return frame.U * result * frame.V.transpose();
}

MatrixXd dense(const HessianFrame& frame) {
    const Index n = frame.U.rows();
    MatrixXd H(n * n, n * n);
    for (Index k = 0; k < n * n; ++k) {
        MatrixXd unit = MatrixXd::Zero(n, n);
        unit(k % n, k / n) = 1;
        H.col(k) = apply(frame, unit).reshaped();
    }
    return H;
}

Eigensystem::Eigensystem(const HessianFrame& frame) : U_(frame.U), V_(frame.V) {
    const Index n = U_.rows();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(frame.stretch);
    stretch_modes_ = solver.eigenvectors();
    values_.resize(n * n);
    values_.head(n) = solver.eigenvalues();
    Index k = n;
    for (Index i = 0; i < n; ++i) {
        for (Index j = i + 1; j < n; ++j) {
            values_[k++] = frame.flip(i, j);
            values_[k++] = frame.twist(i, j);
        }
    }
}

MatrixXd Eigensystem::mode(Index k) const {
    const Index n = U_.rows();
    if (k < n) {
        return U_ * stretch_modes_.col(k).asDiagonal() * V_.transpose();
    }
    Index i = 0;
    Index pair = (k - n) / 2;
    while (pair >= n - 1 - i) {
        pair -= n - 1 - i;
        ++i;
    }
    const Index j = i + 1 + pair;
    const double sign = (k - n) % 2 == 0 ? 1 : -1;
    return (U_.col(i) * V_.col(j).transpose() + sign * U_.col(j) * V_.col(i).transpose())
           / std::sqrt(2.0);
}

}  // namespace pent::simulator
