#include "tet_boundary.h"

#include "../union_find.h"
#include "exact_signs.h"

#include <pent/geometry.h>
#include <pent/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace pent::mesher {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;
using exchange::TetSurface;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Tetrahedra that meet at less are one smooth patch: the cosine of 40 degrees.
constexpr double kSmoothCosine = 0.766;

constexpr double kRounding = 1e-11;  // of coordinates, enough for directions to 1e-5

// Turns in three planes by angles without a meaning.
Matrix4d odd_rotation() {
    Matrix4d rotation = Matrix4d::Identity();
    const auto turn = [&](int from, int to, double angle) {
        Matrix4d step = Matrix4d::Identity();
        step(from, from) = step(to, to) = std::cos(angle);
        step(to, from) = std::sin(angle);
        step(from, to) = -step(to, from);
        rotation = step * rotation;
    };
    turn(0, 1, 0.4123);
    turn(2, 3, 0.7071);
    turn(1, 2, 1.1357);
    turn(0, 3, 0.5911);
    return rotation;
}

// Joins tetrahedra across triangles of two, where these meet at little of an angle.
std::vector<std::uint32_t> smooth_parts(const TetSurface& surface,
                                        const std::vector<Vector4d>& normals) {
    struct Side {
        std::array<std::uint32_t, 3> corners{};
        std::uint32_t tetrahedron = 0;
    };
    std::vector<Side> sides;
    for (Eigen::Index t = 0; t < surface.tetrahedra.cols(); ++t) {
        for (int without = 0; without < 4; ++without) {
            Side side{{}, static_cast<std::uint32_t>(t)};
            for (int i = 0, at = 0; i < 4; ++i) {
                if (i != without) {
                    side.corners[static_cast<std::size_t>(at++)] = surface.tetrahedra(i, t);
                }
            }
            std::sort(side.corners.begin(), side.corners.end());
            sides.push_back(side);
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.corners != b.corners ? a.corners < b.corners : a.tetrahedron < b.tetrahedron;
    });
    UnionFind parts(normals.size());
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
            if (normals[a].dot(normals[b]) > kSmoothCosine) {
                parts.join(a, b);
            }
        }
        i = end;
    }
    std::vector<std::uint32_t> names(normals.size());
    for (std::uint32_t t = 0; t < names.size(); ++t) {
        names[t] = parts.find(t);
    }
    return names;
}

}  // namespace

TetBoundary::TetBoundary(const TetSurface& surface) : rotation_(odd_rotation()) {
    const auto count = static_cast<std::uint32_t>(surface.tetrahedra.cols());
    std::vector<Matrix4d> corners;
    std::vector<std::uint32_t> names(count);
    std::iota(names.begin(), names.end(), 0U);
    for (std::uint32_t t = 0; t < count; ++t) {
        corners.push_back(corners_of(surface, t));
        const Vector4d normal = facet_normal<4>(corners.back());
        const double length = normal.norm();
        normals_.push_back(length > 0 ? Vector4d(normal / length) : Vector4d::Zero());
    }
    all_ = TetTree(corners, names);
    std::vector<std::uint8_t> is_outer(count, 0);
    constexpr std::uint32_t kTask = 256;
    parallel_for(count, kTask, [&](std::uint32_t t) { is_outer[t] = separates(t, corners[t]); });
    plant(surface, {is_outer.begin(), is_outer.end()});
}

Matrix4d TetBoundary::corners_of(const TetSurface& surface, std::uint32_t tetrahedron) const {
    Matrix4d corners;
    for (int i = 0; i < 4; ++i) {
        corners.col(i) = surface.points.col(surface.tetrahedra(i, tetrahedron));
    }
    return rotation_ * corners;
}

void TetBoundary::plant(const TetSurface& surface, const std::vector<bool>& is_outer) {
    const std::vector<std::uint32_t> parts = smooth_parts(surface, normals_);
    std::map<std::uint32_t, int> patches;
    std::vector<std::uint32_t> outer;
    patch_of_.assign(parts.size(), -1);
    for (std::uint32_t t = 0; t < parts.size(); ++t) {
        if (is_outer[t]) {
            outer.push_back(t);
            patch_of_[t] =
                patches.try_emplace(parts[t], static_cast<int>(patches.size())).first->second;
        }
    }
    inner_count_ = static_cast<std::int64_t>(parts.size() - outer.size());
    std::vector<std::vector<std::uint32_t>> members(patches.size());
    for (const std::uint32_t t : outer) {
        members[static_cast<std::size_t>(patch_of_[t])].push_back(t);
    }
    const auto tree_of = [&](const std::vector<std::uint32_t>& names) {
        std::vector<Matrix4d> corners;
        for (const std::uint32_t t : names) {
            corners.push_back(corners_of(surface, t));
        }
        return TetTree(std::move(corners), names);
    };
    outer_ = tree_of(outer);
    for (const std::vector<std::uint32_t>& names : members) {
        patches_.push_back(tree_of(names));
    }
}

// The sum over all tetrahedra above a point, in the axes of the trees.
int TetBoundary::crossings(const Vector4d& from, std::uint32_t without) const {
    int sum = 0;
    all_.visit_ray(from, [&](std::uint32_t name, const Matrix4d& corners) {
        // Where the ray leaves a body the normal has a part along it: the shadow is turned over.
        sum -= name != without ? crossing_sign(corners, from) : 0;
    });
    return sum;
}

// Whether there is body on one side only, at one of five points of it at least.
bool TetBoundary::separates(std::uint32_t tetrahedron, const Matrix4d& corners) const {
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
    return signed_distance(there, outer_.nearest(there));
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
    const NearestPoint nearest = outer_.nearest(there);
    const double value = signed_distance(there, nearest);
    const Vector4d slope =
        value != 0 ? Vector4d((there - nearest.place) / value) : normals_[nearest.tetrahedron];
    return {value, rotation_.transpose() * slope};
}

double TetBoundary::patch_value(int patch, const Vector4d& p) const {
    return patch_slope(patch, p).value;
}

ValueSlope TetBoundary::patch_slope(int patch, const Vector4d& p) const {
    const Vector4d there = rotation_ * p;
    const NearestPoint nearest = patches_[static_cast<std::size_t>(patch)].nearest(there);
    const Vector4d& normal = normals_[nearest.tetrahedron];
    return {normal.dot(there - nearest.place), rotation_.transpose() * normal};
}

std::vector<int> TetBoundary::patches_within(const Vector4d& p, double distance) const {
    std::vector<int> found;
    outer_.visit_within(rotation_ * p, distance,
                        [&](std::uint32_t name) { found.push_back(patch_of_[name]); });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

}  // namespace pent::mesher
