#pragma once

#include <pent/simulator/eigen_proof.h>

#include <Eigen/Core>

#include <optional>

namespace pent::simulator {

/// The material that energies are proved with, see EigenFunction.
[[nodiscard]] Material proof_material(Model model);

/// H : q, the derivative of the gradient of a function along q, by other formulas than those of
/// eigensystems.
///
/// @return  n x n; nothing where the derivative does not exist, as the rotation of F is not unique
///          and q would turn it.
[[nodiscard]] std::optional<Eigen::MatrixXd> hessian_product(const EigenFunction& function,
                                                             const Eigen::MatrixXd& F,
                                                             const Eigen::MatrixXd& q);

/// The trace of H, the sum of e . H e over all unit matrices e, from separate formulas. All
/// hessian_product() must exist.
[[nodiscard]] double hessian_trace(const EigenFunction& function, const Eigen::MatrixXd& F);

/// The larger of two errors; NaN if either is, which must not pass for a small error.
[[nodiscard]] double larger_error(double a, double b);

/// Checks the claim that the Hessian at F is `frame`, and adds the errors found to a proof.
///
/// @param name  Of the state, for EigenProof::undefined.
void compare(const EigenFunction& function,
             const Eigen::MatrixXd& F,
             const HessianFrame& frame,
             const std::string& name,
             EigenProof& proof);

}  // namespace pent::simulator
