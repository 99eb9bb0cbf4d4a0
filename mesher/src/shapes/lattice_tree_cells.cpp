#include "lattice_keys.h"
#include "lattice_tree.h"

#include <pent/error.h>
#include <pent/formatted.h>

#include <algorithm>
#include <cmath>

namespace pent::mesher {

namespace {

constexpr double kFarthestPoint = 1e9;                   // coordinates are ints
constexpr std::size_t kMaxCells = std::size_t{1} << 26;  // 1.6e9 simplices
constexpr double kRounding = 1e-9;

// Cells of this size and larger are asked whether the body may be there; what is smaller is not
// worth it.
constexpr int kSmallestAsked = 2;

// For each cell around a cell, and for itself, the middles of edges that lie in both.
std::array<std::bitset<81>, 81> shared_middles() {
    std::array<std::bitset<81>, 81> shared;
    for (unsigned neighbor = 0; neighbor < 81; ++neighbor) {
        const Eigen::Vector4i side = digits(neighbor).array() - 1;
        for (unsigned place = 0; place < 81; ++place) {
            const Eigen::Vector4i at = digits(place);
            bool is_shared = (at.array() == 1).any();
            for (int axis = 0; axis < 4; ++axis) {
                is_shared = is_shared && (side[axis] == 0 || at[axis] == 1 + side[axis]);
            }
            shared[neighbor][place] = is_shared;
        }
    }
    return shared;
}

}  // namespace

struct LatticeTree::Node {
    Eigen::Vector4i corner;  // in spacings from low_
    int size = 0;
    bool is_inside = false;
};

// The largest cells that have the box of the body.
void LatticeTree::set_range(const Solid& solid, const SizeField& sizes) {
    const Box4& box = solid.bounds();
    const Eigen::Vector4d middle = lattice_.coordinates((box.low + box.high) / 2);
    // The corner that is farthest along each axis of the lattice: each of its coordinates grows
    // with every coordinate of a point.
    const Eigen::Vector4d half_size = lattice_.coordinates((box.high - box.low) / 2);
    const double shortest = lattice_.mean_edge();
    const double radius = (box.high - box.low).norm() / 2;
    const double longest =
        sizes.is_uniform()
            ? shortest
            : std::min(
                sizes.longest,
                shortest + sizes.growth * (sizes.distance((box.low + box.high) / 2) + radius));
    largest_ = std::clamp(static_cast<int>(std::floor(std::log2(longest / shortest) + kRounding)),
                          0, kKeyBits - 3);
    top_ = std::max(largest_, kSmallestAsked);
    while (top_ < kKeyBits - 2 && 2 * half_size.maxCoeff() > 4 * std::ldexp(1.0, top_)) {
        ++top_;
    }
    const double side = std::ldexp(1.0, top_);
    const Eigen::Vector4d first = ((middle - half_size).array() / side - kRounding).floor();
    const Eigen::Vector4d last = ((middle + half_size).array() / side + kRounding).floor();
    const Eigen::Vector4d count = (last - first).array() + 1;
    if (!(side * count.maxCoeff() < std::ldexp(1.0, kKeyBits)
          && side * first.cwiseAbs().maxCoeff() < kFarthestPoint)) {
        const Eigen::Vector4d size = box.high - box.low;
        throw Error(
            formatted("edges of %g m are too short for a body within %g x %g x %g x %g m^4 around "
                      "(%g, %g, %g, %g); expected longer ones",
                      lattice_.mean_edge(), size[0], size[1], size[2], size[3],
                      (box.low[0] + box.high[0]) / 2, (box.low[1] + box.high[1]) / 2,
                      (box.low[2] + box.high[2]) / 2, (box.low[3] + box.high[3]) / 2));
    }
    low_ = (side * first).cast<int>();
    count_ = count.cast<int>();
}

// Calls leaf(node) for cells that are not split, in the order of their keys, and split(node,
// center, radius) for those that could be.
template <typename Split, typename Leaf>
void LatticeTree::descend(const Solid& solid,
                          const Node& node,
                          const Split& split,
                          const Leaf& leaf) const {
    const double side = std::ldexp(1.0, node.size);
    const Eigen::Vector4d center =
        lattice_.place((low_ + node.corner).cast<double>().array() + side / 2);
    // From the middle to the farthest corners, which are those with two coordinates of either sign.
    const double radius = (1 + kRounding) * side * lattice_.spacing;
    bool is_inside = node.is_inside;
    if (!is_inside && node.size >= kSmallestAsked) {
        const Box4& box = solid.bounds();
        if (((center.array() + radius) < box.low.array()).any()
            || ((center.array() - radius) > box.high.array()).any()) {
            return;
        }
        const ValueRange range = solid.values_within(center, radius);
        if (range.low > 0) {
            return;
        }
        is_inside = range.high < 0;
    }
    if (node.size == 0 || !split(node, center, radius)) {
        leaf(Node{node.corner, node.size, is_inside});
        return;
    }
    for (unsigned child = 0; child < kCorners; ++child) {
        // The key has the first axis in the highest bit.
        const unsigned axes =
            (child & 1U) << 3 | (child & 2U) << 1 | (child & 4U) >> 1 | child >> 3;
        descend(solid,
                {node.corner + (1 << (node.size - 1)) * unit_steps(axes), node.size - 1, is_inside},
                split, leaf);
    }
}

template <typename Split, typename Leaf>
void LatticeTree::descend(const Solid& solid, const Split& split, const Leaf& leaf) const {
    Eigen::Vector4i z;
    for (z[0] = 0; z[0] < count_[0]; ++z[0]) {
        for (z[1] = 0; z[1] < count_[1]; ++z[1]) {
            for (z[2] = 0; z[2] < count_[2]; ++z[2]) {
                for (z[3] = 0; z[3] < count_[3]; ++z[3]) {
                    descend(solid, {(1 << top_) * z, top_, false}, split, leaf);
                }
            }
        }
    }
}

void LatticeTree::choose_cells(const Solid& solid, const SizeField& sizes) {
    const double shortest = lattice_.mean_edge();
    if (largest_ > 0) {
        split_.resize(static_cast<std::size_t>(largest_) + 1);
        descend(
            solid,
            [&](const Node& node, const Eigen::Vector4d& center, double radius) {
                const bool is_too_large =
                    std::ldexp(shortest, node.size)
                    > (1 + kRounding) * sizes.edge_within(shortest, center, radius);
                if (is_too_large && node.size <= largest_) {
                    split_[node.size].insert(key_of(node.corner));
                }
                return is_too_large || node.size > largest_;
            },
            [](const Node&) {});
        balance();
    }
    descend(
        solid,
        [&](const Node& node, const Eigen::Vector4d&, double) {
            return node.size > largest_ || split_[node.size].count(key_of(node.corner)) > 0;
        },
        [&](const Node& node) {
            if (cells_.size() >= kMaxCells) {
                throw Error(
                    formatted("edges of %g m give more than 1.6e9 pentachora; expected longer ones",
                              lattice_.mean_edge()));
            }
            cells_.push_back(
                {key_of(node.corner), static_cast<std::uint8_t>(node.size), node.is_inside});
        });
}

// 2:1 balance: what touches a cell that is split must not be larger than that cell was, so the
// parents of all cells around it are split, too.
void LatticeTree::balance() {
    for (int size = 1; size < largest_; ++size) {
        for (const std::uint64_t key : split_[size]) {
            const Eigen::Vector4i corner = point_of(key);
            for (unsigned neighbor = 0; neighbor < kPlaces; ++neighbor) {
                const Eigen::Vector4i there =
                    corner.array() + (1 << size) * (digits(neighbor).array() - 1);
                if (is_key_in_range(there)) {
                    const int parent = 2 << size;
                    split_[size + 1].insert(key_of(there / parent * parent));
                }
            }
        }
    }
}

// The hanging vertices of a cell: middles of edges that it shares with cells that are split.
std::bitset<LatticeTree::kPlaces> LatticeTree::middles_of(const Cell& cell) const {
    static const std::array<std::bitset<81>, 81> shared = shared_middles();
    std::bitset<kPlaces> middles;
    if (cell.size == 0 || split_.empty()) {
        return middles;
    }
    const Eigen::Vector4i corner = point_of(cell.key);
    for (unsigned neighbor = 0; neighbor < kPlaces; ++neighbor) {
        const Eigen::Vector4i there =
            corner.array() + (1 << cell.size) * (digits(neighbor).array() - 1);
        if (is_key_in_range(there) && split_[cell.size].count(key_of(there)) > 0) {
            middles |= shared[neighbor];
        }
    }
    return middles;
}

}  // namespace pent::mesher
