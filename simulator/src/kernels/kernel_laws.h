#pragma once

#include "kernels/kernel_tensor.h"
#include "kernels/kernels.h"

// The elastic energies in lanes; energy.h has their formulas and is what they are tested against.

// Tensors of lanes are filled entry by entry right after they are declared; zeroing them first
// would cost as much as using them. NOLINTBEGIN(cppcoreguidelines-pro-type-member-init)

namespace pent::simulator {
namespace {  // NOLINT(google-build-namespaces): see kernel_lanes.h

/// Material parameters in the form that formulas take.
struct Moduli {
    Model model;
    double mu;
    double lambda;  // of Eq. 4 for the stable neo-Hookean energy: Lamé's lambda + mu
    // Of mooney-rivlin, see energy.h.
    double c1;
    double c2;
    double pressure_at_rest;
    double bulk;
};

template <int Dim>
Moduli moduli_of(const ElementRun& run) {
    const Model model = run.material.model;
    const Lame& lame = run.material.lame;
    const bool is_neo_hookean = model == Model::StableNeoHookean;
    const double c2 = lame.mu * run.material.second_invariant / (2 * (Dim - 2));
    return {.model = model,
            .mu = lame.mu,
            .lambda = is_neo_hookean ? lame.lambda + lame.mu : lame.lambda,
            .c1 = lame.mu * (1 - run.material.second_invariant) / 2,
            .c2 = c2,
            .pressure_at_rest = lame.mu + 2 * c2,
            .bulk = lame.lambda + lame.mu - 2 * c2};
}

template <typename Real, int Dim>
struct Stress {
    Tensor<Real, Dim> P;  // first Piola-Kirchhoff stress
    Real energy;          // per rest volume
    Real det;
    Real norm;  // |F|^2
};

template <typename Real, int Dim>
Real norm_squared(const Tensor<Real, Dim>& A) {
    Real sum = A[0][0] * A[0][0];
    for (int i = 0; i < Dim; ++i) {
        for (int j = i == 0 ? 1 : 0; j < Dim; ++j) {
            sum += A[i][j] * A[i][j];
        }
    }
    return sum;
}

template <typename Real, int Dim>
Stress<Real, Dim> neo_hookean_stress(const Tensor<Real, Dim>& F, const Moduli& moduli) {
    const Real mu = Real(moduli.mu);
    const Real lambda = Real(moduli.lambda);
    const Cofactor<Real, Dim> C = cofactor(F);
    const Real growth = C.det - Real(1.0);
    const Real pressure = lambda * growth - mu;
    Stress<Real, Dim> stress;
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            stress.P[i][j] = mu * F[i][j] + pressure * C.matrix[i][j];
        }
    }
    stress.norm = norm_squared(F);
    stress.energy = Real(0.5) * mu * (stress.norm - Real(double(Dim))) - mu * growth
                    + Real(0.5) * lambda * growth * growth;
    stress.det = C.det;
    return stress;
}

// With G = F^T F the second invariant is (I1^2 - |G|^2) / 2, I1 = |F|^2 = tr G, and its gradient
// 2 (I1 F - F G).
template <typename Real, int Dim>
Stress<Real, Dim> mooney_rivlin_stress(const Tensor<Real, Dim>& F, const Moduli& moduli) {
    Tensor<Real, Dim> G;
    for (int i = 0; i < Dim; ++i) {
        for (int j = i; j < Dim; ++j) {
            Real product = F[0][i] * F[0][j];
            for (int k = 1; k < Dim; ++k) {
                product += F[k][i] * F[k][j];
            }
            G[i][j] = product;
            G[j][i] = product;
        }
    }
    const Cofactor<Real, Dim> C = cofactor(F);
    const Real growth = C.det - Real(1.0);
    const Real pressure = Real(moduli.bulk) * growth - Real(moduli.pressure_at_rest);
    const Real twice_c2 = Real(2 * moduli.c2);
    Stress<Real, Dim> stress;
    stress.norm = norm_squared(F);
    const Real along = Real(2 * moduli.c1) + twice_c2 * stress.norm;
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            Real product = F[i][0] * G[0][j];
            for (int k = 1; k < Dim; ++k) {
                product += F[i][k] * G[k][j];
            }
            stress.P[i][j] = along * F[i][j] - twice_c2 * product + pressure * C.matrix[i][j];
        }
    }
    const Real second = Real(0.5) * (stress.norm * stress.norm - norm_squared(G));
    stress.energy = Real(moduli.c1) * (stress.norm - Real(double(Dim)))
                    + Real(moduli.c2) * (second - Real(0.5 * Dim * (Dim - 1)))
                    - Real(moduli.pressure_at_rest) * growth
                    + Real(0.5 * moduli.bulk) * growth * growth;
    stress.det = C.det;
    return stress;
}

