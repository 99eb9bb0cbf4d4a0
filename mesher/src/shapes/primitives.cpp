#include "half_spaces.h"
#include "regular_polytopes.h"
#include "solid_data.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/mesher/primitives.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace pent::mesher {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Reach kRound{1, true};  // of distances
constexpr Reach kStraight{1, false};

void check_length(const char* name, double value) {
    if (!(value > 0) || !std::isfinite(value)) {
        throw Error(formatted("%s is %g; expected a length above 0 (m)", name, value));
    }
}

void check_below(const char* name, double value, const char* limit_name, double limit) {
    check_length(name, value);
    if (value >= limit) {
        throw Error(formatted("%s is %g; expected less than %s, %g, or the hole closes", name,
                              value, limit_name, limit));
    }
}

Box4 box_around(const Eigen::Vector4d& half) {
    return {-half, half};
}

Solid round_solid(const Eigen::Vector4d& axes, double radius) {
    Box4 box = box_around(Eigen::Vector4d::Constant(radius));
    for (int axis = 0; axis < 4; ++axis) {
        if (axes[axis] == 0) {
            box.low[axis] = -kInfinity;
            box.high[axis] = kInfinity;
        }
    }
    return solid_of(RoundField{axes, radius}, box, 2 * radius, kRound);
}

HalfSpacesField field_of(std::vector<HalfSpace> pieces) {
    return {std::make_shared<const HalfSpaces>(std::move(pieces))};
}

// Between two hyperplanes across each axis of finite size.
Solid slabs(const Eigen::Vector4d& size) {
    std::vector<HalfSpace> sides;
    for (int axis = 0; axis < 4; ++axis) {
        for (const double sign : {1.0, -1.0}) {
            if (std::isfinite(size[axis])) {
                sides.push_back({sign * Eigen::Vector4d::Unit(axis), size[axis] / 2});
            }
        }
    }
    return solid_of(field_of(std::move(sides)), box_around(size / 2), size.minCoeff(), kStraight);
}

}  // namespace

Solid ball_solid(double radius) {
    check_length("radius", radius);
    return round_solid(Eigen::Vector4d::Ones(), radius);
}

Solid box_solid(const Eigen::Vector4d& size) {
    check_length("the smallest edge of size", size.minCoeff());
    check_length("the largest edge of size", size.maxCoeff());
    return slabs(size);
}

Solid capsule_solid(double radius, double length) {
    check_length("radius", radius);
    check_length("length", length);
    Eigen::Vector4d half = Eigen::Vector4d::Constant(radius);
    half[3] += length / 2;
    return solid_of(CapsuleField{radius, length / 2}, box_around(half), 2 * radius, kRound);
}

Solid spherinder_solid(double radius, double length) {
    check_length("radius", radius);
    check_length("length", length);
    return intersect(round_solid({1, 1, 1, 0}, radius),
                     slabs({kInfinity, kInfinity, kInfinity, length}));
}

Solid cubinder_solid(double radius, const Eigen::Vector2d& size) {
    check_length("radius", radius);
    check_length("the smaller edge of size", size.minCoeff());
    check_length("the larger edge of size", size.maxCoeff());
    return intersect(round_solid({1, 1, 0, 0}, radius),
                     slabs({kInfinity, kInfinity, size[0], size[1]}));
}

Solid duocylinder_solid(const Eigen::Vector2d& radii) {
    check_length("the smaller of radii", radii.minCoeff());
    check_length("the larger of radii", radii.maxCoeff());
    return intersect(round_solid({1, 1, 0, 0}, radii[0]), round_solid({0, 0, 1, 1}, radii[1]));
}

Solid spheritorus_solid(double ring_radius, double tube_radius) {
    check_length("ring_radius", ring_radius);
    check_below("tube_radius", tube_radius, "ring_radius", ring_radius);
    const double outer = ring_radius + tube_radius;
    return solid_of(RingField{2, ring_radius, tube_radius},
                    box_around({outer, outer, tube_radius, tube_radius}), 2 * tube_radius, kRound);
}

