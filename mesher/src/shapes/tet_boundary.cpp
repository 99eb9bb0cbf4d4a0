#include "tet_boundary.h"

#include "../union_find.h"
#include "exact_signs.h"

#include <pent/geometry.h>
#include <pent/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace pent::mesher {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;
using exchange::TetSurface;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Tetrahedra that meet at less are one smooth patch: the cosine of 40 degrees.
constexpr double kSmoothCosine = 0.766;

// In parts of coordinates: nearer than this a point is taken to be on the boundary. Further away
// the direction to the nearest point is known to about 1e-5.
constexpr double kRounding = 1e-11;

// In parts of lengths: more than rounding, less than anything that shows.
constexpr double kSlack = 1e-9;

// An arbitrary rotation: rays along the last axis are then parallel to no face of the many bodies
// that have their faces along the axes.
Matrix4d odd_rotation() {
    Matrix4d rotation = plane_rotation<4>(0, 1, 0.4123);
    rotation = plane_rotation<4>(2, 3, 0.7071) * rotation;
    rotation = plane_rotation<4>(1, 2, 1.1357) * rotation;
    return plane_rotation<4>(0, 3, 0.5911) * rotation;
}

TetTree turned_tree(const TetSurface& surface, const Matrix4d& rotation) {
    std::vector<Vector4d> points(static_cast<std::size_t>(surface.points.cols()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = rotation * surface.points.col(static_cast<Eigen::Index>(i));
    }
    std::vector<TetTree::Tetrahedron> tetrahedra(
        static_cast<std::size_t>(surface.tetrahedra.cols()));
    for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
        const auto corners = surface.tetrahedra.col(static_cast<Eigen::Index>(t));
        std::copy(corners.begin(), corners.end(), tetrahedra[t].begin());
    }
    return {points, tetrahedra};
}

// For each tetrahedron the lowest one of its smooth part: they are joined across triangles that two
// of them share, where their normals differ little.
std::vector<std::uint32_t> smooth_parts(const TetTree& tree) {
    struct Side {
        std::array<std::uint32_t, 3> corners{};
        std::uint32_t tetrahedron = 0;
    };
    std::vector<Side> sides;
    sides.reserve(4 * static_cast<std::size_t>(tree.count()));
    for (std::uint32_t t = 0; t < tree.count(); ++t) {
        TetTree::Tetrahedron corners = tree.tetrahedron(t);
        std::sort(corners.begin(), corners.end());
        for (const std::uint32_t without : corners) {
            Side side{{}, t};
            std::remove_copy(corners.begin(), corners.end(), side.corners.begin(), without);
            sides.push_back(side);
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.corners != b.corners ? a.corners < b.corners : a.tetrahedron < b.tetrahedron;
    });
    UnionFind parts(tree.count());
    const auto are_one = [&](std::size_t i, std::size_t j) {
        return j < sides.size() && sides[i].corners == sides[j].corners;
    };
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (are_one(i, end)) {
            ++end;
        }
        if (end == i + 2) {
            const std::uint32_t a = sides[i].tetrahedron;
            const std::uint32_t b = sides[i + 1].tetrahedron;
            if (tree.normal(a).dot(tree.normal(b)) > kSmoothCosine) {
                parts.join(a, b);
            }
        }
        i = end;
    }
    std::vector<std::uint32_t> names(tree.count());
    for (std::uint32_t t = 0; t < names.size(); ++t) {
        names[t] = parts.find(t);
    }
    return names;
}

}  // namespace

TetBoundary::TetBoundary(const TetSurface& surface)
    : rotation_(odd_rotation()), tree_(turned_tree(surface, rotation_)) {
    std::vector<std::uint8_t> is_outer(tree_.count(), 0);
    constexpr std::uint32_t kTask = 256;
    parallel_for(tree_.count(), kTask,
                 [&](std::uint32_t t) { is_outer[t] = separates(t) ? 1 : 0; });
    find_patches(is_outer);
}

void TetBoundary::find_patches(const std::vector<std::uint8_t>& is_outer) {
    const std::vector<std::uint32_t> parts = smooth_parts(tree_);
    std::vector<int> names(parts.size(), TetTree::kNoPatch);
    std::vector<int> patches(parts.size(), TetTree::kNoPatch);
    for (std::uint32_t t = 0; t < parts.size(); ++t) {
        if (is_outer[t] == 0) {
            ++inner_count_;
            continue;
        }
        int& name = names[parts[t]];
        if (name == TetTree::kNoPatch) {
            name = patch_count_++;
        }
        patches[t] = name;
    }
    tree_.set_patches(std::move(patches));
}

// The sum over all tetrahedra above a point, in the axes of the tree.
int TetBoundary::crossings(const Vector4d& from, std::uint32_t without) const {
    int sum = 0;
    tree_.visit_ray(from, [&](std::uint32_t t) {
        // Where the ray leaves a body the normal has a part along it: the shadow is turned over.
        sum -= t != without ? crossing_sign(tree_.corners(t), from) : 0;
    });
    return sum;
}

