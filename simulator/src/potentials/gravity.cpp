#include "potentials/gravity.h"

#include "potentials/vertex_chunks.h"

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

#ifndef PENT_ONLY_4D
template class Gravity<3>;
#endif
template class Gravity<4>;

}  // namespace pent::simulator
