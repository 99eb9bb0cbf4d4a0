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

template double length<3>(const Stencil<3>&, const Weights<3>&);
template StencilVector<3> length_gradient<3>(const Stencil<3>&, const Weights<3>&);
template StencilMatrix<3> length_hessian<3>(const Stencil<3>&, const Weights<3>&);
template LengthEigensystem<3> length_eigensystem<3>(const Stencil<3>&,
                                                    const Weights<3>&,
                                                    double,
                                                    double);
template double length<4>(const Stencil<4>&, const Weights<4>&);
template StencilVector<4> length_gradient<4>(const Stencil<4>&, const Weights<4>&);
template StencilMatrix<4> length_hessian<4>(const Stencil<4>&, const Weights<4>&);
template LengthEigensystem<4> length_eigensystem<4>(const Stencil<4>&,
                                                    const Weights<4>&,
                                                    double,
                                                    double);

}  // namespace pent::contact