template <typename Real, int Dim>
Stress<Real, Dim> arap_stress(const Tensor<Real, Dim>& F, const Moduli& moduli) {
    const SignedSvd<Real, Dim> svd = signed_svd(F, identity<Real, Dim>());
    Stress<Real, Dim> stress;
    Tensor<Real, Dim> gap;  // F - R
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            Real R = svd.U[i][0] * svd.turned_rest[j][0];
            for (int k = 1; k < Dim; ++k) {
                R += svd.U[i][k] * svd.turned_rest[j][k];
            }
            gap[i][j] = F[i][j] - R;
            stress.P[i][j] = Real(2 * moduli.mu) * gap[i][j];
        }
    }
    stress.energy = Real(moduli.mu) * norm_squared(gap);
    stress.det = cofactor(F).det;
    stress.norm = norm_squared(F);
    return stress;
}

template <typename Real, int Dim>
Stress<Real, Dim> st_venant_kirchhoff_stress(const Tensor<Real, Dim>& F, const Moduli& moduli) {
    Tensor<Real, Dim> E;  // Green strain
    Real trace = Real(0.0);
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            Real product = F[0][i] * F[0][j];
            for (int k = 1; k < Dim; ++k) {
                product += F[k][i] * F[k][j];
            }
            E[i][j] = Real(0.5) * (product - Real(i == j ? 1.0 : 0.0));
        }
        trace += E[i][i];
    }
    Stress<Real, Dim> stress;
    const Real spherical = Real(moduli.lambda) * trace;
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            Real sum = spherical * F[i][j];
            for (int k = 0; k < Dim; ++k) {
                sum += Real(2 * moduli.mu) * F[i][k] * E[k][j];
            }
            stress.P[i][j] = sum;
        }
    }
    stress.energy = Real(moduli.mu) * norm_squared(E) + Real(0.5) * spherical * trace;
    stress.det = cofactor(F).det;
    stress.norm = norm_squared(F);
    return stress;
}

template <typename Real, int Dim>
Stress<Real, Dim> linear_stress(const Tensor<Real, Dim>& F, const Moduli& moduli) {
    Tensor<Real, Dim> strain;
    Real trace = Real(0.0);
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            strain[i][j] = Real(0.5) * (F[i][j] + F[j][i]) - Real(i == j ? 1.0 : 0.0);
        }
        trace += strain[i][i];
    }
    Stress<Real, Dim> stress;
    const Real spherical = Real(moduli.lambda) * trace;
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            stress.P[i][j] = Real(2 * moduli.mu) * strain[i][j];
        }
        stress.P[i][i] += spherical;
    }
    stress.energy = Real(moduli.mu) * norm_squared(strain) + Real(0.5) * spherical * trace;
    stress.det = cofactor(F).det;
    stress.norm = norm_squared(F);
    return stress;
}

template <typename Real, int Dim>
Stress<Real, Dim> stress_of(const Tensor<Real, Dim>& F, const Moduli& moduli) {
    switch (moduli.model) {
        case Model::StableNeoHookean:
            return neo_hookean_stress(F, moduli);
        case Model::MooneyRivlin:
            return mooney_rivlin_stress(F, moduli);
        case Model::Arap:
            return arap_stress(F, moduli);
        case Model::StVenantKirchhoff:
            return st_venant_kirchhoff_stress(F, moduli);
        case Model::Linear:
            break;
    }
    return linear_stress(F, moduli);
}

