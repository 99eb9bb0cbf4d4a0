#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <variant>

namespace pent::simulator {

/// Points at most `radius` from `center`.
struct BallSelection {
    Eigen::VectorXd center;  ///< m.
    double radius = 0;       ///< m, > 0.
};

/// Points between two corners, borders included.
struct BoxSelection {
    Eigen::VectorXd low;   ///< m.
    Eigen::VectorXd high;  ///< m; not below `low` along any axis.
};

/// Points p with normal . p <= offset.
struct HalfSpaceSelection {
    Eigen::VectorXd normal;  ///< Unit length.
    double offset = 0;       ///< m.
};

/// Vertices of the extrusion layers first..last of a mesh that knows its layers.
struct LayerSelection {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
};

/// Vertices of the cells with one region label.
struct RegionSelection {
    std::uint16_t region = 0;
};

/// Every vertex of the body, which makes it fully kinematic.
struct EverythingSelection {};

using Selection = std::variant<BallSelection,
                               BoxSelection,
                               HalfSpaceSelection,
                               LayerSelection,
                               RegionSelection,
                               EverythingSelection>;

}  // namespace pent::simulator
