#pragma once

#include <Eigen/Core>

#include <span>

namespace pent::viewer {

/// A turn in one coordinate plane: by angle a it takes axis `from` towards axis `to`,
///
///     from' = from cos a - to sin a,   to' = from sin a + to cos a.
///
/// So a turn in "wx" is the inverse of the same turn in "xw".
struct PlaneRotation {
    int from = 0;        ///< Axis 0..3 for x, y, z, w.
    int to = 3;          ///< Another axis.
    double radians = 0;  ///< Any finite angle.
};

/// The rotation of R^4 that applies the turns in the order written.
[[nodiscard]] Eigen::Matrix4d rotation_matrix(std::span<const PlaneRotation> rotations);

/// A hyperplane of R^4 with a right-handed 3D frame in it: the points p with (frame p)_w = offset.
/// What is seen of such a point is the first three coordinates of frame p.
struct FramedHyperplane {
    /// A rotation, det = 1. Rows 0..2: the picture's x, y and z axes; row 3: the unit normal.
    Eigen::Matrix4d frame = Eigen::Matrix4d::Identity();
    double offset = 0;  ///< Distance from the origin along the normal, m.
};

/// The hyperplane w = offset after the rotations have been applied to the bodies about the origin.
///
/// Without rotations the frame is exactly the identity: x, y and z are kept to the bit.
[[nodiscard]] FramedHyperplane hyperplane_at(double offset,
                                             std::span<const PlaneRotation> rotations = {});

/// The hyperplane n . p = offset, n the normal made unit.
///
/// Its frame is turned from x, y, z by the smallest rotation that takes n to the w axis (for n with
/// a negative w, after half a turn in zw). Throws an Error for a normal that is zero or not finite.
[[nodiscard]] FramedHyperplane hyperplane_across(const Eigen::Vector4d& normal, double offset);

}  // namespace pent::viewer
