#include "patch_partition.h"

#include "near_lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace pent::contact {
namespace {

std::vector<Box> boxes(std::size_t count) {
    std::mt19937 random(static_cast<unsigned>(count));
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::vector<Box> all;
    for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Matrix<double, 4, 1> at =
            Eigen::Vector4d::NullaryExpr([&] { return coordinate(random); });
        all.push_back(box_around<4, 1>(at, 0.01));
    }
    return all;
}

TEST(PatchPartition, EachSimplexIsInOneOfAsFewPatchesOfNearlyOneSizeAsThereCanBe) {
    for (const std::size_t count : {1, 2, 15, 16, 17, 31, 33, 1000, 4097, 9000}) {
        const PatchPartition partition(boxes(count));
        EXPECT_EQ(partition.size(), (count + kLanes - 1) / kLanes);
        std::vector<int> seen(count, 0);
        std::size_t least = count;
        std::size_t most = 0;
        for (std::size_t patch = 0; patch < partition.size(); ++patch) {
            least = std::min(least, partition[patch].size());
            most = std::max(most, partition[patch].size());
            for (const std::uint32_t i : partition[patch]) {
                ++seen[i];
            }
        }
        EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
        EXPECT_LE(most, static_cast<std::size_t>(kLanes));
        EXPECT_LE(most - least, 1U);
        EXPECT_GE(least, 1U);
    }
}

TEST(PatchPartition, OfNothingThereIsNothing) {
    EXPECT_EQ(PatchPartition().size(), 0U);
    EXPECT_EQ(PatchPartition(std::span<const Box>()).size(), 0U);
}

// Of a row of boxes each patch has a piece without a gap.
TEST(PatchPartition, NeighborsAreTogether) {
    std::vector<Box> row;
    for (int i = 0; i < 200; ++i) {
        row.push_back(box_around<4, 1>(Eigen::Vector4d(i * 7 % 200, 0, 0, 0), 0.1));
    }
    const PatchPartition partition(row);
    for (std::size_t patch = 0; patch < partition.size(); ++patch) {
        std::vector<int> places;
        for (const std::uint32_t i : partition[patch]) {
            places.push_back(static_cast<int>(i) * 7 % 200);
        }
        std::sort(places.begin(), places.end());
        EXPECT_EQ(places.back() - places.front() + 1, static_cast<int>(places.size()));
    }
}

}  // namespace
}  // namespace pent::contact