/// Hessian of an isotropic energy in the frame of the singular vectors, see HessianFrame. It
/// couples the diagonal entries with one another (stretch), and each pair (i, j), (j, i) with
/// itself: flip is the eigenvalue of E_ij + E_ji, twist that of E_ij - E_ji.
///
/// With mean dilatation the pressure of the mean adds `mean_pressure` times the second derivative
/// of the measure of volume, see kernel_quadratic.h; it is 0 for all other elements.
template <typename Real, int Dim>
struct Spectrum {
    Tensor<Real, Dim> stretch;
    Tensor<Real, Dim> flip;   // entries i < j
    Tensor<Real, Dim> twist;  // entries i < j
};

// Product of all singular values but i and j; i = j leaves out one.
template <typename Real, int Dim>
Real product_without(const Real (&sigma)[Dim], int i, int j) {
    Real product = Real(1.0F);
    for (int k = 0; k < Dim; ++k) {
        if (k != i && k != j) {
            product *= sigma[k];
        }
    }
    return product;
}

template <typename Real, int Dim>
Spectrum<Real, Dim> neo_hookean_spectrum(const Real (&sigma)[Dim],
                                         const Moduli& moduli,
                                         const Real& mean_pressure) {
    using Number = typename Lanes<Real>::Number;
    const Real mu = Real(static_cast<Number>(moduli.mu));
    const Real lambda = Real(static_cast<Number>(moduli.lambda));
    Real growth[Dim];
    for (int i = 0; i < Dim; ++i) {
        growth[i] = product_without(sigma, i, i);
    }
    const Real pressure = lambda * (growth[0] * sigma[0] - Real(Number(1))) - mu + mean_pressure;
    Spectrum<Real, Dim> spectrum;
    for (int i = 0; i < Dim; ++i) {
        spectrum.stretch[i][i] = mu + lambda * growth[i] * growth[i];
        for (int j = i + 1; j < Dim; ++j) {
            const Real curl = pressure * product_without(sigma, i, j);
            spectrum.stretch[i][j] = curl + lambda * growth[i] * growth[j];
            spectrum.stretch[j][i] = spectrum.stretch[i][j];
            spectrum.flip[i][j] = mu - curl;
            spectrum.twist[i][j] = mu + curl;
        }
    }
    return spectrum;
}

template <typename Real, int Dim>
Spectrum<Real, Dim> mooney_rivlin_spectrum(const Real (&sigma)[Dim],
                                           const Moduli& moduli,
                                           const Real& mean_pressure) {
    using Number = typename Lanes<Real>::Number;
    const Real twice_c2 = Real(static_cast<Number>(2 * moduli.c2));
    const Real bulk = Real(static_cast<Number>(moduli.bulk));
    Real growth[Dim];
    Real norm = Real(Number(0));
    for (int i = 0; i < Dim; ++i) {
        growth[i] = product_without(sigma, i, i);
        norm += sigma[i] * sigma[i];
    }
    const Real along = Real(static_cast<Number>(2 * moduli.c1)) + twice_c2 * norm;
    const Real pressure = bulk * (growth[0] * sigma[0] - Real(Number(1)))
                          - Real(static_cast<Number>(moduli.pressure_at_rest)) + mean_pressure;
    Spectrum<Real, Dim> spectrum;
    for (int i = 0; i < Dim; ++i) {
        const Real square = sigma[i] * sigma[i];
        spectrum.stretch[i][i] = along - twice_c2 * square + bulk * growth[i] * growth[i];
        for (int j = i + 1; j < Dim; ++j) {
            const Real curl = pressure * product_without(sigma, i, j);
            const Real mixed = sigma[i] * sigma[j];
            const Real squares = square + sigma[j] * sigma[j];
            spectrum.stretch[i][j] =
                (twice_c2 + twice_c2) * mixed + curl + bulk * growth[i] * growth[j];
            spectrum.stretch[j][i] = spectrum.stretch[i][j];
            spectrum.flip[i][j] = along - twice_c2 * (squares + mixed) - curl;
            spectrum.twist[i][j] = along - twice_c2 * (squares - mixed) + curl;
        }
    }
    return spectrum;
}

