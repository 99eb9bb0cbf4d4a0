#pragma once

#include <pent/simulator/material.h>
#include <pent/simulator/solver_options.h>

#include <Eigen/Core>

namespace pent::simulator {

/// The theory of the elastic energies, in any dimension n >= 2 (that of F, n x n).
///
/// This is the reference: plain, in double, from formulas. The simulation runs vectorized kernels
/// of its own, which are tested against it. F = U diag(sigma) V^T with rotations U and V, so the
/// smallest sigma is negative where det F is. Nothing here divides by a singular value.

/// Invariants of F: I1 = tr S with F = R S, R a rotation; I2 = |F|^2; I3 = det F.
enum class Invariant { I1, I2, I3 };

[[nodiscard]] double invariant(Invariant which, const Eigen::MatrixXd& F);

/// dI / dF: R, 2 F, or the cofactor matrix. [shi2025] Eq. 9 and sections 4.3.4, 4.4.
///
/// Where R is not unique (two smallest singular values that add up to 0) it is one of the choices.
[[nodiscard]] Eigen::MatrixXd invariant_gradient(Invariant which, const Eigen::MatrixXd& F);

/// Energy per rest volume, J/m^n. Zero at F = I; finite for every finite F.
///
///     stable neo-Hookean      mu/2 (I2 - n) - mu (J - 1) + (lambda + mu)/2 (J - 1)^2,  J = I3
///     mooney-rivlin           c1 (I2 - n) + c2 (II - n (n - 1) / 2) - (mu + 2 c2) (J - 1)
///                             + (lambda + mu - 2 c2)/2 (J - 1)^2
///     arap                    mu |F - R|^2
///     St. Venant-Kirchhoff    mu |E|^2 + lambda/2 (tr E)^2,   E = (F^T F - I)/2
///     linear                  mu |e|^2 + lambda/2 (tr e)^2,   e = (F + F^T)/2 - I
///
/// mu and lambda are those of the material: at small strain each energy is linear elasticity with
/// them (arap with lambda = 0). The first is [smith2018] and [shi2025] Eq. 4 up to a constant;
/// taken literally Eq. 4 linearizes to (mu, lambda - mu), hence the lambda + mu.
///
/// The second is that of [mooney1940, rivlin1948] in R^n, with the volume as in the first:
/// II = (|F|^4 - |F^T F|^2) / 2 is the second invariant of F^T F, the sum of the squares of all
/// 2 x 2 minors of F. It carries the part s = Material::second_invariant of mu = 2 c1 +
/// 2 (n - 2) c2:
///
///     c2 = s mu / (2 (n - 2)),   c1 = (1 - s) mu / 2;   in the plane, where II = J^2, c1 = mu / 2.
///
/// It is a convex function of F, its 2 x 2 minors and J (polyconvex [ball1977]) for every s in
/// range, and the first for s = 0.
[[nodiscard]] double energy_density(const Material& material, const Eigen::MatrixXd& F);

/// First Piola-Kirchhoff stress dPsi/dF, Pa.
[[nodiscard]] Eigen::MatrixXd stress(const Material& material, const Eigen::MatrixXd& F);

/// The uniform scale s of an element below which its own energy pulls it to a point, in [0, 1).
///
/// F = 0 is a strict local minimum of the stable neo-Hookean energy for n >= 3, and of
/// mooney-rivlin unless all of mu is on the second invariant. The slope along s R, R a rotation,
/// vanishes at s = 0, at rest, and once in between, where
///
///     2 c1 + 2 (n - 1) c2 s^2 = (mu + 2 c2 + (lambda + mu - 2 c2) (1 - s^n)) s^(n-2),
///
/// with c1 = mu / 2 and c2 = 0 for the former. For n = 3 and 4 everything with |F| < sqrt(n) s is
/// driven to F = 0: det F <= (|F| / sqrt(n))^n and II >= n (n - 1) / 2 |det F|^(4/n) make P : F,
/// the slope along F itself, positive there, so that |F| shrinks as the energy does. It is the
/// largest such ball. At nu = 0.28 in 4D the scale is 0.43. 0 for n = 2 and for the other models,
/// which have no such minimum.
[[nodiscard]] double collapse_scale(const Material& material, int dim);

/// Second derivative of an isotropic function of F, in the frame of its singular vectors.
///
/// With dF = U D V^T the result is U (H : D) V^T, where H couples the diagonal of D with itself
/// through `stretch`, and each pair D_ij, D_ji only with itself: D_ij + D_ji is scaled by `flip`,
/// and D_ij - D_ji by `twist`.
struct HessianFrame {
    Eigen::MatrixXd U;        ///< n x n rotation.
    Eigen::MatrixXd V;        ///< n x n rotation.
    Eigen::MatrixXd stretch;  ///< n x n, symmetric.
    Eigen::MatrixXd flip;     ///< n x n, symmetric; diagonal unused and 0.
    Eigen::MatrixXd twist;    ///< n x n, symmetric; diagonal unused and 0.
};

/// Second derivative of an invariant. [shi2025] Eqs. 10, 12-20; Eq. 18 with products for quotients.
///
/// For I1 the twist value 2 / (sigma_i + sigma_j) is undefined where the sum is 0; it is then 0.
[[nodiscard]] HessianFrame invariant_hessian(Invariant which, const Eigen::MatrixXd& F);

/// Second derivative of the energy density. [shi2025] Eqs. 21, 22 for the stable neo-Hookean one.
///
/// For arap the twist value 2 mu (1 - 2 / (sigma_i + sigma_j)) is undefined where the sum is 0, and
/// without lower bound near it; where undefined it is 0.
[[nodiscard]] HessianFrame hessian(const Material& material, const Eigen::MatrixXd& F);

/// The Hessian with its eigenvalues filtered.
[[nodiscard]] HessianFrame filtered(const HessianFrame& frame, Filter filter);

/// H : dF, n x n.
[[nodiscard]] Eigen::MatrixXd apply(const HessianFrame& frame, const Eigen::MatrixXd& dF);

/// H as an n^2 x n^2 matrix on vec(F), columns of F one after the other.
[[nodiscard]] Eigen::MatrixXd dense(const HessianFrame& frame);

/// Eigenvalues and eigenmatrices of a Hessian: n stretch modes, then flip and twist of each pair.
class Eigensystem {
public:
    explicit Eigensystem(const HessianFrame& frame);

    /// n^2 of them: stretch (increasing), then for i < j: flip, twist.
    [[nodiscard]] const Eigen::VectorXd& values() const { return values_; }

    /// Eigenmatrix of values()[k], n x n, of norm 1; they are orthogonal to one another.
    [[nodiscard]] Eigen::MatrixXd mode(Eigen::Index k) const;

private:
    Eigen::MatrixXd U_;
    Eigen::MatrixXd V_;
    Eigen::MatrixXd stretch_modes_;
    Eigen::VectorXd values_;
};

}  // namespace pent::simulator
