#include "lattice_grid.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/parallel.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pent::mesher {

namespace {

constexpr std::size_t kMaxBlocks = 1 << 23;  // 2^31 points
constexpr double kMaxBlocksAround = 1 << 26;
constexpr double kFarthestBlock = 1e8;  // its points are numbered by ints
constexpr double kRounding = 1e-9;

// From the middle of a block to its farthest point, over the spacing: steps of 1.5 along two axes
// and -1.5 along the others.
constexpr double kBlockRadius = 3.0;

Eigen::Vector4i place_in_block(unsigned place) {
    constexpr int kSide = LatticeGrid::kSide;
    const auto p = static_cast<int>(place);
    return {p % kSide, p / kSide % kSide, p / (kSide * kSide) % kSide, p / (kSide * kSide * kSide)};
}

}  // namespace

std::array<LatticePath, 24> lattice_paths() {
    std::array<LatticePath, 24> paths;
    std::array<int, 4> axes = {0, 1, 2, 3};
    for (LatticePath& path : paths) {
        for (int i = 0; i < 4; ++i) {
            path.steps[i + 1] = path.steps[i] | 1U << axes[i];
            for (int j = i + 1; j < 4; ++j) {
                path.is_odd = path.is_odd != (axes[i] > axes[j]);
            }
        }
        std::next_permutation(axes.begin(), axes.end());
    }
    return paths;
}

LatticeGrid::LatticeGrid(const Solid& solid, const Lattice& lattice) : lattice_(lattice) {
    choose_blocks(solid);
    link_blocks();
    make_moves();
    sample(solid);
}

Eigen::Vector4d LatticeGrid::place(std::uint32_t point) const {
    return lattice_.point(blocks_[point / kBlock] + place_in_block(point % kBlock));
}

// The range of blocks that has the box of the body and one block around it.
void LatticeGrid::set_range(const Box4& box) {
    const Eigen::Vector4d middle = lattice_.coordinates((box.low + box.high) / 2);
    // The farthest of the corners along each axis of the lattice: all coordinates grow with all
    // of a point.
    const Eigen::Vector4d reach = lattice_.coordinates((box.high - box.low) / 2);
    const double side = kSide;
    const Eigen::Vector4d first = ((middle - reach).array() / side).floor() - 1;
    const Eigen::Vector4d last = ((middle + reach).array() / side).floor() + 1;
    const Eigen::Vector4d count = (last - first).array() + 1;
    if (!(count.prod() <= kMaxBlocksAround && first.cwiseAbs().maxCoeff() < kFarthestBlock)) {
        const Eigen::Vector4d size = box.high - box.low;
        throw Error(
            formatted("edges of %g m are too short for a body within %g x %g x %g x %g m^4 around "
                      "(%g, %g, %g, %g); expected longer ones",
                      lattice_.mean_edge(), size[0], size[1], size[2], size[3],
                      (box.low[0] + box.high[0]) / 2, (box.low[1] + box.high[1]) / 2,
                      (box.low[2] + box.high[2]) / 2, (box.low[3] + box.high[3]) / 2));
    }
    low_ = first.cast<int>();
    count_ = count.cast<int>();
}

// Keeps a block that may hold a point inside, or one within an edge of the body.
void LatticeGrid::consider(const Solid& solid, const Eigen::Vector4i& block) {
    const double reach =
        kBlockRadius * lattice_.spacing + (1 + kRounding) * lattice_.longest_edge();
    const Eigen::Vector4i start = static_cast<int>(kSide) * (low_ + block);
    const Eigen::Vector4d center = lattice_.place(start.cast<double>().array() + (kSide - 1.0) / 2);
    const Box4& box = solid.bounds();
    if (((center.array() + reach) < box.low.array()).any()
        || ((center.array() - reach) > box.high.array()).any()) {
        return;
    }
    const ValueRange range = solid.values_within(center, reach);
    if (range.low <= 0) {
        blocks_.push_back(start);
        is_inside_.push_back(range.high < 0);
    }
}

