#pragma once

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace pent::mesher {

/// A box along the axes; without bounds where it is infinite.
struct Box4 {
    Eigen::Vector4d low;   ///< m.
    Eigen::Vector4d high;  ///< m.
};

/// Least and greatest value of a function.
struct ValueRange {
    double low = 0;
    double high = 0;
};

/// A function at a point.
struct Sample {
    Eigen::Vector4d place;
    double value = 0;
};

/// The value of a function at a point, and its gradient there.
struct ValueSlope {
    double value = 0;
    Eigen::Vector4d slope = Eigen::Vector4d::Zero();
};

/// A body of four dimensions as an implicit function of the point: negative inside, positive
/// outside, zero on the boundary; made from primitives (see primitives.h) by the operations below.
///
/// The boundary consists of smooth pieces, each the zeros of a function of its own; ridges are
/// where pieces meet at an angle. Safe to ask from several threads.
class Solid {
public:
    /// The function at a point, m. NaN only where an expression is.
    [[nodiscard]] double value(const Eigen::Vector4d& p) const;

    /// The function (m) and its slope.
    /// @param step  Differences are taken over this (m) where no slope is known: of expressions.
    [[nodiscard]] ValueSlope value_slope(const Eigen::Vector4d& p, double step) const;

    // Questions that take less time than value() where the surface is that of a file: there the
    // distance and the side of a point are found separately, and one of them may be enough.

    /// The value if it is nearer to 0 than `enough` (m); else a number of the same sign, between
    /// `enough` and the value.
    /// @param known  What this gave at points near by, which may tell the sign.
    [[nodiscard]] double value_near(const Eigen::Vector4d& p,
                                    double enough,
                                    std::span<const Sample> known) const;

    /// Whether the value is below 0.
    [[nodiscard]] bool is_inside(const Eigen::Vector4d& p) const;

    /// Whether the value is nearer to 0 than `distance`, m.
    [[nodiscard]] bool is_near_surface(const Eigen::Vector4d& p, double distance) const;

    /// The slope of value_slope() where the value is known already.
    [[nodiscard]] Eigen::Vector4d slope(const Sample& at, double step) const;

    /// Whether this is one boundary of tetrahedra, placed and scaled perhaps, and nothing else.
    [[nodiscard]] bool is_boundary() const;

    /// The point of the surface nearest to a point; nothing unless is_boundary().
    [[nodiscard]] std::optional<Eigen::Vector4d> foot(const Eigen::Vector4d& p) const;

    /// The point of a piece nearest to a point; nothing for pieces of other than tetrahedra.
    [[nodiscard]] std::optional<Eigen::Vector4d> piece_foot(int piece,
                                                            const Eigen::Vector4d& p) const;

    /// At which part of the way from a point outside to one inside it first meets the surface;
    /// nothing unless is_boundary(), and nothing if rounding hides it.
    [[nodiscard]] std::optional<double> first_crossing(const Eigen::Vector4d& outside,
                                                       const Eigen::Vector4d& inside) const;

    /// Bounds of the function within a ball; infinite where an expression decides.
    [[nodiscard]] ValueRange values_within(const Eigen::Vector4d& center, double radius) const;

    /// Whether the function changes by no more than the distance between two points; not where
    /// there is an expression or an image.
    [[nodiscard]] bool is_lipschitz() const;

    /// The pieces that decide the function at a point, or would if values changed by up to `margin`
    /// (m, 0 or more): their numbers, ascending.
    [[nodiscard]] std::vector<int> pieces_near(const Eigen::Vector4d& p, double margin) const;

    /// Pieces are numbered from 0 to below this.
    [[nodiscard]] int piece_count() const;

    /// The function of one piece at a point, m.
    [[nodiscard]] double piece_value(int piece, const Eigen::Vector4d& p) const;

    /// The same with its slope, see value_slope().
    [[nodiscard]] ValueSlope piece_slope(int piece, const Eigen::Vector4d& p, double step) const;

    /// Holds all that is inside.
    [[nodiscard]] const Box4& bounds() const;

    [[nodiscard]] bool is_bounded() const;

    /// The smallest diameter of a primitive, m; infinite if none is known.
    [[nodiscard]] double smallest_width() const;

    struct Data;
    explicit Solid(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
    [[nodiscard]] const Data& data() const { return *data_; }

private:
    std::shared_ptr<const Data> data_;
};

/// What is in either, in both, or in the first but not in the second.
///
/// @param smooth  Blends the two where their functions differ by less (m, 0 or more): ridges
///                between them become round.
[[nodiscard]] Solid unite(const Solid& a, const Solid& b, double smooth = 0);
[[nodiscard]] Solid intersect(const Solid& a, const Solid& b, double smooth = 0);
[[nodiscard]] Solid subtract(const Solid& a, const Solid& b, double smooth = 0);

/// The solid scaled about the origin, then rotated about it, then translated.
///
/// @param scale     Above 0.
/// @param rotation  Orthogonal, det 1.
[[nodiscard]] Solid place(const Solid& solid,
                          double scale,
                          const Eigen::Matrix4d& rotation,
                          const Eigen::Vector4d& translation);

}  // namespace pent::mesher
