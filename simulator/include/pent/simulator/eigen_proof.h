#pragma once

#include <pent/simulator/energy.h>

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace pent::simulator {

/// The eigensystems of energy.h against second derivatives computed in other ways, which share no
/// formula with them: second minors of F, Cauchy's integral over complex F, the Lyapunov equation
/// of the polar decomposition, and the product rule.

/// A function of F with an eigensystem: an invariant, or an energy density of lambda = 1.3, mu =
/// 0.7.
using EigenFunction = std::variant<Invariant, Model>;

/// "I1" and so on; of an energy its name in scenes.
[[nodiscard]] std::string eigen_function_name(const EigenFunction& function);

/// All of them.
[[nodiscard]] std::vector<EigenFunction> eigen_functions();

/// Modes that have no eigenvalue at a kind of F.
struct UndefinedModes {
    std::string state;
    std::int64_t modes = 0;
};

/// The largest errors found. All are relative: to the largest |eigenvalue|, or to what is summed
/// up.
struct EigenProof {
    int dim = 0;
    int states = 0;            ///< Matrices F tried.
    std::int64_t modes = 0;    ///< Pairs of eigenvalue and eigenmatrix tried.
    double values = 0;         ///< Eigenvalues against those of the dense matrix; 0 above n = 8.
    double residual = 0;       ///< |H q - lambda q| for q of norm 1.
    double orthogonality = 0;  ///< |q . q' - (q = q')|.
    double trace = 0;          ///< Sum of the eigenvalues against the trace of H.
    std::vector<UndefinedModes> undefined;  ///< Left out above.

    /// Whether all errors are below 1e-10, which leaves rounding six digits.
    [[nodiscard]] bool holds() const;

    /// Takes over what another proof tried, perhaps in another dimension; dim becomes the larger
    /// one.
    void merge(const EigenProof& other);
};

/// Tries all kinds of F of dimension dim >= 2: distinct singular values, rest, repeated ones, one
/// zero, two zeros, inverted, inverted with sigma_i + sigma_j = 0, and a huge one. Up to n = 8 with
/// all modes and a dense eigensolver, beyond with a sample of modes and products H q alone.
[[nodiscard]] EigenProof prove_eigensystem(const EigenFunction& function, int dim);

}  // namespace pent::simulator
