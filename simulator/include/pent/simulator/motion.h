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
};

/// One rotation of a motion; turns at a constant rate.
struct Spin {
    Plane plane;
    double degrees_per_s = 0;
};

/// How selected vertices move: turned about `about` while it is carried along.
///
/// With s = the time within [from, to], less `from`, a vertex at X is taken to
/// about + s translate + R(s) (X - about), R(s) being the spins applied in the order given. No
/// translation and no spin holds the vertices where they are.
struct Motion {
    Eigen::VectorXd translate;  ///< m/s.
    std::vector<Spin> rotate;
    /// m; if absent the mean of the selected vertices, where they are at `from`.
    std::optional<Eigen::VectorXd> about;
    double from = 0;                                      ///< s, >= 0.
    double to = std::numeric_limits<double>::infinity();  ///< s, > from.
};

/// A factor at a time.
struct Keyframe {
    double time = 0;  ///< s, >= 0.
    double factor = 1;
};

/// "xw" for {0, 3}.
[[nodiscard]] std::string plane_name(const Plane& plane);

}  // namespace pent::simulator
