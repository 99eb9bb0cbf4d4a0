#include "surface_trees.h"

#include "boxes_around.h"
#include "gather.h"
#include "scenes.h"

#include <gtest/gtest.h>

namespace pent::contact {
namespace {

template <typename T>
class SurfaceTreesTest : public testing::Test {
protected:
    static constexpr int kSpace = T::value;

    void SetUp() override {
        scene_.add(test::cube<kSpace>(2), Vector<kSpace>::Zero());
        test::shake<kSpace>(scene_.positions, 0.1, 4);
    }

    [[nodiscard]] std::vector<Box> boxes(const Positions<kSpace>& x) const {
        return boxes_around<kSpace, 1>(
            Simplices<1>::NullaryExpr(
                1, x.cols(),
                [](Eigen::Index /*row*/, Eigen::Index i) { return static_cast<std::uint32_t>(i); }),
            x, 0.05);
    }

    // The tree is over the boxes around the simplices themselves.
    template <int Count>
    void expect_boxes_around(const SurfaceTrees<kSpace>& trees, const Positions<kSpace>& x) const {
        const auto& simplices = scene_.surfaces[0].template simplices<Count>();
        const BoxTree expected(boxes_around<kSpace, Count>(simplices, x, 0.05));
        const BoxTree& tree = trees.template tree<Count>();
        ASSERT_EQ(tree.size(), expected.size());
        for (int axis = 0; axis < 4; ++axis) {
            EXPECT_EQ(tree.root_box().low[axis], expected.root_box().low[axis]);
            EXPECT_EQ(tree.root_box().high[axis], expected.root_box().high[axis]);
        }
    }

    test::Scene<kSpace> scene_;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(SurfaceTreesTest, Dimensions);

TYPED_TEST(SurfaceTreesTest, AreOverBoxesAroundAllKindsOfSimplicesAndFollowThem) {
    constexpr int kDim = TypeParam::value;
    const Surface<kDim>& surface = this->scene_.surfaces[0];
    SurfaceTrees<kDim> trees;
    Positions<kDim> x = this->scene_.positions;
    for (int time = 0; time < 2; ++time) {
        trees.update_vertices(surface, this->boxes(x));
        trees.update_faces(surface, this->boxes(x));
        EXPECT_EQ(trees.built(), kDim);  // each kind once
        EXPECT_EQ(trees.refit(), time * kDim);
        this->template expect_boxes_around<1>(trees, x);
        this->template expect_boxes_around<2>(trees, x);
        this->template expect_boxes_around<kDim - 1>(trees, x);
        this->template expect_boxes_around<kDim>(trees, x);
        test::shake<kDim>(x, 0.01, 5);
    }
    x.row(0) *= 10;  // boxes that no longer fit the tree's halves
    x = (test::tilt<kDim>() * x).eval();
    trees.update_vertices(surface, this->boxes(x));
    trees.update_faces(surface, this->boxes(x));
    EXPECT_GT(trees.built(), kDim);
    EXPECT_GT(trees.bytes(), 0);
}

TYPED_TEST(SurfaceTreesTest, OfFacetsAreFitAlone) {
    constexpr int kDim = TypeParam::value;
    SurfaceTrees<kDim> trees;
    trees.update_facets(this->scene_.surfaces[0], this->boxes(this->scene_.positions));
    EXPECT_EQ(trees.built(), 1);
    this->template expect_boxes_around<kDim>(trees, this->scene_.positions);
    EXPECT_TRUE(trees.template tree<1>().is_empty());
    EXPECT_TRUE(trees.template tree<2>().is_empty());
}

}  // namespace
}  // namespace pent::contact
