#pragma once

#include <pent/simulator/words.h>

namespace pent::simulator {

/// Which elastic energy a body has; see energy.h.
enum class Model { StableNeoHookean, MooneyRivlin, Arap, StVenantKirchhoff, Linear };

template <>
inline constexpr std::array kWords<Model> = {
    Word<Model>{Model::StableNeoHookean, "stable-neo-hookean"},
    Word<Model>{Model::MooneyRivlin, "mooney-rivlin"},
    Word<Model>{Model::Arap, "arap"},
    Word<Model>{Model::StVenantKirchhoff, "st-venant-kirchhoff"},
    Word<Model>{Model::Linear, "linear"},
};

/// Lamé parameters as linear elasticity at small strain sees them, in Pa (N per m^(Dim-1)).
struct Lame {
    double lambda = 0;
    double mu = 0;  ///< Shear modulus, > 0.
};

/// What a body is made of.
struct Material {
    Model model = Model::StableNeoHookean;
    Lame lame;
    double second_invariant = 0;  ///< Of mooney-rivlin alone: the part of mu that the second
                                  ///< invariant carries, in [0, highest_second_invariant()].
    double density = 1000;        ///< kg/m^Dim, > 0.
};

/// 1, but 1 + lambda / mu where lambda < 0: in 3D more would leave the energy without lower bound.
[[nodiscard]] constexpr double highest_second_invariant(const Lame& lame) {
    return lame.lambda < 0 ? 1 + lame.lambda / lame.mu : 1;
}

/// Largest Poisson ratio (not reached) of a material in R^dim: 1 / (dim - 1), so 1/3 in 4D.
[[nodiscard]] double poisson_limit(int dim);

/// Lamé parameters in R^dim from Young's modulus E and Poisson's ratio nu:
///
///     mu = E / (2 (1 + nu)),   lambda = E nu / ((1 + nu) (1 - (dim - 1) nu)).
///
/// A bar pulled along one axis with stress E e stretches by e and narrows by nu e in each of the
/// dim - 1 other directions. Throws an Error unless E > 0 and -1 < nu < poisson_limit(dim).
[[nodiscard]] Lame lame_from_young(int dim, double young, double poisson);

struct YoungPoisson {
    double young = 0;  ///< Pa.
    double poisson = 0;
};

/// Inverse of lame_from_young.
[[nodiscard]] YoungPoisson young_from_lame(int dim, const Lame& lame);

/// Throws an Error unless mu > 0, the bulk modulus lambda + 2 mu / dim > 0 and density > 0.
void check(const Material& material, int dim);

}  // namespace pent::simulator
