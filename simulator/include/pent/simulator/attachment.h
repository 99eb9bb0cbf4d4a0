#pragma once

#include <pent/simulator/motion.h>
#include <pent/simulator/selection.h>
#include <pent/simulator/words.h>

#include <Eigen/Core>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace pent::simulator {

/// The rest offset of a spring: the vector from a selected vertex to what it is tied to.
enum class RestOffset {
    Keep,  ///< That of t = 0; it is carried along by what the vertex is tied to.
    Zero,  ///< None: the spring pulls the two together.
};
template <>
inline constexpr std::array kWords<RestOffset> = {
    Word<RestOffset>{RestOffset::Keep, "keep"},
    Word<RestOffset>{RestOffset::Zero, "zero"},
};

/// Ties vertices of a body, selected on placed positions at t = 0, by a spring each: to the points
/// of another body that are nearest then, to one point, or to where they are. Points in space may
/// move.
struct Attachment {
    std::string body;
    std::vector<Selection> select;  ///< A union.
    std::string target = {};        ///< Another body; empty: points in space.
    std::optional<Eigen::VectorXd>
        point;  ///< m: one for all vertices; absent: where each of them is at t = 0.
    std::vector<Motion> motion;  ///< Of points in space, as of a Constraint.
    RestOffset offset = RestOffset::Keep;
    double max_distance = 0.05;  ///< m, > 0: of a vertex from its nearest point of `target`.
    double stiffness = 1000;     ///< N/m for each selected vertex, > 0.
    double damping = 0;          ///< N s/m for each selected vertex, >= 0.
    double from = 0;             ///< s, >= 0: of steps that begin before it is not there.
    double to = std::numeric_limits<double>::infinity();  ///< s, > from: of those from here on.
    double break_force =
        std::numeric_limits<double>::infinity();  ///< N, > 0: a spring that pulls harder is gone.
    bool contact = true;      ///< Whether [contact] is between the two bodies all the same.
    std::string source = {};  ///< Where its selection stands in a scene file; as Body::source.
};

}  // namespace pent::simulator
