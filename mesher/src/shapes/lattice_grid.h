#pragma once

#include "lattice.h"

#include <pent/mesher/cut_simplex.h>
#include <pent/mesher/solid.h>

#include <cstdint>
#include <vector>

namespace pent::mesher {

/// The lattice points in and around a solid, in blocks of 4^4, with the solid's values there.
///
/// A step is a set of axes: bit i for one step forward along axis i.
class LatticeGrid {
public:
    static constexpr unsigned kSide = 4;
    static constexpr unsigned kBlock = kSide * kSide * kSide * kSide;
    static constexpr unsigned kSteps = 16;
    static constexpr std::uint32_t kNone = 0xffffffff;

    /// Every point inside is there, and everything an edge away from it. Throws an Error for NaN
    /// and for more blocks than can be kept.
    ///
    /// @param solid  Bounded.
    LatticeGrid(const Solid& solid, const Lattice& lattice);

    [[nodiscard]] const Lattice& lattice() const { return lattice_; }
    [[nodiscard]] std::uint32_t block_count() const {
        return static_cast<std::uint32_t>(blocks_.size());
    }
    [[nodiscard]] std::uint32_t point_count() const { return block_count() * kBlock; }

    [[nodiscard]] Eigen::Vector4d place(std::uint32_t point) const;
    [[nodiscard]] double value(std::uint32_t point) const { return values_[point]; }

    /// The point a step further, or kNone where it is not kept: it is outside then.
    [[nodiscard]] std::uint32_t after(std::uint32_t point, unsigned step) const {
        return neighbor(point, forward_[point % kBlock * kSteps + step], blocks_after_);
    }
    [[nodiscard]] std::uint32_t before(std::uint32_t point, unsigned step) const {
        return neighbor(point, backward_[point % kBlock * kSteps + step], blocks_before_);
    }

private:
    // Where a step leads from a place in a block: which axes leave the block, and the place there.
    struct Move {
        std::uint8_t leaves = 0;
        std::uint8_t place = 0;
    };
    using BlockNeighbors = std::vector<std::array<std::uint32_t, kSteps>>;

    [[nodiscard]] static std::uint32_t neighbor(std::uint32_t point,
                                                const Move& move,
                                                const BlockNeighbors& blocks) {
        const std::uint32_t block = blocks[point / kBlock][move.leaves];
        return block == kNone ? kNone : block * kBlock + move.place;
    }

    void set_range(const Box4& box);
    void consider(const Solid& solid, const Eigen::Vector4i& block);
    void choose_blocks(const Solid& solid);
    void link_blocks();
    void make_moves();
    void sample(const Solid& solid);

    Lattice lattice_;
    Eigen::Vector4i low_;                  // in blocks
    Eigen::Vector4i count_;                // of blocks
    std::vector<Eigen::Vector4i> blocks_;  // first points
    std::vector<bool> is_inside_;          // blocks whose points are inside, and all around them
    std::vector<double> values_;
    BlockNeighbors blocks_after_;
    BlockNeighbors blocks_before_;
    std::vector<Move> forward_;
    std::vector<Move> backward_;
};

}  // namespace pent::mesher
