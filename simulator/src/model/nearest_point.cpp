#include "model/nearest_point.h"

#include <pent/dimensions.h>

#include <Eigen/Dense>

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>
#include <vector>

namespace pent::simulator {

namespace {

template <int Dim>
using Corners = Eigen::Matrix<double, Dim, Dim + 1>;

// The projection of a point onto the affine hull of a face (bit i of the mask: corner i), as
// barycentric coordinates of the cell: 0 for corners that the face lacks.
template <int Dim>
typename MaterialPoint<Dim>::Weights foot(const Corners<Dim>& corners,
                                          unsigned face,
                                          const Vector<Dim>& point) {
    using Weights = typename MaterialPoint<Dim>::Weights;
    const int first = std::countr_zero(face);
    // Corners that are not in the face have edges of 0, and a diagonal entry in their place below:
    // the system stays regular.
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
    // Of the size of the other entries, so that none is lost beside it.
    normal.diagonal() += normal.trace() / Dim * absent;
    Weights weights = Weights::Zero();
    if (std::popcount(face) > 1) {
        weights = normal.ldlt().solve(edges.transpose() * (point - corners.col(first)));
        weights = absent.select(0.0 * weights, weights).eval();
    }
    weights[first] = 1 - weights.sum();
    return weights;
}

// A point of a cell, and its distance.
template <int Dim>
struct PointOfCell {
    typename MaterialPoint<Dim>::Weights weights = MaterialPoint<Dim>::Weights::Zero();
    double distance = std::numeric_limits<double>::infinity();
};

// The nearest point of one cell: the nearest of the projections onto its faces that lie within
// them.
template <int Dim>
PointOfCell<Dim> nearest_of_cell(const Corners<Dim>& corners, const Vector<Dim>& point) {
    constexpr unsigned kFaces = 1U << (Dim + 1);
    PointOfCell<Dim> nearest;
    for (unsigned face = kFaces - 1; face > 0; --face) {  // the whole cell first
        const auto weights = foot<Dim>(corners, face, point);
        if (weights.minCoeff() < 0) {
            continue;
        }
        const double distance = face == kFaces - 1 ? 0 : (corners * weights - point).norm();
        if (distance < nearest.distance) {
            nearest = {weights, distance};
        }
        if (distance == 0) {
            break;
        }
    }
    return nearest;
}

// Distances up to this factor count as the same: cells share faces, and which of them is nearer by
// rounding differs from build to build. No box is beyond it that holds a cell within it: boxes are
// rounded outward.
constexpr double kSame = 1 + 1e-9;

}  // namespace

template <int Dim>
NearestPointSearch<Dim>::NearestPointSearch(const Positions<Dim>& positions,
                                            Simplices<Dim + 1> cells)
    : positions_(positions), cells_(std::move(cells)) {
    std::vector<contact::Box> boxes;
    boxes.reserve(static_cast<std::size_t>(cells_.cols()));
    for (Eigen::Index cell = 0; cell < cells_.cols(); ++cell) {
        boxes.push_back(contact::box_around<Dim, Dim + 1>(corners(cell), 0));
    }
    tree_ = contact::BoxTree(boxes);
}

template <int Dim>
Corners<Dim> NearestPointSearch<Dim>::corners(Eigen::Index cell) const {
    Corners<Dim> corners;
    for (int i = 0; i <= Dim; ++i) {
        corners.col(i) = positions_.col(cells_(i, cell));
    }
    return corners;
}

template <int Dim>
double NearestPointSearch<Dim>::distance(const Vector<Dim>& point) const {
    double least = std::numeric_limits<double>::infinity();
    if (!tree_.is_empty()) {
        tree_.for_each_near<Dim>(point, least, [&](std::uint32_t cell) {
            least = std::min(least, nearest_of_cell<Dim>(corners(cell), point).distance);
            return least * least * kSame;
        });
    }
    return least;
}

template <int Dim>
std::optional<Eigen::Index> NearestPointSearch<Dim>::first_at(const Vector<Dim>& point,
                                                              double distance) const {
    if (tree_.is_empty()) {
        return std::nullopt;
    }
    const double most = distance * kSame;
    std::optional<std::uint32_t> first;
    tree_.for_each_near<Dim>(point, most * most * kSame, [&](std::uint32_t cell) {
        if ((!first || cell < *first)
            && nearest_of_cell<Dim>(corners(cell), point).distance <= most) {
            first = cell;
        }
        return most * most * kSame;
    });
    return first;
}

template <int Dim>
MaterialPoint<Dim> NearestPointSearch<Dim>::nearest_in(Eigen::Index cell,
                                                       const Vector<Dim>& point) const {
    const PointOfCell<Dim> best = nearest_of_cell<Dim>(corners(cell), point);
    MaterialPoint<Dim> nearest;
    nearest.weights = best.weights;
    nearest.distance = best.distance;
    for (int i = 0; i <= Dim; ++i) {
        nearest.vertices[static_cast<std::size_t>(i)] = cells_(i, cell);
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

#define PENT_INSTANTIATE(Dim)                              \
    template class NearestPointSearch<Dim>;                \
    template MaterialPoint<Dim>::Weights barycentric<Dim>( \
        const Eigen::Matrix<double, Dim, Dim + 1>&, const Vector<Dim>&);
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
