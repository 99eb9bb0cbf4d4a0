#pragma once

#include <pent/mesher/solid.h>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace pent::mesher {

/// The point of a tetrahedron that is nearest to some point.
struct NearestPoint {
    std::uint32_t tetrahedron = 0;
    Eigen::Vector4d place = Eigen::Vector4d::Zero();
    double distance_squared = std::numeric_limits<double>::infinity();  ///< m^2.
};

/// The nearest point of a simplex of 4 corners, flat ones included.
/// @param corners  One a column.
[[nodiscard]] Eigen::Vector4d nearest_point(const Eigen::Matrix4d& corners,
                                            const Eigen::Vector4d& p);

/// A bounding volume hierarchy of tetrahedra of R^4, each in a patch: nodes have a box and a disc.
/// Tetrahedra are numbered in the order of the tree.
class TetTree {
public:
    using Tetrahedron = std::array<std::uint32_t, 4>;

    static constexpr int kAnyPatch = -1;  ///< Asks for those of all patches.
    static constexpr int kNoPatch = -2;   ///< Of tetrahedra that no search by distance finds.

    /// All in patch 0.
    /// @param tetrahedra  Of points, one or more.
    TetTree(std::span<const Eigen::Vector4d> points, std::span<const Tetrahedron> tetrahedra);

    [[nodiscard]] std::uint32_t count() const {
        return static_cast<std::uint32_t>(tetrahedra_.size());
    }

    /// Points in the order of the tree, those of them that a tetrahedron has.
    [[nodiscard]] const Tetrahedron& tetrahedron(std::uint32_t t) const { return tetrahedra_[t]; }

    [[nodiscard]] const Eigen::Vector4d& corner(std::uint32_t t, std::size_t i) const {
        return points_[tetrahedra_[t][i]];
    }

    /// One a column.
    [[nodiscard]] Eigen::Matrix4d corners(std::uint32_t t) const;

    /// Of length 1, or 0 of what has none.
    [[nodiscard]] const Eigen::Vector4d& normal(std::uint32_t t) const { return normals_[t]; }

    [[nodiscard]] int patch(std::uint32_t t) const { return patches_[t]; }

    /// @param patches  One a tetrahedron: 0 or more, or kNoPatch.
    void set_patches(std::vector<int> patches);

    /// The nearest of a patch, or of any, and nearer than `max_distance` (m); at an infinite
    /// distance if there is none. The point is finite.
    [[nodiscard]] NearestPoint nearest(
        const Eigen::Vector4d& p,
        int patch = kAnyPatch,
        double max_distance = std::numeric_limits<double>::infinity()) const;

    /// Calls visit(t) for each tetrahedron of a patch no further than `distance` (m).
    template <typename Visit>
    void visit_within(const Eigen::Vector4d& p, double distance, const Visit& visit) const {
        const double squared = distance * distance;
        const Place at{p, float_below(p), -float_below(-p)};
        walk(
            [&](const Node& node) {
                return distance_squared(node, at) <= squared
                       && may_be_nearer(node.disc, p, squared);
            },
            [&](std::uint32_t t) {
                if (patches_[t] != kNoPatch
                    && (nearest_point(corners(t), p) - p).squaredNorm() <= squared) {
                    visit(t);
                }
            });
    }

    /// Calls visit(t) for each tetrahedron, in a patch or not, that a ray along the last axis may
    /// meet.
    template <typename Visit>
    void visit_ray(const Eigen::Vector4d& from, const Visit& visit) const {
        const Place at{from, float_below(from), -float_below(-from)};
        walk(
            [&](const Node& node) {
                return (node.low.head<3>().array() <= at.low.head<3>().array()).all()
                       && (node.high.array() >= at.high.array()).all();
            },
            [&](std::uint32_t t) {
                const Eigen::Vector4d beside = from - balls_[t].center.cast<double>();
                const double radius = (1 + kRounding) * static_cast<double>(balls_[t].radius);
                if (beside.head<3>().squaredNorm() <= radius * radius && beside[3] <= radius) {
                    visit(t);
                }
            });
    }

    /// Whether a point may be in a tetrahedron: it is in a ball around it.
    [[nodiscard]] bool may_hold(std::uint32_t t, const Eigen::Vector4d& p) const {
        const double radius = (1 + kRounding) * static_cast<double>(balls_[t].radius);
        return (p - balls_[t].center.cast<double>()).squaredNorm() <= radius * radius;
    }

