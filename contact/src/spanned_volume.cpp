#include "spanned_volume.h"

#include "normals.h"

#include <pent/dimensions.h>

#include <array>

namespace pent::contact {

namespace {

template <int Dim>
using Edges = Eigen::Matrix<double, Dim, Dim - 1>;

// The corners at which the edges start and end: the first is that of the edge, all others are those
// of the ridge from its first corner.
template <int Dim>
struct Layout {
    int edge = 0;
    int ridge = 2;

    explicit Layout(int first_count) {
        if (first_count != 2) {
            ridge = 0;
            edge = Dim - 1;
        }
    }
    [[nodiscard]] int start(int k) const { return k == 0 ? edge : ridge; }
    [[nodiscard]] int end(int k) const { return k == 0 ? edge + 1 : ridge + k; }
};

template <int Dim>
Edges<Dim> edges_of(const Stencil<Dim>& points, const Layout<Dim>& at) {
    Edges<Dim> edges;
    for (int k = 0; k < Dim - 1; ++k) {
        edges.col(k) = points.col(at.end(k)) - points.col(at.start(k));
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
Block<Dim> normal_by_edge(Edges<Dim> edges, int k) {
    Block<Dim> jacobian;
    for (int axis = 0; axis < Dim; ++axis) {
        edges.col(k) = Vector<Dim>::Unit(axis);
        jacobian.col(axis) = normal_to<Dim>(edges);
    }
    return jacobian;
}

// Adds a block between two edges to the blocks between their corners.
template <int Dim>
void add_block(
    const Layout<Dim>& at, int k, int l, const Block<Dim>& block, StencilMatrix<Dim>& to) {
    to.template block<Dim, Dim>(Dim * at.end(k), Dim * at.end(l)) += block;
    to.template block<Dim, Dim>(Dim * at.start(k), Dim * at.start(l)) += block;
    to.template block<Dim, Dim>(Dim * at.end(k), Dim * at.start(l)) -= block;
    to.template block<Dim, Dim>(Dim * at.start(k), Dim * at.end(l)) -= block;
}

}  // namespace

template <int Dim>
double spanned_volume_squared(const Stencil<Dim>& points, int first_count) {
    return normal_to<Dim>(edges_of<Dim>(points, Layout<Dim>(first_count))).squaredNorm();
}

template <int Dim>
StencilVector<Dim> spanned_volume_squared_gradient(const Stencil<Dim>& points, int first_count) {
    const Layout<Dim> at(first_count);
    const Edges<Dim> edges = edges_of<Dim>(points, at);
    const Vector<Dim> normal = normal_to<Dim>(edges);
    StencilVector<Dim> gradient = StencilVector<Dim>::Zero();
    for (int k = 0; k < Dim - 1; ++k) {
        const Vector<Dim> by_edge = 2 * normal_by_edge<Dim>(edges, k).transpose() * normal;
        gradient.template segment<Dim>(Dim * at.end(k)) += by_edge;
        gradient.template segment<Dim>(Dim * at.start(k)) -= by_edge;
    }
    return gradient;
}

template <int Dim>
StencilMatrix<Dim> spanned_volume_squared_hessian(const Stencil<Dim>& points, int first_count) {
    const Layout<Dim> at(first_count);
    const Edges<Dim> edges = edges_of<Dim>(points, at);
    const Vector<Dim> normal = normal_to<Dim>(edges);
    std::array<Block<Dim>, Dim - 1> jacobians;
    for (int k = 0; k < Dim - 1; ++k) {
        jacobians[k] = normal_by_edge<Dim>(edges, k);
    }
    StencilMatrix<Dim> hessian = StencilMatrix<Dim>::Zero();
    for (int k = 0; k < Dim - 1; ++k) {
        for (int l = 0; l < Dim - 1; ++l) {
            Block<Dim> block = 2 * jacobians[k].transpose() * jacobians[l];
            if (k != l) {
                Edges<Dim> moved = edges;
                for (int axis = 0; axis < Dim; ++axis) {
                    moved.col(k) = Vector<Dim>::Unit(axis);
                    block.row(axis) += 2 * normal.transpose() * normal_by_edge<Dim>(moved, l);
                }
            }
            add_block<Dim>(at, k, l, block, hessian);
        }
    }
    return hessian;
}

#define PENT_INSTANTIATE(Dim)                                                                   \
    template double spanned_volume_squared<Dim>(const Stencil<Dim>&, int);                      \
    template StencilVector<Dim> spanned_volume_squared_gradient<Dim>(const Stencil<Dim>&, int); \
    template StencilMatrix<Dim> spanned_volume_squared_hessian<Dim>(const Stencil<Dim>&, int);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::contact
