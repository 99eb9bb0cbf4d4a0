#include "fields.h"
#include "half_spaces.h"
#include "image_level.h"
#include "tet_boundary.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace pent::mesher {

namespace {

using Eigen::Vector4d;

// Eigen's normalized() leaves zero as it is: at an axis or ring, where there is no slope.

ValueSlope slope_of(const RoundField& field, const Vector4d& p) {
    const Vector4d out = p.cwiseProduct(field.axes);
    return {out.norm() - field.radius, out.normalized()};
}

ValueSlope slope_of(const CapsuleField& field, const Vector4d& p) {
    Vector4d out = p;
    out[3] = p[3] - std::clamp(p[3], -field.half_length, field.half_length);
    return {out.norm() - field.radius, out.normalized()};
}

ValueSlope slope_of(const HalfSpacesField& field, const Vector4d& p) {
    const HalfSpaces& all = *field.half_spaces;
    const HalfSpace& deciding = all[all.deciding(p)];
    return {deciding.value(p), deciding.normal};
}

ValueSlope slope_of(const RingField& field, const Vector4d& p) {
    Vector4d out = p;  // from the ring
    out.head(field.axes) -= field.ring_radius * p.head(field.axes).normalized();
    return {out.norm() - field.tube_radius, out.normalized()};
}

ValueSlope slope_of(const TigerField& field, const Vector4d& p) {
    Vector4d out = p;
    out.head<2>() -= field.ring_radii[0] * p.head<2>().normalized();
    out.tail<2>() -= field.ring_radii[1] * p.tail<2>().normalized();
    return {out.norm() - field.tube_radius, out.normalized()};
}

ValueSlope slope_of(const DitorusField& field, const Vector4d& p) {
    Vector4d out = p;  // from the first circle, then from the torus
    out.head<2>() -= field.ring_radii[0] * p.head<2>().normalized();
    out.head<3>() -= field.ring_radii[1] * out.head<3>().normalized();
    return {out.norm() - field.tube_radius, out.normalized()};
}

ValueSlope slope_of(const BoundaryField& field, const Vector4d& p) {
    return field.boundary->value_slope(p);
}

ValueSlope slope_of(const ImageField& field, const Vector4d& p) {
    return field.image->value_slope(p);
}

// By central differences, where nothing better is known.
ValueSlope differences(const Field& field, const Vector4d& p, double step) {
    ValueSlope result{field_value(field, p), Vector4d::Zero()};
    for (int axis = 0; axis < 4; ++axis) {
        const Vector4d aside = step * Vector4d::Unit(axis);
        result.slope[axis] =
            (field_value(field, p + aside) - field_value(field, p - aside)) / (2 * step);
    }
    return result;
}

}  // namespace

ValueSlope field_slope(const Field& field, const Vector4d& p, double step) {
    return std::visit(
        [&](const auto& kind) -> ValueSlope {
            using Kind = std::decay_t<decltype(kind)>;
            if constexpr (std::is_same_v<Kind, ExpressionField>) {
                return differences(field, p, step);
            } else {
                return slope_of(kind, p);
            }
        },
        field);
}

ValueSlope piece_slope(const Field& field, int piece, const Vector4d& p, double step) {
    if (const auto* polytope = std::get_if<HalfSpacesField>(&field)) {
        const HalfSpace& own = (*polytope->half_spaces)[piece];
        return {own.value(p), own.normal};
    }
    const auto* surface = std::get_if<BoundaryField>(&field);
    return surface != nullptr ? surface->boundary->patch_slope(piece, p)
                              : field_slope(field, p, step);
}

}  // namespace pent::mesher