    /// Calls visit(t) for each tetrahedron, in a patch or not, that may meet a segment or come near
    /// it by 1e-6 of its length. What it returns is the part of the way up to which others count.
    template <typename Visit>
    void visit_segment(const Eigen::Vector4d& from,
                       const Eigen::Vector4d& way,
                       const Visit& visit) const {
        const Eigen::Array4d slack = Eigen::Array4d::Constant(kRounding * way.norm());
        const Eigen::Array4d per_way = way.array().inverse();  // infinite along a box
        double most = 1;
        walk(
            [&](const Node& node) {
                const Eigen::Array4d low = node.low.cast<double>().array() - from.array() - slack;
                const Eigen::Array4d high = node.high.cast<double>().array() - from.array() + slack;
                double first = 0;
                double last = most;
                for (int axis = 0; axis < 4; ++axis) {
                    const double a = low[axis] * per_way[axis];
                    const double b = high[axis] * per_way[axis];
                    first = std::max(first, std::min(a, b));
                    last = std::min(last, std::max(a, b));
                }
                return first <= last;
            },
            [&](std::uint32_t t) { most = visit(t); });
    }

private:
    static constexpr double kRounding = 1e-6;  // more than that of floats, as a part

    // Around the corners of a tetrahedron.
    struct Ball {
        Eigen::Vector4f center;
        float radius = 0;  // rounded up
    };

    // A thick disc around the tetrahedra of a node: within `thickness` of a hyperplane through a
    // center and within `radius` of the center. Where the surface is smooth it is far thinner than
    // a box along the axes, along which the surface is not.
    struct Disc {
        Eigen::Vector4f center = Eigen::Vector4f::Zero();
        Eigen::Vector4f normal = Eigen::Vector4f::Zero();  // of length 1, or 0: a ball
        float radius =
            std::numeric_limits<float>::infinity();  // rounded up; infinite of large nodes
        float thickness = 0;                         // on either side, rounded up
    };

    struct Node {
        Eigen::Vector4f low;  // rounded away from what is in the box
        Eigen::Vector4f high;
        std::uint32_t first = 0;  // of its tetrahedra
        std::uint32_t count = 0;  // 0 in nodes with children, the first of which is next to it
        std::uint32_t after = 0;  // the node behind all of its own
        std::uint32_t patches = bit_of(0);  // the bits of all that they are in
        Disc disc = {};
    };

    // A point, and the floats around it.
    struct Place {
        Eigen::Vector4d p;
        Eigen::Vector4f low;
        Eigen::Vector4f high;
    };

    // A lower bound of the squared distance from a point to a box: both are rounded towards each
    // other, and the result is lowered by what differences and squares of floats are rounded by.
    [[nodiscard]] static double distance_squared(const Node& node, const Place& at) {
        const Eigen::Vector4f apart =
            (node.low - at.high).cwiseMax(at.low - node.high).cwiseMax(0.0F);
        return (1 - kRounding) * apart.cast<double>().squaredNorm();
    }
    // Whether a point may be nearer than a square to what a disc holds.
    [[nodiscard]] static bool may_be_nearer(const Disc& disc,
                                            const Eigen::Vector4d& p,
                                            double squared);
    [[nodiscard]] static Eigen::Vector4f float_below(const Eigen::Vector4d& p);
    // The bit of a patch in the 32 that a node keeps to tell which patches may be in it: by its
    // number modulo 32.
    [[nodiscard]] static std::uint32_t bit_of(int patch) {
        return patch == kNoPatch ? 0U : 1U << static_cast<unsigned>(patch) % 32;
    }
    [[nodiscard]] static std::uint32_t bits_of(int asked) {
        return asked == kAnyPatch ? ~0U : bit_of(asked);
    }

    void build(const std::vector<Eigen::Matrix4d>& corners,
               std::vector<std::uint32_t>& order,
               std::uint32_t first,
               std::uint32_t count);
    [[nodiscard]] Disc disc_around(std::uint32_t first, std::uint32_t end) const;
    void search(std::uint32_t node, const Place& at, int patch, NearestPoint& best) const;
    void consider(std::uint32_t t, const Eigen::Vector4d& p, NearestPoint& best) const;

    // Goes through the nodes that may be entered, to the tetrahedra of their leaves.
    template <typename Enter, typename Leaf>
    void walk(const Enter& enter, const Leaf& leaf) const {
        for (std::uint32_t i = 0; i < nodes_.size();) {
            const Node& node = nodes_[i];
            if (!enter(node)) {
                i = node.after;
                continue;
            }
            for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
                leaf(t);
            }
            ++i;
        }
    }

    std::vector<Node> nodes_;
    std::vector<Eigen::Vector4d> points_;
    std::vector<Tetrahedron> tetrahedra_;
    std::vector<Eigen::Vector4d> normals_;
    std::vector<std::uint8_t> is_round_;  // of tetrahedra: the plane of it is known well
    std::vector<Ball> balls_;             // of tetrahedra
    std::vector<int> patches_;
};

}  // namespace pent::mesher