// Whether the body is on one side only of a tetrahedron, at one at least of five points of it.
bool TetBoundary::separates(std::uint32_t tetrahedron) const {
    const Matrix4d corners = tree_.corners(tetrahedron);
    const Vector4d middle = corners.rowwise().mean();
    const Vector4d below = middle - Vector4d::Unit(3) * corners.cwiseAbs().maxCoeff();
    const int own = -crossing_sign(corners, below);
    if (own == 0) {
        return true;  // without a shadow
    }
    const auto separates_at = [&](const Vector4d& p) {
        const int others = crossings(p, tetrahedron);
        return (others == 0) != (others + own == 0);
    };
    if (separates_at(middle)) {
        return true;
    }
    for (int i = 0; i < 4; ++i) {
        constexpr double kTowardsCorner = 0.8;
        if (separates_at(middle + kTowardsCorner * (corners.col(i) - middle))) {
            return true;
        }
    }
    return false;
}

int TetBoundary::winding_number(const Vector4d& p) const {
    return crossings(rotation_ * p, kNone);
}

double TetBoundary::value(const Vector4d& p) const {
    const Vector4d there = rotation_ * p;
    return signed_distance(there, tree_.nearest(there));
}

double TetBoundary::value_near(const Vector4d& p,
                               double enough,
                               std::span<const Sample> known) const {
    const Vector4d there = rotation_ * p;
    const NearestPoint nearest = tree_.nearest(there, TetTree::kAnyPatch, enough);
    const double distance = std::min(enough, std::sqrt(nearest.distance_squared));
    // A part of an inner one may be where the body ends.
    for (const Sample& sample : inner_count_ == 0 ? known : std::span<const Sample>()) {
        if (std::abs(sample.value) + distance > (1 + kSlack) * (sample.place - p).norm()) {
            return std::copysign(distance, sample.value);
        }
    }
    return std::clamp(signed_distance(there, nearest), -enough, enough);
}

// Further away than twice the radius it is enough to know that.
ValueRange TetBoundary::range(const Vector4d& center, double radius) const {
    const Vector4d there = rotation_ * center;
    const NearestPoint nearest = tree_.nearest(there, TetTree::kAnyPatch, 2 * radius);
    const double distance = std::sqrt(nearest.distance_squared);
    if (distance <= radius) {
        return {-distance - radius, distance + radius};
    }
    const double least = std::min(distance, 2 * radius) - radius;
    return crossings(there, kNone) != 0 ? ValueRange{-distance - radius, -least}
                                        : ValueRange{least, distance + radius};
}

double TetBoundary::distance(const Vector4d& p, double max_distance) const {
    return std::sqrt(
        tree_.nearest(rotation_ * p, TetTree::kAnyPatch, max_distance).distance_squared);
}

Vector4d TetBoundary::foot(const Vector4d& p, int patch) const {
    return rotation_.transpose() * tree_.nearest(rotation_ * p, patch).place;
}

std::optional<double> TetBoundary::first_crossing(const Vector4d& outside,
                                                  const Vector4d& to) const {
    const Vector4d from = rotation_ * outside;
    const Vector4d way = rotation_ * (to - outside);
    std::optional<double> first;
    tree_.visit_segment(from, way, [&](std::uint32_t t) {
        const double most = first.value_or(1);
        const Vector4d& normal = tree_.normal(t);
        const double part = normal.dot(tree_.corner(t, 0) - from) / normal.dot(way);
        if (!(part >= 0 && part <= most)) {
            return most;
        }
        const Vector4d place = from + part * way;
        if (!tree_.may_hold(t, place)) {
            return most;
        }
        const Matrix4d corners = tree_.corners(t);
        const double aside = (nearest_point(corners, place) - place).norm();
        if (aside <= kSlack * (corners.rightCols<3>().colwise() - corners.col(0)).norm()) {
            first = part;
        }
        return first.value_or(1);
    });
    return first;
}

// Nearer than rounding a point is on the boundary: the side it is on would say nothing, and to find
// it would take the most exact of arithmetic.
double TetBoundary::signed_distance(const Vector4d& there, const NearestPoint& nearest) const {
    const double distance = std::sqrt(nearest.distance_squared);
    if (distance <= kRounding * std::max(there.norm(), nearest.place.norm())) {
        return 0;
    }
    return crossings(there, kNone) != 0 ? -distance : distance;
}

ValueSlope TetBoundary::value_slope(const Vector4d& p) const {
    const Vector4d there = rotation_ * p;
    const NearestPoint nearest = tree_.nearest(there);
    const double value = signed_distance(there, nearest);
    const Vector4d slope =
        value != 0 ? Vector4d((there - nearest.place) / value) : tree_.normal(nearest.tetrahedron);
    return {value, rotation_.transpose() * slope};
}

double TetBoundary::patch_value(int patch, const Vector4d& p) const {
    return patch_slope(patch, p).value;
}

ValueSlope TetBoundary::patch_slope(int patch, const Vector4d& p) const {
    const Vector4d there = rotation_ * p;
    const NearestPoint nearest = tree_.nearest(there, patch);
    const Vector4d& normal = tree_.normal(nearest.tetrahedron);
    return {normal.dot(there - nearest.place), rotation_.transpose() * normal};
}

std::vector<int> TetBoundary::patches_within(const Vector4d& p, double distance) const {
    std::vector<int> found;
    tree_.visit_within(rotation_ * p, distance,
                       [&](std::uint32_t t) { found.push_back(tree_.patch(t)); });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

}  // namespace pent::mesher
