#pragma once

#include <pent/mesher/solid.h>

#include <Eigen/Core>

#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace pent::mesher {

class HalfSpaces;
class ImageLevel;
class TetBoundary;

/// Functions of a point of space in meters, negative inside. But for expression and image, all
/// change by no more than the distance that the point moves, and are smooth where they are zero, or
/// the largest of a few that are: their pieces.

/// Distance from the origin in some of the axes, less a radius: a ball, or a cylinder over one.
struct RoundField {
    Eigen::Vector4d axes;  ///< 1 for those that count, else 0.
    double radius = 1;
};

/// Within a radius of a segment along w.
struct CapsuleField {
    double radius = 1;
    double half_length = 1;
};

/// Common part of half-spaces.
struct HalfSpacesField {
    std::shared_ptr<const HalfSpaces> half_spaces;
};

/// A tube around a circle in xy (two axes) or a sphere in xyz (three).
struct RingField {
    int axes = 2;
    double ring_radius = 1;
    double tube_radius = 0.5;
};

/// A tube around the product of a circle in xy and one in zw.
struct TigerField {
    Eigen::Vector2d ring_radii{1, 1};
    double tube_radius = 0.5;
};

/// A tube around a torus in xyz.
struct DitorusField {
    Eigen::Vector2d ring_radii{1, 0.5};  ///< From the z axis; from the first circle.
    double tube_radius = 0.25;
};

/// A formula in x y z w.
class ExpressionField {
public:
    /// Throws an Error with the place in the formula for one that cannot be understood.
    explicit ExpressionField(const std::string& formula);

    /// Safe to call from several threads. May be NaN. Throws an Error for what fails while it runs.
    [[nodiscard]] double value(const Eigen::Vector4d& p) const;

private:
    class Parsers;
    std::shared_ptr<Parsers> parsers_;
};

/// Within a closed hypersurface of tetrahedra; a piece is a smooth patch of it.
struct BoundaryField {
    std::shared_ptr<const TetBoundary> boundary;
};

/// Where an image is above a level.
struct ImageField {
    std::shared_ptr<const ImageLevel> image;
};

using Field = std::variant<RoundField,
                           CapsuleField,
                           HalfSpacesField,
                           RingField,
                           TigerField,
                           DitorusField,
                           ExpressionField,
                           BoundaryField,
                           ImageField>;

[[nodiscard]] double field_value(const Field& field, const Eigen::Vector4d& p);

[[nodiscard]] int piece_count(const Field& field);

/// The function of one piece, also where another one is larger.
[[nodiscard]] double piece_value(const Field& field, int piece, const Eigen::Vector4d& p);

/// The function and its slope, zero where it has none, as on the axis of a cylinder.
/// @param step  Differences are taken over this (m) of expressions, whose slope is not known.
[[nodiscard]] ValueSlope field_slope(const Field& field, const Eigen::Vector4d& p, double step);
[[nodiscard]] ValueSlope piece_slope(const Field& field,
                                     int piece,
                                     const Eigen::Vector4d& p,
                                     double step);

/// The pieces that decide the function at a point, or would if values changed by up to `margin`
/// (m): ascending.
[[nodiscard]] std::vector<int> pieces_near(const Field& field,
                                           const Eigen::Vector4d& p,
                                           double margin);

/// Bounds of the function within a ball; infinite for an expression.
[[nodiscard]] ValueRange field_range(const Field& field,
                                     const Eigen::Vector4d& center,
                                     double radius);

}  // namespace pent::mesher
