#include "tet_tree.h"

#include <pent/geometry.h>

#include <Eigen/LU>

#include <algorithm>
#include <limits>
#include <numeric>

namespace pent::mesher {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

constexpr std::uint32_t kLeaf = 4;  // tetrahedra to a leaf

// Below this part of the largest volume that edges of these lengths allow, squared, a simplex is
// taken for its sides alone: rounding of the square would decide what is nearest.
constexpr double kFlat = 1e-13;

// Above this one the plane through a simplex is known to some digits more than its distances are.
constexpr double kRound = 1e-4;

struct Foot {
    Vector4d place = Vector4d::Zero();
    double distance_squared = std::numeric_limits<double>::infinity();
};

// The nearest point lies inside, or on a side beyond which the point is.
template <int Corners>
void find_foot(const Eigen::Matrix<double, 4, Corners>& corners, const Vector4d& p, Foot& best) {
    if constexpr (Corners == 1) {
        const double distance_squared = (p - corners).squaredNorm();
        if (distance_squared < best.distance_squared) {
            best = {corners, distance_squared};
        }
    } else {
        using Square = Eigen::Matrix<double, Corners - 1, Corners - 1>;
        const Eigen::Matrix<double, 4, Corners - 1> edges =
            corners.template rightCols<Corners - 1>().colwise() - corners.col(0);
        const Square gram = edges.transpose() * edges;
        const double part = gram.determinant() / gram.diagonal().prod();
        Eigen::Vector<double, Corners> weights;
        weights.setConstant(-1);
        if (part > kFlat) {
            const Vector4d from = p - corners.col(0);
            weights.template tail<Corners - 1>() = gram.inverse() * (edges.transpose() * from);
            weights[0] = 1 - weights.template tail<Corners - 1>().sum();
            const Vector4d place = corners * weights;
            const double distance_squared = (p - place).squaredNorm();
            const bool is_inside = weights.minCoeff() >= 0;
            if (is_inside && distance_squared < best.distance_squared) {
                best = {place, distance_squared};
            }
            // No side is nearer than the plane through all.
            if (is_inside || (part > kRound && distance_squared >= best.distance_squared)) {
                return;
            }
        }
        for (int without = 0; without < Corners; ++without) {
            if (weights[without] < 0) {
                Eigen::Matrix<double, 4, Corners - 1> side;
                for (int i = 0, at = 0; i < Corners; ++i) {
                    if (i != without) {
                        side.col(at++) = corners.col(i);
                    }
                }
                find_foot<Corners - 1>(side, p, best);
            }
        }
    }
}

}  // namespace

Vector4d nearest_point(const Matrix4d& corners, const Vector4d& p) {
    Foot best;
    find_foot<4>(corners, p, best);
    return best.place;
}

TetTree::TetTree(std::vector<Matrix4d> corners, std::vector<std::uint32_t> names)
    : corners_(std::move(corners)), names_(std::move(names)) {
    std::vector<std::uint32_t> order(names_.size());
    std::iota(order.begin(), order.end(), 0U);
    if (!order.empty()) {
        build(order, 0, static_cast<std::uint32_t>(order.size()));
    }
    std::vector<Matrix4d> sorted_corners;
    std::vector<std::uint32_t> sorted_names;
    sorted_corners.reserve(order.size());
    sorted_names.reserve(order.size());
    for (const std::uint32_t i : order) {
        sorted_corners.push_back(corners_[i]);
        sorted_names.push_back(names_[i]);
    }
    corners_ = std::move(sorted_corners);
    for (const Matrix4d& own : corners_) {
        const Vector4d normal = facet_normal<4>(own);
        const double most = (own.rightCols<3>().colwise() - own.col(0)).colwise().norm().prod();
        const bool is_round = normal.squaredNorm() > kRound * most * most;
        normals_.push_back(is_round ? normal.normalized() : Vector4d::Zero());
    }
    names_ = std::move(sorted_names);
}

// Halves the tetrahedra along the longest side of the box of their middles.
void TetTree::build(std::vector<std::uint32_t>& order, std::uint32_t first, std::uint32_t count) {
    Box4 box{corners_[order[first]].col(0), corners_[order[first]].col(0)};
    Box4 middles{corners_[order[first]].rowwise().mean(), corners_[order[first]].rowwise().mean()};
    for (std::uint32_t k = first; k < first + count; ++k) {
        const Matrix4d& own = corners_[order[k]];
        box.low = box.low.cwiseMin(own.rowwise().minCoeff());
        box.high = box.high.cwiseMax(own.rowwise().maxCoeff());
        middles.low = middles.low.cwiseMin(own.rowwise().mean());
        middles.high = middles.high.cwiseMax(own.rowwise().mean());
    }
    const std::size_t node = nodes_.size();
    nodes_.push_back({box, first, count <= kLeaf ? count : 0, 0});
    if (count > kLeaf) {
        Eigen::Index axis = 0;
        (middles.high - middles.low).maxCoeff(&axis);
        const auto key = [&](std::uint32_t i) { return corners_[i].row(axis).sum(); };
        const auto begin = order.begin() + first;
        std::nth_element(begin, begin + count / 2, begin + count,
                         [&](std::uint32_t a, std::uint32_t b) {
                             return key(a) != key(b) ? key(a) < key(b) : a < b;
                         });
        build(order, first, count / 2);
        build(order, first + count / 2, count - count / 2);
    }
    nodes_[node].after = static_cast<std::uint32_t>(nodes_.size());
}

void TetTree::search(std::uint32_t node, const Vector4d& p, NearestPoint& best) const {
    const Node& here = nodes_[node];
    for (std::uint32_t k = here.first; k < here.first + here.count; ++k) {
        const double height = normals_[k].dot(p - corners_[k].col(0));
        if (height * height >= best.distance_squared) {
            continue;
        }
        const Box4 box{corners_[k].rowwise().minCoeff(), corners_[k].rowwise().maxCoeff()};
        if (distance_squared(box, p) >= best.distance_squared) {
            continue;
        }
        Foot foot{best.place, best.distance_squared};
        find_foot<4>(corners_[k], p, foot);
        if (foot.distance_squared < best.distance_squared) {
            best = {names_[k], foot.place, foot.distance_squared};
        }
    }
    if (here.count > 0) {
        return;
    }
    std::uint32_t near = node + 1;
    std::uint32_t far = nodes_[near].after;
    if (distance_squared(nodes_[far].box, p) < distance_squared(nodes_[near].box, p)) {
        std::swap(near, far);
    }
    for (const std::uint32_t child : {near, far}) {
        if (distance_squared(nodes_[child].box, p) < best.distance_squared) {
            search(child, p, best);
        }
    }
}

NearestPoint TetTree::nearest(const Vector4d& p) const {
    NearestPoint best;
    best.distance_squared = std::numeric_limits<double>::infinity();
    search(0, p, best);
    return best;
}

}  // namespace pent::mesher
