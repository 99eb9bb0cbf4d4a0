#include "patch_tree.h"

#include <gtest/gtest.h>

#include <random>

namespace pent::contact {
namespace {

std::vector<Box> random_boxes(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-1, 1);
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        Corners<4, 2> corners = Corners<4, 2>::NullaryExpr([&] { return place(random); });
        corners.col(1) = corners.col(0) + 0.8 * corners.col(1);
        boxes.push_back(box_around<4, 2>(corners, 0));
    }
    return boxes;
}

TEST(PatchTree, FindsWhatBruteForceFindsInOrder) {
    const std::vector<Box> asked = random_boxes(100, 1);
    for (const std::size_t count : {4, 16, 256}) {
        const std::vector<Box> boxes = random_boxes(count, 2);
        const PatchTree tree(boxes);
        ASSERT_EQ(tree.size(), count);
        std::size_t hits = 0;
        for (const Box& box : asked) {
            std::vector<std::uint32_t> expected;
            for (std::uint32_t k = 0; k < count; ++k) {
                if (overlap(box, boxes[k])) {
                    expected.push_back(k);
                }
            }
            std::vector<std::uint32_t> found;
            tree.for_each_overlap(box, [&](std::uint32_t k) { found.push_back(k); });
            EXPECT_EQ(found, expected);
            hits += found.size();
        }
        EXPECT_GT(hits, 0U);
    }
}

TEST(PatchTree, KnowsTheBoxOfEachPatch) {
    const std::vector<Box> boxes = random_boxes(8, 3);
    const PatchTree tree(boxes);
    for (std::size_t k = 0; k < boxes.size(); ++k) {
        EXPECT_TRUE(std::equal(boxes[k].low, boxes[k].low + 4, tree.box(k).low));
        EXPECT_TRUE(std::equal(boxes[k].high, boxes[k].high + 4, tree.box(k).high));
    }
}

TEST(PatchTree, OfNothingFindsNothing) {
    const PatchTree tree{std::vector<Box>()};
    tree.for_each_overlap(random_boxes(1, 4)[0], [](std::uint32_t) { FAIL(); });
    EXPECT_EQ(tree.size(), 0U);
}

}  // namespace
}  // namespace pent::contact
