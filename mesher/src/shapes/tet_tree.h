#pragma once

#include <pent/mesher/solid.h>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pent::mesher {

/// The point of a tetrahedron that is nearest to some point.
struct NearestPoint {
    std::uint32_t tetrahedron = 0;
    Eigen::Vector4d place = Eigen::Vector4d::Zero();
    double distance_squared = 0;  ///< m^2.
};

/// The nearest point of a simplex of 4 corners, flat ones included.
/// @param corners  One a column.
[[nodiscard]] Eigen::Vector4d nearest_point(const Eigen::Matrix4d& corners,
                                            const Eigen::Vector4d& p);

/// Boxes around boxes around tetrahedra of R^4.
class TetTree {
public:
    TetTree() = default;

    /// @param corners  Of each tetrahedron, one a column.
    /// @param names    What each is called in answers.
    TetTree(std::vector<Eigen::Matrix4d> corners, std::vector<std::uint32_t> names);

    [[nodiscard]] bool is_empty() const { return names_.empty(); }

    /// The tree is not empty; the point is finite.
    [[nodiscard]] NearestPoint nearest(const Eigen::Vector4d& p) const;

    /// Calls visit(name) for each tetrahedron no further than `distance` (m).
    template <typename Visit>
    void visit_within(const Eigen::Vector4d& p, double distance, const Visit& visit) const {
        const double reach = distance * distance;
        walk([&](const Box4& box) { return distance_squared(box, p) <= reach; },
             [&](std::uint32_t i) {
                 if ((nearest_point(corners_[i], p) - p).squaredNorm() <= reach) {
                     visit(names_[i]);
                 }
             });
    }

    /// Calls visit(name, corners) for each tetrahedron that a ray along the last axis may meet.
    template <typename Visit>
    void visit_ray(const Eigen::Vector4d& from, const Visit& visit) const {
        walk(
            [&](const Box4& box) {
                return (box.low.head<3>().array() <= from.head<3>().array()).all()
                       && (box.high.array() >= from.array()).all();
            },
            [&](std::uint32_t i) { visit(names_[i], corners_[i]); });
    }

private:
    struct Node {
        Box4 box;
        std::uint32_t first = 0;  // of its tetrahedra
        std::uint32_t count = 0;  // 0 in nodes with children, the first of which is next to it
        std::uint32_t after = 0;  // the node behind all of its own
    };

    [[nodiscard]] static double distance_squared(const Box4& box, const Eigen::Vector4d& p) {
        return (p - p.cwiseMax(box.low).cwiseMin(box.high)).squaredNorm();
    }

    void build(std::vector<std::uint32_t>& order, std::uint32_t first, std::uint32_t count);
    void search(std::uint32_t node, const Eigen::Vector4d& p, NearestPoint& best) const;

    // Goes through the nodes whose boxes may be entered, to the tetrahedra of their leaves.
    template <typename Enter, typename Leaf>
    void walk(const Enter& enter, const Leaf& leaf) const {
        for (std::uint32_t i = 0; i < nodes_.size();) {
            const Node& node = nodes_[i];
            if (!enter(node.box)) {
                i = node.after;
                continue;
            }
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
                leaf(k);
            }
            ++i;
        }
    }

    std::vector<Node> nodes_;
    std::vector<Eigen::Matrix4d> corners_;  // in the order of the leaves
    std::vector<Eigen::Vector4d> normals_;  // of length 1, or 0 if not round
    std::vector<std::uint32_t> names_;
};

}  // namespace pent::mesher