template <typename Real, int Dim>
Spectrum<Real, Dim> arap_spectrum(const Real (&sigma)[Dim], const Moduli& moduli) {
    using L = Lanes<Real>;
    using Number = typename L::Number;
    const Real stiff = Real(static_cast<Number>(2 * moduli.mu));
    const Real zero = Real(Number(0));
    Spectrum<Real, Dim> spectrum;
    for (int i = 0; i < Dim; ++i) {
        spectrum.stretch[i][i] = stiff;
        for (int j = i + 1; j < Dim; ++j) {
            spectrum.stretch[i][j] = zero;
            spectrum.stretch[j][i] = zero;
            spectrum.flip[i][j] = stiff;
            // The twist eigenvalue tends to minus infinity as sigma_i + sigma_j goes to 0, where
            // the rotation is not unique; within rounding of that the mode counts as free.
            const Real sum = sigma[i] + sigma[j];
            const auto is_defined = sum > Real(Precise<Number>::kRankDeficient);
            const Real safe = L::select(is_defined, sum, Real(Number(2)));
            spectrum.twist[i][j] = stiff - (stiff + stiff) / safe;
        }
    }
    return spectrum;
}

template <typename Real, int Dim>
Spectrum<Real, Dim> st_venant_kirchhoff_spectrum(const Real (&sigma)[Dim],
                                                 const Moduli& moduli,
                                                 const Real& mean_pressure) {
    using Number = typename Lanes<Real>::Number;
    const Real mu = Real(static_cast<Number>(moduli.mu));
    const Real lambda = Real(static_cast<Number>(moduli.lambda));
    Real trace = Real(Number(0));
    for (int i = 0; i < Dim; ++i) {
        trace += Real(Number(0.5)) * (sigma[i] * sigma[i] - Real(Number(1)));
    }
    const Real base = lambda * trace - mu + mean_pressure;
    Spectrum<Real, Dim> spectrum;
    for (int i = 0; i < Dim; ++i) {
        const Real square = sigma[i] * sigma[i];
        spectrum.stretch[i][i] = base + (Real(Number(3)) * mu + lambda) * square;
        for (int j = i + 1; j < Dim; ++j) {
            const Real mixed = sigma[i] * sigma[j];
            const Real squares = square + sigma[j] * sigma[j];
            spectrum.stretch[i][j] = lambda * mixed;
            spectrum.stretch[j][i] = spectrum.stretch[i][j];
            spectrum.flip[i][j] = base + mu * (squares + mixed);
            spectrum.twist[i][j] = base + mu * (squares - mixed);
        }
    }
    return spectrum;
}

template <typename Real, int Dim>
Spectrum<Real, Dim> linear_spectrum(const Moduli& moduli) {
    using Number = typename Lanes<Real>::Number;
    const Real stiff = Real(static_cast<Number>(2 * moduli.mu));
    const Real lambda = Real(static_cast<Number>(moduli.lambda));
    Spectrum<Real, Dim> spectrum;
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) {
            spectrum.stretch[i][j] = i == j ? stiff + lambda : lambda;
            spectrum.flip[i][j] = stiff;
            spectrum.twist[i][j] = Real(Number(0));
        }
    }
    return spectrum;
}

template <typename Real, int Dim>
Spectrum<Real, Dim> spectrum_of(const Real (&sigma)[Dim],
                                const Moduli& moduli,
                                const Real& mean_pressure) {
    switch (moduli.model) {
        case Model::StableNeoHookean:
            return neo_hookean_spectrum(sigma, moduli, mean_pressure);
        case Model::MooneyRivlin:
            return mooney_rivlin_spectrum(sigma, moduli, mean_pressure);
        case Model::Arap:
            return arap_spectrum(sigma, moduli);
        case Model::StVenantKirchhoff:
            return st_venant_kirchhoff_spectrum(sigma, moduli, mean_pressure);
        case Model::Linear:
            break;
    }
    return linear_spectrum<Real, Dim>(moduli);
}

}  // namespace
}  // namespace pent::simulator

// NOLINTEND(cppcoreguidelines-pro-type-member-init)
