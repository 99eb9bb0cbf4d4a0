#pragma once

#include <pent/mesher/solid.h>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace pent::mesher {

/// Points where normal * p <= offset.
struct HalfSpace {
    Eigen::Vector4d normal;  ///< Of length 1, outward.
    double offset = 0;       ///< m.

    [[nodiscard]] double value(const Eigen::Vector4d& p) const { return normal.dot(p) - offset; }
};

/// The intersection of half-spaces, one a piece, in a tree by their normals: of many only those
/// whose normals point towards a point are evaluated.
class HalfSpaces {
public:
    /// @param pieces  One or more.
    explicit HalfSpaces(std::vector<HalfSpace> pieces);

    [[nodiscard]] int count() const { return static_cast<int>(pieces_.size()); }
    [[nodiscard]] const HalfSpace& operator[](int piece) const {
        return pieces_[static_cast<std::size_t>(piece)];
    }

    /// The first of the pieces whose value is the largest, which is that of all.
    [[nodiscard]] int deciding(const Eigen::Vector4d& p) const;

    /// The pieces with no less than `least` (m), ascending.
    [[nodiscard]] std::vector<int> pieces_above(const Eigen::Vector4d& p, double least) const;

private:
    struct Node {
        Eigen::Vector4d low;  // of normals
        Eigen::Vector4d high;
        double least_offset = 0;
        std::uint32_t first = 0;  // of its pieces in order_
        std::uint32_t count = 0;  // 0 in nodes with children, the first of which is next to it
        std::uint32_t after = 0;  // the node behind all of its own
    };
    struct Largest {
        double value = 0;
        int piece = 0;
    };

    void build(std::uint32_t first, std::uint32_t count);
    [[nodiscard]] double most(const Node& node, const Eigen::Vector4d& p) const;
    void search(std::uint32_t node, const Eigen::Vector4d& p, Largest& best) const;

    std::vector<HalfSpace> pieces_;
    std::vector<int> order_;  // of pieces in the tree
    std::vector<Node> nodes_;
    double largest_offset_ = 0;
};

}  // namespace pent::mesher
