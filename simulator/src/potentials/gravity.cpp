#include "potentials/gravity.h"

#include "potentials/vertex_chunks.h"

#include <pent/dimensions.h>

namespace pent::simulator {

template <int Dim>
double Gravity<Dim>::evaluate(const Positions<Dim>& x, Positions<Dim>& gradient) {
    if (acceleration_.isZero(0)) {
        return 0;
    }
    energy_ = sum_vertices(*workers_, x.cols(), [&](Eigen::Index v) {
        const double mass = (*masses_)[v];
        gradient.col(v) -= mass * acceleration_;
        return -mass * acceleration_.dot(x.col(v));
    });
    return energy_;
}

#define PENT_INSTANTIATE(Dim) template class Gravity<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
