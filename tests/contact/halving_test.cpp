#include "halving.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
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

TEST(OrderByHalving, PutsTheLeastAlongTheLongestSideInFront) {
    for (int longest = 0; longest < 4; ++longest) {
        const std::vector<Box> boxes = boxes_in_block(longest, 5000);
        const auto center = [&](std::uint32_t i) {
            return boxes[i].low[longest] + boxes[i].high[longest];
        };
        for (const std::uint32_t in_first : {1U, 13U, 2500U, 4999U}) {
            std::vector<std::uint32_t> order =
                order_by_halving(boxes, std::vector<std::uint32_t>{0, in_first, 5000});
            std::vector<std::uint32_t> expected = order;
            std::sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) {
                return center(a) != center(b) ? center(a) < center(b) : a < b;
            });
            for (std::vector<std::uint32_t>* list : {&order, &expected}) {
                std::sort(list->begin(), list->begin() + in_first);
                std::sort(list->begin() + in_first, list->end());
            }
            EXPECT_EQ(order, expected) << longest << " " << in_first;
        }
    }
}

// Five groups fall into three and two, and three into two and one.
TEST(OrderByHalving, HalvesEachHalfAsIfItWereAlone) {
    const std::vector<Box> boxes = boxes_in_block(2, 100);
    const std::vector<std::uint32_t> whole =
        order_by_halving(boxes, std::vector<std::uint32_t>{0, 20, 40, 60, 80, 100});
    const std::vector<std::uint32_t> halves =
        order_by_halving(boxes, std::vector<std::uint32_t>{0, 60, 100});
    const auto in_groups = [&](std::uint32_t first, const std::vector<std::uint32_t>& begin) {
        std::vector<std::uint32_t> numbers(halves.begin() + first,
                                           halves.begin() + first + begin.back());
        std::sort(numbers.begin(), numbers.end());
        std::vector<Box> own;
        for (const std::uint32_t i : numbers) {
            own.push_back(boxes[i]);
        }
        const std::vector<std::uint32_t> order = order_by_halving(own, begin);
        for (std::size_t group = 1; group < begin.size(); ++group) {
            std::vector<std::uint32_t> expected;
            for (std::uint32_t k = begin[group - 1]; k < begin[group]; ++k) {
                expected.push_back(numbers[order[k]]);
            }
            const auto at = whole.begin() + first;
            std::vector<std::uint32_t> found(at + begin[group - 1], at + begin[group]);
            std::sort(expected.begin(), expected.end());
            std::sort(found.begin(), found.end());
            EXPECT_EQ(found, expected) << first << " " << group;
        }
    };
    in_groups(0, {0, 20, 40, 60});
    in_groups(60, {0, 20, 40});
}

}  // namespace
}  // namespace pent::contact
