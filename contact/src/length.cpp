#include "pent/contact/length.h"

#include <cassert>

namespace pent::contact {

template <int Dim>
double length(const Stencil<Dim>& points, const Weights<Dim>& weights) {
    return (points * weights).norm();
}

template <int Dim>
StencilVector<Dim> length_gradient(const Stencil<Dim>& points, const Weights<Dim>& weights) {
    const Vector<Dim> direction = (points * weights).stableNormalized();
    StencilVector<Dim> gradient;
    for (int i = 0; i <= Dim; ++i) {
        gradient.template segment<Dim>(Dim * i) = weights[i] * direction;
    }
    return gradient;
}

template <int Dim>
StencilMatrix<Dim> length_hessian(const Stencil<Dim>& points, const Weights<Dim>& weights) {
    const Vector<Dim> difference = points * weights;
    const double l = difference.norm();
    if (l == 0) {
        return StencilMatrix<Dim>::Zero();
    }
    const Vector<Dim> direction = difference / l;
    const Eigen::Matrix<double, Dim, Dim> block =
        (Eigen::Matrix<double, Dim, Dim>::Identity() - direction * direction.transpose()) / l;
    StencilMatrix<Dim> hessian;
    for (int i = 0; i <= Dim; ++i) {
        for (int j = 0; j <= Dim; ++j) {
            hessian.template block<Dim, Dim>(Dim * i, Dim * j) = weights[i] * weights[j] * block;
        }
    }
    return hessian;
}

template <int Dim>
LengthEigensystem<Dim> length_eigensystem(const Stencil<Dim>& points,
                                          const Weights<Dim>& weights,
                                          double slope,
                                          double curvature) {
    const Vector<Dim> difference = points * weights;
    const double l = difference.norm();
    assert(l > 0);
    const double squared = weights.squaredNorm();
    return {curvature * squared, slope * squared / l, difference / l};
}

#define PENT_INSTANTIATE(Dim)                                                                   \
    template double length<Dim>(const Stencil<Dim>&, const Weights<Dim>&);                      \
    template StencilVector<Dim> length_gradient<Dim>(const Stencil<Dim>&, const Weights<Dim>&); \
    template StencilMatrix<Dim> length_hessian<Dim>(const Stencil<Dim>&, const Weights<Dim>&);  \
    template LengthEigensystem<Dim> length_eigensystem<Dim>(const Stencil<Dim>&,                \
                                                            const Weights<Dim>&, double, double);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
