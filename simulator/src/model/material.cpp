#include <pent/error.h>
#include <pent/simulator/material.h>

#include <cmath>
#include <string>

namespace pent::simulator {

double poisson_limit(int dim) {
    return 1.0 / (dim - 1);
}

Lame lame_from_young(int dim, double young, double poisson) {
    if (!(young > 0) || !std::isfinite(young)) {
        throw Error("Young's modulus is " + std::to_string(young) + "; expected more than 0");
    }
    if (!(poisson > -1) || !(poisson < poisson_limit(dim))) {
        throw Error("Poisson's ratio is " + std::to_string(poisson) + "; in " + std::to_string(dim)
                    + "D it must be above -1 and below 1/" + std::to_string(dim - 1));
    }
    return {.lambda = young * poisson / ((1 + poisson) * (1 - (dim - 1) * poisson)),
            .mu = young / (2 * (1 + poisson))};
}

YoungPoisson young_from_lame(int dim, const Lame& lame) {
    const double poisson = lame.lambda / (2 * lame.mu + (dim - 1) * lame.lambda);
    return {.young = 2 * lame.mu * (1 + poisson), .poisson = poisson};
}

void check(const Material& material, int dim) {
    const auto& [lambda, mu] = material.lame;
    if (!(mu > 0) || !std::isfinite(mu)) {
        throw Error("the shear modulus mu is " + std::to_string(mu) + "; expected more than 0");
    }
    if (!(lambda + 2 * mu / dim > 0) || !std::isfinite(lambda)) {
        throw Error("lambda is " + std::to_string(lambda) + "; expected more than -2 mu / "
                    + std::to_string(dim) + ", so that the bulk modulus is positive");
    }
    if (!(material.density > 0) || !std::isfinite(material.density)) {
        throw Error("the density is " + std::to_string(material.density)
                    + "; expected more than 0");
    }
}

}  // namespace pent::simulator
