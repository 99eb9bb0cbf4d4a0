#include "tet_tree.h"

#include <pent/geometry.h>
#include <pent/parallel.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace pent::mesher {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

constexpr std::uint32_t kLeaf = 4;  // tetrahedra to a leaf

// Below this part of the largest volume that edges of these lengths allow, squared, a simplex is
// taken for its sides alone: rounding of the square would decide what is nearest.
constexpr double kFlat = 1e-13;

// Discs of nodes with more tetrahedra are of no use, and take long to find.
constexpr std::uint32_t kMaxInDisc = 1024;

// Above this part of the largest volume, squared, the plane through a simplex is known well enough
// to tell by it that the simplex is too far away.
constexpr double kRound = 1e-4;

// A float that is no less than a length.
float float_above(double length) {
    return std::nextafter(static_cast<float>(length), std::numeric_limits<float>::infinity());
}

struct Foot {
    Vector4d place = Vector4d::Zero();
    double distance_squared = std::numeric_limits<double>::infinity();
};

// The nearest point is the projection on the simplex's own plane if that lies inside; else it lies
// on a side that the projection is beyond.
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
        Square inverse;
        double determinant = 0;
        bool is_invertible = false;
        gram.computeInverseAndDetWithCheck(inverse, determinant, is_invertible, 0.0);
        const double part = determinant / gram.diagonal().prod();
        Eigen::Vector<double, Corners> weights;
        weights.setConstant(-1);
        if (part > kFlat) {
            const Vector4d from = p - corners.col(0);
            weights.template tail<Corners - 1>() = inverse * (edges.transpose() * from);
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

Eigen::Vector4f TetTree::float_below(const Vector4d& p) {
    Eigen::Vector4f below = p.cast<float>();
    for (int axis = 0; axis < 4; ++axis) {
        if (static_cast<double>(below[axis]) > p[axis]) {
            below[axis] = std::nextafter(below[axis], -std::numeric_limits<float>::infinity());
        }
    }
    return below;
}

TetTree::TetTree(std::span<const Vector4d> points, std::span<const Tetrahedron> tetrahedra)
    : patches_(tetrahedra.size(), 0) {
    std::vector<std::uint32_t> order(tetrahedra.size());
    std::iota(order.begin(), order.end(), 0U);
    {
        std::vector<Matrix4d> corners(tetrahedra.size());
        for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
            for (int i = 0; i < 4; ++i) {
                corners[t].col(i) = points[tetrahedra[t][static_cast<std::size_t>(i)]];
            }
        }
        build(corners, order, 0, static_cast<std::uint32_t>(order.size()));
    }
    nodes_.shrink_to_fit();
    // What is near in space is near in memory.
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> names(points.size(), kNone);
    tetrahedra_.reserve(order.size());
    for (const std::uint32_t t : order) {
        Tetrahedron own = tetrahedra[t];
        for (std::uint32_t& corner : own) {
            if (names[corner] == kNone) {
                names[corner] = static_cast<std::uint32_t>(points_.size());
                points_.push_back(points[corner]);
            }
            corner = names[corner];
        }
        tetrahedra_.push_back(own);
    }
    normals_.reserve(order.size());
    is_round_.reserve(order.size());
    for (std::uint32_t t = 0; t < count(); ++t) {
        const Matrix4d own = corners(t);
        const Vector4d normal = facet_normal<4>(own);
        const double most = (own.rightCols<3>().colwise() - own.col(0)).colwise().norm().prod();
        is_round_.push_back(normal.squaredNorm() > kRound * most * most ? 1 : 0);
        const double length = normal.norm();
        normals_.push_back(length > 0 ? Vector4d(normal / length) : Vector4d::Zero());
        const Eigen::Vector4f center = own.rowwise().mean().cast<float>();
        const double radius = (own.colwise() - center.cast<double>()).colwise().norm().maxCoeff();
        balls_.push_back({center, float_above(radius)});
    }
    parallel_for(nodes_.size(), std::size_t{256}, [&](std::size_t i) {
        // Nodes come in the order of their tetrahedra.
        Node& node = nodes_[i];
        const std::uint32_t end = node.after < nodes_.size() ? nodes_[node.after].first : count();
        node.disc.center = (node.low + node.high) / 2;
        if (end - node.first <= kMaxInDisc) {
            node.disc = disc_around(node.first, end);
        }
    });
}