void LatticeGrid::choose_blocks(const Solid& solid) {
    set_range(solid.bounds());
    Eigen::Vector4i block;
    for (block[3] = 0; block[3] < count_[3]; ++block[3]) {
        for (block[2] = 0; block[2] < count_[2]; ++block[2]) {
            for (block[1] = 0; block[1] < count_[1]; ++block[1]) {
                for (block[0] = 0; block[0] < count_[0]; ++block[0]) {
                    consider(solid, block);
                }
            }
        }
    }
    if (blocks_.size() > kMaxBlocks) {
        throw Error(formatted("edges of %g m give more than 2^31 points; expected longer ones",
                              lattice_.mean_edge()));
    }
}

void LatticeGrid::link_blocks() {
    const std::int64_t total = count_.cast<std::int64_t>().prod();
    std::vector<std::uint32_t> number(static_cast<std::size_t>(total), kNone);
    const auto index_of = [&](const Eigen::Vector4i& block) {
        std::int64_t index = 0;
        for (int axis = 3; axis >= 0; --axis) {
            index = index * count_[axis] + block[axis];
        }
        return static_cast<std::size_t>(index);
    };
    const auto block_at = [&](std::uint32_t i) -> Eigen::Vector4i {
        return blocks_[i] / static_cast<int>(kSide) - low_;
    };
    for (std::uint32_t i = 0; i < block_count(); ++i) {
        number[index_of(block_at(i))] = i;
    }
    const auto neighbors = [&](int direction) {
        BlockNeighbors result(block_count());
        for (std::uint32_t i = 0; i < block_count(); ++i) {
            for (unsigned step = 0; step < kSteps; ++step) {
                Eigen::Vector4i block = block_at(i);
                for (int axis = 0; axis < 4; ++axis) {
                    block[axis] += (step >> axis & 1U) != 0 ? direction : 0;
                }
                const bool exists = block.minCoeff() >= 0 && (block - count_).maxCoeff() < 0;
                result[i][step] = exists ? number[index_of(block)] : kNone;
            }
        }
        return result;
    };
    blocks_after_ = neighbors(1);
    blocks_before_ = neighbors(-1);
}

void LatticeGrid::make_moves() {
    const auto moves = [](int direction) {
        constexpr int kLength = kSide;
        std::vector<Move> result(kBlock * kSteps);
        for (unsigned place = 0; place < kBlock; ++place) {
            for (unsigned step = 0; step < kSteps; ++step) {
                Move& move = result[place * kSteps + step];
                const Eigen::Vector4i from = place_in_block(place);
                for (int axis = 3; axis >= 0; --axis) {
                    const int to = from[axis] + ((step >> axis & 1U) != 0 ? direction : 0);
                    move.leaves |= to < 0 || to >= kLength ? 1U << axis : 0U;
                    move.place =
                        static_cast<std::uint8_t>(move.place * kLength + (to + kLength) % kLength);
                }
            }
        }
        return result;
    };
    forward_ = moves(1);
    backward_ = moves(-1);
}

void LatticeGrid::sample(const Solid& solid) {
    constexpr std::uint32_t kBlocks = 8;  // to a task
    values_.assign(point_count(), -1.0);
    parallel_for(block_count(), kBlocks, [&](std::uint32_t block) {
        if (is_inside_[block]) {
            return;
        }
        for (unsigned i = 0; i < kBlock; ++i) {
            const std::uint32_t point = block * kBlock + i;
            values_[point] = solid.value(place(point));
        }
    });
    const auto not_a_number = std::find_if(values_.begin(), values_.end(),
                                           [](double value) { return std::isnan(value); });
    if (not_a_number != values_.end()) {
        const Eigen::Vector4d p = place(static_cast<std::uint32_t>(not_a_number - values_.begin()));
        throw Error(
            formatted("the expression is not a number at (%g, %g, %g, %g); expected a function "
                      "that is one everywhere in and around its box",
                      p[0], p[1], p[2], p[3]));
    }
}

}  // namespace pent::mesher
