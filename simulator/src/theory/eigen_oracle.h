#pragma once

#include <pent/simulator/eigen_proof.h>

#include <Eigen/Core>

#include <optional>

namespace pent::simulator {

/// Material of the energies in eigen_proof.h.
[[nodiscard]] Material proof_material(Model model);

/// H : q, the derivative of the gradient of a function along q, without singular values of F.
///
/// @return  n x n; nothing where the derivative does not exist: the rotation of F is not unique,
/// and q
///          would turn it.
[[nodiscard]] std::optional<Eigen::MatrixXd> hessian_product(const EigenFunction& function,
                                                             const Eigen::MatrixXd& F,
                                                             const Eigen::MatrixXd& q);

/// Sum of e . H e over all unit matrices e, from formulas of their own. hessian_product() must
/// exist everywhere.
[[nodiscard]] double hessian_trace(const EigenFunction& function, const Eigen::MatrixXd& F);

/// Adds a Hessian at F that is claimed to be `frame` to a proof.
///
/// @param name  Of the state, for EigenProof::undefined.
void compare(const EigenFunction& function,
             const Eigen::MatrixXd& F,
             const HessianFrame& frame,
             const std::string& name,
             EigenProof& proof);

}  // namespace pent::simulator