Matrix4d TetTree::corners(std::uint32_t t) const {
    Matrix4d corners;
    for (int i = 0; i < 4; ++i) {
        corners.col(i) = points_[tetrahedra_[t][static_cast<std::size_t>(i)]];
    }
    return corners;
}

// A disc along the mean of the normals.
TetTree::Disc TetTree::disc_around(std::uint32_t first, std::uint32_t end) const {
    Vector4d low = points_[tetrahedra_[first][0]];
    Vector4d high = low;
    Vector4d normals = Vector4d::Zero();
    for (std::uint32_t t = first; t < end; ++t) {
        const Matrix4d own = corners(t);
        low = low.cwiseMin(own.rowwise().minCoeff());
        high = high.cwiseMax(own.rowwise().maxCoeff());
        normals += normals_[t];
    }
    const double length = normals.norm();
    Disc disc;
    disc.center = ((low + high) / 2).cast<float>();
    disc.normal = (length > 0 ? Vector4d(normals / length) : normals).cast<float>();
    const Vector4d center = disc.center.cast<double>();
    const Vector4d normal = disc.normal.cast<double>();
    double radius = 0;
    double thickness = 0;
    for (std::uint32_t t = first; t < end; ++t) {
        for (const std::uint32_t corner : tetrahedra_[t]) {
            const Vector4d from = points_[corner] - center;
            radius = std::max(radius, from.norm());
            thickness = std::max(thickness, std::abs(normal.dot(from)));
        }
    }
    disc.radius = float_above(radius);
    disc.thickness = float_above(thickness);
    return disc;
}

// By the height over the plane and what is left of the way along it.
bool TetTree::may_be_nearer(const Disc& disc, const Vector4d& p, double squared) {
    const Vector4d from = p - disc.center.cast<double>();
    const double across = disc.normal.cast<double>().dot(from);
    const double height = std::max(std::abs(across) - static_cast<double>(disc.thickness), 0.0);
    const double least = (1 - kRounding) * height * height;
    if (least > squared) {
        return false;
    }
    const double along = from.squaredNorm() - (1 + kRounding) * across * across;
    const double radius = static_cast<double>(disc.radius);
    if (along <= radius * radius) {
        return true;
    }
    const double beside = std::sqrt(along) - radius;
    return least + (1 - kRounding) * beside * beside <= squared;
}

// Halves the tetrahedra along the longest side of the box of their middles.
void TetTree::build(const std::vector<Matrix4d>& corners,
                    std::vector<std::uint32_t>& order,
                    std::uint32_t first,
                    std::uint32_t count) {
    Box4 box{corners[order[first]].col(0), corners[order[first]].col(0)};
    Box4 middles{corners[order[first]].rowwise().mean(), corners[order[first]].rowwise().mean()};
    for (std::uint32_t k = first; k < first + count; ++k) {
        const Matrix4d& own = corners[order[k]];
        box.low = box.low.cwiseMin(own.rowwise().minCoeff());
        box.high = box.high.cwiseMax(own.rowwise().maxCoeff());
        middles.low = middles.low.cwiseMin(own.rowwise().mean());
        middles.high = middles.high.cwiseMax(own.rowwise().mean());
    }
    const std::size_t node = nodes_.size();
    nodes_.push_back(
        {float_below(box.low), -float_below(-box.high), first, count <= kLeaf ? count : 0});
    if (count > kLeaf) {
        Eigen::Index axis = 0;
        (middles.high - middles.low).maxCoeff(&axis);
        const auto key = [&](std::uint32_t i) { return corners[i].row(axis).sum(); };
        const auto begin = order.begin() + first;
        std::nth_element(begin, begin + count / 2, begin + count,
                         [&](std::uint32_t a, std::uint32_t b) {
                             return key(a) != key(b) ? key(a) < key(b) : a < b;
                         });
        build(corners, order, first, count / 2);
        build(corners, order, first + count / 2, count - count / 2);
    }
    nodes_[node].after = static_cast<std::uint32_t>(nodes_.size());
}

