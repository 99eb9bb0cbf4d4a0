#include "pent/contact/barrier.h"

#include <pent/contact/surface.h>

#include <array>

namespace pent::contact {

namespace {

template <int Dim>
using Edges = Eigen::Matrix<double, Dim, Dim - 1>;

// The corner at which each edge starts: those of the first simplex at corner 0, of the ridge at 2.
constexpr int start(int edge) {
    return edge == 0 ? 0 : 2;
}
constexpr int end(int edge) {
    return edge == 0 ? 1 : edge + 2;
}

template <int Dim>
Edges<Dim> edges_of(const Stencil<Dim>& points) {
    Edges<Dim> edges;
    for (int k = 0; k < Dim - 1; ++k) {
        edges.col(k) = points.col(end(k)) - points.col(start(k));
    }
    return edges;
}

// Normal to all edges, and as long as their box has volume.
template <int Dim>
Vector<Dim> normal_to(const Edges<Dim>& edges) {
    Corners<Dim, Dim> corners;
    corners << Vector<Dim>::Zero(), edges;
    return facet_normal<Dim>(corners);
}

// Derivative of the normal by edge k: it is linear in each edge.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> normal_by_edge(Edges<Dim> edges, int k) {
    Eigen::Matrix<double, Dim, Dim> jacobian;
    for (int axis = 0; axis < Dim; ++axis) {
        edges.col(k) = Vector<Dim>::Unit(axis);
        jacobian.col(axis) = normal_to<Dim>(edges);
    }
    return jacobian;
}

// Adds a block between two edges to the blocks between their corners.
template <int Dim>
void add_block(int k, int l, const Eigen::Matrix<double, Dim, Dim>& block, StencilMatrix<Dim>& to) {
    to.template block<Dim, Dim>(Dim * end(k), Dim * end(l)) += block;
    to.template block<Dim, Dim>(Dim * start(k), Dim * start(l)) += block;
    to.template block<Dim, Dim>(Dim * end(k), Dim * start(l)) -= block;
    to.template block<Dim, Dim>(Dim * start(k), Dim * end(l)) -= block;
}

}  // namespace

template <int Dim>
double spanned_volume_squared(const Stencil<Dim>& points) {
    return normal_to<Dim>(edges_of<Dim>(points)).squaredNorm();
}

template <int Dim>
StencilVector<Dim> spanned_volume_squared_gradient(const Stencil<Dim>& points) {
    const Edges<Dim> edges = edges_of<Dim>(points);
    const Vector<Dim> normal = normal_to<Dim>(edges);
    StencilVector<Dim> gradient = StencilVector<Dim>::Zero();
    for (int k = 0; k < Dim - 1; ++k) {
        const Vector<Dim> by_edge = 2 * normal_by_edge<Dim>(edges, k).transpose() * normal;
        gradient.template segment<Dim>(Dim * end(k)) += by_edge;
        gradient.template segment<Dim>(Dim * start(k)) -= by_edge;
    }
    return gradient;
}

template <int Dim>
StencilMatrix<Dim> spanned_volume_squared_hessian(const Stencil<Dim>& points) {
    const Edges<Dim> edges = edges_of<Dim>(points);
    const Vector<Dim> normal = normal_to<Dim>(edges);
    std::array<Eigen::Matrix<double, Dim, Dim>, Dim - 1> jacobians;
    for (int k = 0; k < Dim - 1; ++k) {
        jacobians[k] = normal_by_edge<Dim>(edges, k);
    }
    StencilMatrix<Dim> hessian = StencilMatrix<Dim>::Zero();
    for (int k = 0; k < Dim - 1; ++k) {
        for (int l = 0; l < Dim - 1; ++l) {
            Eigen::Matrix<double, Dim, Dim> block = 2 * jacobians[k].transpose() * jacobians[l];
            if (k != l) {
                Edges<Dim> moved = edges;
                for (int axis = 0; axis < Dim; ++axis) {
                    moved.col(k) = Vector<Dim>::Unit(axis);
                    block.row(axis) += 2 * normal.transpose() * normal_by_edge<Dim>(moved, l);
                }
            }
            add_block<Dim>(k, l, block, hessian);
        }
    }
    return hessian;
}

#define PENT_INSTANTIATE(Dim)                                                              \
    template double spanned_volume_squared<Dim>(const Stencil<Dim>&);                      \
    template StencilVector<Dim> spanned_volume_squared_gradient<Dim>(const Stencil<Dim>&); \
    template StencilMatrix<Dim> spanned_volume_squared_hessian<Dim>(const Stencil<Dim>&);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
