#include "halving.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace pent::contact {
namespace {

// At random places of a block that is longest along one axis; some of them at the same.
std::vector<Box> boxes_in_block(int longest, std::size_t count) {
    std::mt19937 random(static_cast<unsigned>(longest + 1));
    std::uniform_int_distribution<int> place(0, 40);
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        Eigen::Matrix<double, 4, 1> at =
            Eigen::Vector4d::NullaryExpr([&] { return 0.01 * place(random); });
        at[longest] *= 10;
        boxes.push_back(box_around<4, 1>(at, 0.1));
    }
    return boxes;
}

TEST(Centered, HasTheCenterOfEachBoxTwice) {
    const std::vector<Box> boxes = boxes_in_block(0, 5000);
    const std::vector<CenteredBox> all = centered(boxes);
    ASSERT_EQ(all.size(), boxes.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        ASSERT_EQ(all[i].index, i);
        for (int axis = 0; axis < 4; ++axis) {
            ASSERT_EQ(all[i].center[axis], boxes[i].low[axis] + boxes[i].high[axis]);
        }
    }
}

TEST(Halve, PutsTheLeastAlongTheLongestSideInFront) {
    for (int longest = 0; longest < 4; ++longest) {
        for (const std::size_t in_first : {1, 13, 99, 100}) {
            std::vector<CenteredBox> all = centered(boxes_in_block(longest, 100));
            std::vector<std::pair<float, std::uint32_t>> expected;
            for (const CenteredBox& box : all) {
                expected.emplace_back(box.center[longest], box.index);
            }
            std::sort(expected.begin(), expected.end());
            halve(all, in_first);
            std::vector<std::pair<float, std::uint32_t>> found;
            for (const CenteredBox& box : all) {
                found.emplace_back(box.center[longest], box.index);
            }
            const auto middle = found.begin() + static_cast<std::ptrdiff_t>(in_first);
            std::sort(found.begin(), middle);
            std::sort(middle, found.end());
            EXPECT_EQ(found, expected) << longest << " " << in_first;
        }
    }
}

}  // namespace
}  // namespace pent::contact