Solid torisphere_solid(double ring_radius, double tube_radius) {
    check_length("ring_radius", ring_radius);
    check_below("tube_radius", tube_radius, "ring_radius", ring_radius);
    const double outer = ring_radius + tube_radius;
    return solid_of(RingField{3, ring_radius, tube_radius},
                    box_around({outer, outer, outer, tube_radius}), 2 * tube_radius, kRound);
}

Solid tiger_solid(const Eigen::Vector2d& ring_radii, double tube_radius) {
    check_length("the larger of ring_radii", ring_radii.maxCoeff());
    check_below("tube_radius", tube_radius, "the smaller of ring_radii", ring_radii.minCoeff());
    const Eigen::Vector2d outer = ring_radii.array() + tube_radius;
    return solid_of(TigerField{ring_radii, tube_radius},
                    box_around({outer[0], outer[0], outer[1], outer[1]}), 2 * tube_radius, kRound);
}

Solid ditorus_solid(const Eigen::Vector2d& ring_radii, double tube_radius) {
    check_length("the first of ring_radii", ring_radii[0]);
    check_below("tube_radius", tube_radius, "the second of ring_radii", ring_radii[1]);
    check_below("the second of ring_radii with tube_radius", ring_radii[1] + tube_radius,
                "the first of ring_radii", ring_radii[0]);
    const double rise = ring_radii[1] + tube_radius;
    const double outer = ring_radii[0] + rise;
    return solid_of(DitorusField{ring_radii, tube_radius},
                    box_around({outer, outer, rise, tube_radius}), 2 * tube_radius, kRound);
}

Solid clifford_torus_solid(double radius, double thickness) {
    check_length("radius", radius);
    check_below("thickness", thickness, "sqrt(2) radius", std::numbers::sqrt2 * radius);
    return tiger_solid(Eigen::Vector2d::Constant(radius / std::numbers::sqrt2), thickness / 2);
}

Solid polytope_solid(int cells, double radius) {
    constexpr std::array<int, 6> kRegular = {5, 8, 16, 24, 120, 600};
    if (std::find(kRegular.begin(), kRegular.end(), cells) == kRegular.end()) {
        throw Error("cells is " + std::to_string(cells) + "; expected 5, 8, 16, 24, 120 or 600");
    }
    check_length("radius", radius);
    const double inradius = inradius_ratio(cells) * radius;
    std::vector<HalfSpace> pieces;
    for (const Eigen::Vector4d& normal : cell_normals(cells)) {
        pieces.push_back({normal, inradius});
    }
    // Where its function is at most some level is a larger polytope, whose vertices reach further
    // out than its cells do, by this factor.
    return solid_of(field_of(std::move(pieces)), box_around(Eigen::Vector4d::Constant(radius)),
                    2 * inradius, {radius / inradius, false});
}

Solid half_space_solid(const Eigen::Vector4d& normal, double offset) {
    if (!normal.allFinite() || !(normal.norm() > 0)) {
        throw Error("normal is zero or not finite; expected a direction");
    }
    if (!std::isfinite(offset)) {
        throw Error("offset is not finite; expected a number (m)");
    }
    return solid_of(field_of({{normal.normalized(), offset / normal.norm()}}),
                    box_around(Eigen::Vector4d::Constant(kInfinity)), kInfinity, kStraight);
}

Solid expression_solid(const std::string& formula, const Box4& box) {
    const Eigen::Vector4d size = box.high - box.low;
    if (!box.low.allFinite() || !box.high.allFinite() || !(size.minCoeff() > 0)) {
        throw Error(
            "the box of an expression is empty or not finite; expected low below high on "
            "every axis (m)");
    }
    const Solid formula_solid =
        solid_of(ExpressionField(formula), box_around(Eigen::Vector4d::Constant(kInfinity)),
                 kInfinity, kStraight);
    const Solid sides =
        place(slabs(size), 1, Eigen::Matrix4d::Identity(), (box.low + box.high) / 2);
    return intersect(formula_solid, sides);
}

}  // namespace pent::mesher