void TetTree::set_patches(std::vector<int> patches) {
    patches_ = std::move(patches);
    // Children are behind their parents.
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        Node& node = nodes_[i];
        node.patches = 0;
        for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
            node.patches |= bit_of(patches_[t]);
        }
        if (node.count == 0) {
            node.patches |= nodes_[i + 1].patches | nodes_[nodes_[i + 1].after].patches;
        }
    }
}

void TetTree::consider(std::uint32_t t, const Vector4d& p, NearestPoint& best) const {
    if (is_round_[t] != 0) {
        const double height = normals_[t].dot(p - points_[tetrahedra_[t][0]]);
        if (height * height >= best.distance_squared) {
            return;
        }
        const Vector4d from = p - balls_[t].center.cast<double>();
        const double across = normals_[t].dot(from);
        const double along = from.squaredNorm() - (1 + kRounding) * across * across;
        const double radius = static_cast<double>(balls_[t].radius);
        if (along > radius * radius) {
            const double beside = std::sqrt(along) - radius;
            if ((1 - kRounding) * (height * height + beside * beside) > best.distance_squared) {
                return;
            }
        }
    }
    const Matrix4d own = corners(t);
    const Vector4d in_box = p.cwiseMax(own.rowwise().minCoeff()).cwiseMin(own.rowwise().maxCoeff());
    if ((p - in_box).squaredNorm() >= best.distance_squared) {
        return;
    }
    Foot foot{best.place, best.distance_squared};
    find_foot<4>(own, p, foot);
    if (foot.distance_squared < best.distance_squared) {
        best = {t, foot.place, foot.distance_squared};
    }
}

void TetTree::search(std::uint32_t node, const Place& at, int patch, NearestPoint& best) const {
    if (!may_be_nearer(nodes_[node].disc, at.p, best.distance_squared)) {
        return;
    }
    const Node& here = nodes_[node];
    if (here.count > 0) {
        for (std::uint32_t t = here.first; t < here.first + here.count; ++t) {
            if (patch == kAnyPatch ? patches_[t] != kNoPatch : patches_[t] == patch) {
                consider(t, at.p, best);
            }
        }
        return;
    }
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto distance_to = [&](std::uint32_t child) {
        return (nodes_[child].patches & bits_of(patch)) != 0 ? distance_squared(nodes_[child], at)
                                                             : kInfinity;
    };
    std::uint32_t near = node + 1;
    std::uint32_t far = nodes_[near].after;
    double to_near = distance_to(near);
    double to_far = distance_to(far);
    // A point near the surface is in many boxes: the middles of discs say where to begin.
    const auto to_center = [&](std::uint32_t child) {
        return (nodes_[child].disc.center.cast<double>() - at.p).squaredNorm();
    };
    if (to_far < to_near || (to_far == to_near && to_center(far) < to_center(near))) {
        std::swap(near, far);
        std::swap(to_near, to_far);
    }
    if (to_near < best.distance_squared) {
        search(near, at, patch, best);
    }
    if (to_far < best.distance_squared) {
        search(far, at, patch, best);
    }
}

NearestPoint TetTree::nearest(const Vector4d& p, int patch, double max_distance) const {
    NearestPoint best;
    best.distance_squared = max_distance * max_distance;
    search(0, {p, float_below(p), -float_below(-p)}, patch, best);
    return best.distance_squared < max_distance * max_distance ? best : NearestPoint{};
}

}  // namespace pent::mesher
