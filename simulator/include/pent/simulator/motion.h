#pragma once

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace pent::simulator {

/// A plane of rotation: by a positive angle, axis `from` turns towards axis `to`.
struct Plane {
    int from = 0;
    int to = 1;

    bool operator==(const Plane&) const = default;
};

/// One rotation of a motion; turns at a constant rate.
struct Spin {
    Plane plane;
    double degrees_per_s = 0;
};

/// One rotation of a placement, or of a keyframe.
struct Turn {
    Plane plane;
    double degrees = 0;
};

/// Where a motion has taken its vertices by a time, counted from where they are when it begins.
struct MotionKeyframe {
    double time = 0;            ///< s, > `from` of the motion.
    Eigen::VectorXd translate;  ///< m.
    std::vector<Turn> rotate;   ///< A plane that others turn and this one does not name is at 0.
    std::optional<Eigen::VectorXd> velocity;  ///< m/s; absent: that of a smooth curve.
    std::vector<Spin> spin;  ///< Of planes that are turned; of those not named as `velocity`.
};

/// How selected vertices move: turned about `about` while it is carried along.
///
/// With s = the time within [from, to], less `from`, a vertex at X is taken to
/// about + s translate + R(s) (X - about), R(s) being the spins applied in the order given. No
/// translation and no spin holds the vertices where they are.
///
/// With keyframes it has no rates: from rest at `from` the shift and the angles follow cubic curves
/// through those of the keyframes, and stay as the last one has them. The turns are applied in the
/// order in which keyframes first name their planes.
struct Motion {
    Eigen::VectorXd translate;  ///< m/s.
    std::vector<Spin> rotate;
    /// m; if absent the mean of the selected vertices, where they are at `from`.
    std::optional<Eigen::VectorXd> about;
    double from = 0;                                      ///< s, >= 0.
    double to = std::numeric_limits<double>::infinity();  ///< s, > from.
    std::vector<MotionKeyframe> keyframes = {};           ///< Ascending in time.
};

/// A factor at a time.
struct Keyframe {
    double time = 0;  ///< s, >= 0.
    double factor = 1;
};

/// The fastest turn in one of its planes, degrees/s, >= 0; through keyframes that between two of
/// them.
[[nodiscard]] double largest_turn_rate(const Motion& motion);

/// "xw" for {0, 3}.
[[nodiscard]] std::string plane_name(const Plane& plane);

}  // namespace pent::simulator
