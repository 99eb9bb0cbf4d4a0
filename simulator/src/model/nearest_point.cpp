#include "model/nearest_point.h"

#include <Eigen/Dense>

#include <bit>
#include <limits>

namespace pent::simulator {

namespace {

template <int Dim>
using Corners = Eigen::Matrix<double, Dim, Dim + 1>;

// Barycentric coordinates in the face of these corners (bit i: corner i) of the foot of a point
// upon it, all of the cell.
template <int Dim>
typename MaterialPoint<Dim>::Weights foot(const Corners<Dim>& corners,
                                          unsigned face,
                                          const Vector<Dim>& point) {
    using Weights = typename MaterialPoint<Dim>::Weights;
    const int first = std::countr_zero(face);
    // With the edges of corners that are not in the face being 0, their rows are those of 1.
    Eigen::Matrix<double, Dim, Dim + 1> edges = corners.colwise() - corners.col(first);
    Weights absent = Weights::Ones();
    for (int i = 0; i <= Dim; ++i) {
        if ((face >> i & 1U) != 0 && i != first) {
            absent[i] = 0;
        } else {
            edges.col(i).setZero();
        }
    }
    Eigen::Matrix<double, Dim + 1, Dim + 1> normal = edges.transpose() * edges;
    // Of the size of the others, so that none is lost next to it.
    normal.diagonal() += normal.trace() / Dim * absent;
    Weights weights = Weights::Zero();
    if (std::popcount(face) > 1) {
        weights = normal.ldlt().solve(edges.transpose() * (point - corners.col(first)));
        weights = absent.select(0.0 * weights, weights).eval();
    }
    weights[first] = 1 - weights.sum();
    return weights;
}

// The nearest point of one cell: the least distant of those feet upon its faces that lie in them.
template <int Dim>
void take_nearer(const Corners<Dim>& corners,
                 const Vector<Dim>& point,
                 MaterialPoint<Dim>& nearest,
                 bool& is_taken) {
    constexpr unsigned kFaces = 1U << (Dim + 1);
    is_taken = false;
    for (unsigned face = kFaces - 1; face > 0; --face) {  // the whole cell first
        const auto weights = foot<Dim>(corners, face, point);
        if (weights.minCoeff() < 0) {
            continue;
        }
        const double distance = face == kFaces - 1 ? 0 : (corners * weights - point).norm();
        if (distance < nearest.distance) {
            nearest.distance = distance;
            nearest.weights = weights;
            is_taken = true;
        }
        if (distance == 0) {
            return;
        }
    }
}

}  // namespace

template <int Dim>
MaterialPoint<Dim> nearest_point(const Positions<Dim>& positions,
                                 const Eigen::Ref<const Simplices<Dim + 1>>& cells,
                                 const Vector<Dim>& point) {
    // No farther than the nearest corner; most boxes around cells are.
    double bound = std::numeric_limits<double>::infinity();
    for (const std::uint32_t vertex : cells.reshaped()) {
        bound = std::min(bound, (positions.col(vertex) - point).squaredNorm());
    }
    MaterialPoint<Dim> nearest;
    nearest.distance = std::numeric_limits<double>::infinity();
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        Corners<Dim> corners;
        for (int i = 0; i <= Dim; ++i) {
            corners.col(i) = positions.col(cells(i, cell));
        }
        const Vector<Dim> low = corners.rowwise().minCoeff();
        const Vector<Dim> high = corners.rowwise().maxCoeff();
        if ((low - point).cwiseMax(point - high).cwiseMax(0).squaredNorm() > bound) {
            continue;
        }
        bool is_taken = false;
        take_nearer<Dim>(corners, point, nearest, is_taken);
        if (is_taken) {
            for (int i = 0; i <= Dim; ++i) {
                nearest.vertices[static_cast<std::size_t>(i)] = cells(i, cell);
            }
            bound = std::min(bound, nearest.distance * nearest.distance);
        }
    }
    return nearest;
}

template <int Dim>
typename MaterialPoint<Dim>::Weights barycentric(const Eigen::Matrix<double, Dim, Dim + 1>& corners,
                                                 const Vector<Dim>& point) {
    const Matrix<Dim> edges = corners.template rightCols<Dim>().colwise() - corners.col(0);
    typename MaterialPoint<Dim>::Weights weights;
    weights.template tail<Dim>() = edges.partialPivLu().solve(point - corners.col(0));
    weights[0] = 1 - weights.template tail<Dim>().sum();
    return weights;
}

#define PENT_INSTANTIATE(Dim)                                                                    \
    template MaterialPoint<Dim> nearest_point<Dim>(                                              \
        const Positions<Dim>&, const Eigen::Ref<const Simplices<Dim + 1>>&, const Vector<Dim>&); \
    template MaterialPoint<Dim>::Weights barycentric<Dim>(                                       \
        const Eigen::Matrix<double, Dim, Dim + 1>&, const Vector<Dim>&);
PENT_INSTANTIATE(3)
PENT_INSTANTIATE(4)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
