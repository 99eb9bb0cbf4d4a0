#include <pent/contact/box_tree.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace pent::contact {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// What the random boxes are like.
enum class Kind { Random, Points, Coincident, Lattice, Flat };

std::vector<Box> make_boxes(Kind kind, int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-1, 1);
    std::uniform_int_distribution<int> lattice(0, 3);
    std::vector<Box> boxes;
    for (int i = 0; i < count; ++i) {
        Corners<4, 2> corners;
        for (int axis = 0; axis < 4; ++axis) {
            const double at = kind == Kind::Lattice ? lattice(random) : place(random);
            corners(axis, 0) = kind == Kind::Coincident ? 0.5 : at;
            corners(axis, 1) = corners(axis, 0) + 0.3 * place(random);
        }
        if (kind == Kind::Points || kind == Kind::Coincident) {
            corners.col(1) = corners.col(0);
        }
        if (kind == Kind::Lattice) {
            corners.col(1) = corners.col(0) + Vector<4>::Ones();  // neighbors touch
        }
        if (kind == Kind::Flat) {
            corners.row(2).setZero();
        }
        boxes.push_back(box_around<4, 2>(corners, 0));
    }
    return boxes;
}

Pairs sorted(Pairs pairs) {
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

Pairs brute_force(const std::vector<Box>& first, const std::vector<Box>& second) {
    Pairs pairs;
    for (std::uint32_t i = 0; i < first.size(); ++i) {
        for (std::uint32_t j = 0; j < second.size(); ++j) {
            if (overlap(first[i], second[j])) {
                pairs.emplace_back(i, j);
            }
        }
    }
    return pairs;
}

Pairs tree_pairs(const BoxTree& first, const BoxTree& second, std::size_t pieces) {
    Pairs pairs;
    for (const BoxTree::Work& work : BoxTree::split(first, second, pieces)) {
        BoxTree::for_each_overlap(first, second, work, [&](std::uint32_t i, std::uint32_t j) {
            pairs.emplace_back(i, j);
        });
    }
    return pairs;
}

class BoxTreeTest : public testing::TestWithParam<std::tuple<Kind, int, int>> {
protected:
    std::vector<Box> first() const {
        return make_boxes(std::get<0>(GetParam()), std::get<1>(GetParam()), 1);
    }
    std::vector<Box> second() const {
        return make_boxes(std::get<0>(GetParam()), std::get<2>(GetParam()), 2);
    }
};

TEST_P(BoxTreeTest, FindsTheOverlapsOfTwoSetsThatBruteForceFinds) {
    const BoxTree a(first());
    const BoxTree b(second());
    const Pairs expected = brute_force(first(), second());
    for (const std::size_t pieces : {1, 7, 512}) {
        EXPECT_EQ(sorted(tree_pairs(a, b, pieces)), expected);
    }
}

TEST_P(BoxTreeTest, FindsEachOverlapWithinASetOnce) {
    const std::vector<Box> boxes = first();
    Pairs expected;
    for (const auto& [i, j] : brute_force(boxes, boxes)) {
        if (i < j) {
            expected.emplace_back(i, j);
        }
    }
    const BoxTree tree(boxes);
    for (const std::size_t pieces : {1, 7, 512}) {
        Pairs found = tree_pairs(tree, tree, pieces);
        for (auto& [i, j] : found) {
            if (j < i) {
                std::swap(i, j);
            }
        }
        EXPECT_EQ(sorted(found), expected);
    }
}

TEST_P(BoxTreeTest, FindsWhatOneBoxOverlaps) {
    const std::vector<Box> boxes = first();
    const BoxTree tree(boxes);
    Pairs found;
    for (std::uint32_t j = 0; j < boxes.size(); ++j) {
        tree.for_each_overlap(boxes[j], [&](std::uint32_t i) { found.emplace_back(j, i); });
    }
    EXPECT_EQ(sorted(found), brute_force(boxes, boxes));
}

TEST_P(BoxTreeTest, InOrderFindsThemAscending) {
    const std::vector<Box> boxes = first();
    const BoxTree tree = BoxTree::in_order(boxes);
    Pairs found;
    for (std::uint32_t j = 0; j < boxes.size(); ++j) {
        tree.for_each_overlap(boxes[j], [&](std::uint32_t i) { found.emplace_back(j, i); });
    }
    EXPECT_EQ(found, brute_force(boxes, boxes));
}

TEST_P(BoxTreeTest, IsRightAfterARefit) {
    BoxTree tree(second());  // a tree of unrelated boxes of the same number
    const std::vector<Box> other = make_boxes(Kind::Random, std::get<2>(GetParam()), 3);
    tree.refit(other);
    const BoxTree a(first());
    EXPECT_EQ(sorted(tree_pairs(a, tree, 32)), brute_force(first(), other));
}

TEST_P(BoxTreeTest, FindsTheNearestBox) {
    const std::vector<Box> boxes = first();
    const BoxTree tree(boxes);
    for (const Box& from : second()) {
        const Vector<4> point(static_cast<double>(from.low[0]), static_cast<double>(from.low[1]),
                              static_cast<double>(from.low[2]), static_cast<double>(from.low[3]));
        double expected = std::numeric_limits<double>::infinity();
        for (const Box& box : boxes) {
            expected = std::min(expected, distance_squared<4>(point, box));
        }
        double nearest = std::numeric_limits<double>::infinity();
        tree.for_each_near<4>(point, nearest, [&](std::uint32_t i) {
            nearest = std::min(nearest, distance_squared<4>(point, boxes[i]));
            return nearest;
        });
        EXPECT_EQ(nearest, expected);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Boxes,
    BoxTreeTest,
    testing::Combine(
        testing::Values(Kind::Random, Kind::Points, Kind::Coincident, Kind::Lattice, Kind::Flat),
        testing::Values(1, 2, 3, 150),
        testing::Values(1, 2, 5, 97)));

TEST(BoxTree, OfNothingFindsNothing) {
    const BoxTree empty{std::vector<Box>{}};
    const BoxTree one(make_boxes(Kind::Random, 1, 1));
    EXPECT_TRUE(tree_pairs(empty, one, 8).empty());
    EXPECT_TRUE(tree_pairs(one, empty, 8).empty());
    EXPECT_TRUE(tree_pairs(one, one, 8).empty());
    EXPECT_TRUE(empty.is_empty());
}

TEST(BoxTree, OfThousandsOfBoxesIsBuiltByAllThreadsAlike) {
    const std::vector<Box> a = make_boxes(Kind::Random, 9000, 4);
    std::vector<Box> b = make_boxes(Kind::Random, 40, 5);
    EXPECT_EQ(sorted(tree_pairs(BoxTree(b), BoxTree(a), 64)), brute_force(b, a));
    EXPECT_EQ(BoxTree(a).cost(), BoxTree(a).cost());
}

TEST(BoxAround, HoldsPointsThatFloatsCannotTell) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> exponent(-40, 30);
    for (int trial = 0; trial < 20000; ++trial) {
        const double value = (trial % 2 == 0 ? 1 : -1) * std::pow(10, exponent(random));
        const Box box = box_around<4, 1>(Vector<4>::Constant(value), 0);
        EXPECT_LE(static_cast<double>(box.low[2]), value);
        EXPECT_GE(static_cast<double>(box.high[2]), value);
        // A few float roundings wide, so that boxes stay tight.
        EXPECT_LE(static_cast<double>(box.high[2]) - static_cast<double>(box.low[2]),
                  1e-6 * std::abs(value) + 1e-37);
    }
}

TEST(Box, NowhereOverlapsNothingAndAddsNothing) {
    const Box box = box_around<4, 1>(Eigen::Matrix<double, 4, 1>(1, 2, 3, 4), 0.5);
    EXPECT_FALSE(overlap(kNowhere, box));
    EXPECT_FALSE(overlap(kNowhere, kNowhere));
    const Box both = hull(kNowhere, box);
    for (int axis = 0; axis < 4; ++axis) {
        EXPECT_EQ(both.low[axis], box.low[axis]);
        EXPECT_EQ(both.high[axis], box.high[axis]);
    }
}

TEST(BoxAround, GrowsByTheMargin) {
    const Box box = box_around<3, 1>(Vector<3>(1, 2, 3), 0.5);
    EXPECT_NEAR(box.low[0], 0.5, 1e-6);   // float
    EXPECT_NEAR(box.high[2], 3.5, 1e-6);  // float
    EXPECT_EQ(box.low[3], 0);
    EXPECT_EQ(box.high[3], 0);
}

}  // namespace
}  // namespace pent::contact
