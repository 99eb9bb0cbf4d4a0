#include "surface_patches.h"

#include "boxes_around.h"
#include "closest_points_oracle.h"
#include "gather.h"
#include "overlaps.h"
#include "scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

namespace pent::contact {
namespace {

using Pairs = std::map<std::pair<std::uint32_t, std::uint32_t>, int>;  // how often each

template <typename T>
class SurfacePatchesTest : public testing::Test {
protected:
    static constexpr int kSpace = T::value;
    static constexpr double kDistance = 0.4;

    void SetUp() override {
        scene_.add(test::cube<kSpace>(2), Vector<kSpace>::Zero());
        Vector<kSpace> aside = Vector<kSpace>::Constant(0.13);
        aside[0] = 2.3;
        scene_.add(test::cube<kSpace>(1), aside);
        rest_ = scene_.positions;
        from_ = scene_.positions;
        test::shake<kSpace>(from_, 0.05, 4);
        to_ = from_;
        to_.leftCols(scene_.begin[1]).row(0).array() += 0.5;  // toward the second
        test::shake<kSpace>(to_, 0.05, 5);
        inflation_ = Eigen::VectorXd::LinSpaced(to_.cols(), 0.01, 0.05);
    }

    [[nodiscard]] std::vector<Box> boxes(const Paths<kSpace>& paths) const {
        std::vector<Box> boxes;
        for (const Surface<kSpace>& surface : scene_.surfaces) {
            fit_boxes<kSpace>(surface.vertices, paths, 0.5 * kDistance, boxes);
        }
        return boxes;
    }

    // All patches of one kind have each simplex once, their boxes hold those of its corners, and
    // their inflation is the largest.
    template <int Count>
    void expect_all_simplices(const SurfacePatches<kSpace>& patches,
                              const std::vector<Box>& of_vertex) const {
        const auto& simplices = scene_.surfaces[0].template simplices<Count>();
        const PatchesOnPaths<kSpace>& of = patches.template of<Count>();
        std::vector<int> seen(static_cast<std::size_t>(simplices.cols()), 0);
        for (std::size_t patch = 0; patch < of.partition.size(); ++patch) {
            double most = 0;
            for (const std::uint32_t i : of.partition[patch]) {
                ++seen[i];
                for (const std::uint32_t corner : simplices.col(i)) {
                    most = std::max(most, inflation_[corner]);
                    const Box both = hull(of.around[patch], of_vertex[corner]);
                    for (int axis = 0; axis < 4; ++axis) {
                        EXPECT_EQ(both.low[axis], of.around[patch].low[axis]);
                        EXPECT_EQ(both.high[axis], of.around[patch].high[axis]);
                    }
                }
            }
            EXPECT_EQ(of.inflation[patch], most);
        }
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), simplices.cols());
    }

    // What patch against patch finds of two surfaces, or of one and itself.
    template <int K, int L>
    [[nodiscard]] Pairs found(const SurfacePatches<kSpace>& first,
                              const SurfacePatches<kSpace>& second,
                              bool is_still) const {
        Pairs pairs;
        const PatchesOnPaths<kSpace>& of_first = first.template of<K>();
        const PatchesOnPaths<kSpace>& of_second = second.template of<L>();
        for (std::size_t a = 0; a < of_first.partition.size(); ++a) {
            of_second.tree.for_each_overlap(of_first.around[a], [&](std::uint32_t b) {
                if (&of_first == &of_second && b < a) {
                    return;
                }
                for_each_near<kSpace, K>(
                    PatchOnPaths<kSpace>{of_first, a}, PatchOnPaths<kSpace>{of_second, b}, is_still,
                    kDistance + of_first.inflation[a] + of_second.inflation[b],
                    [&](std::uint32_t i, std::uint32_t j) {
                        const bool is_turned = &of_first == &of_second && j < i;
                        ++pairs[is_turned ? std::pair(j, i) : std::pair(i, j)];
                    });
            });
        }
        return pairs;
    }

    // Pairs of others that are nearer than the distance at some time are found, and each once;
    // those that share a vertex are not.
    template <int K, int L>
    void expect_all_near(const Pairs& found, int first, int second, bool is_still) {
        const auto& a = scene_.surfaces[static_cast<std::size_t>(first)].template simplices<K>();
        const auto& b = scene_.surfaces[static_cast<std::size_t>(second)].template simplices<L>();
        const bool is_one = first == second && K == L;
        for (int time = 0; time <= (is_still ? 0 : 8); ++time) {
            const Positions<kSpace> x = from_ + time / 8.0 * (to_ - from_);
            for (std::uint32_t i = 0; i < a.cols(); ++i) {
                for (std::uint32_t j = is_one ? i + 1 : 0; j < b.cols(); ++j) {
                    if (share_a_vertex<K, L>(a, i, b, j)) {
                        EXPECT_FALSE(found.contains({i, j})) << i << ' ' << j;
                        continue;
                    }
                    const auto p = gather<kSpace, K>(a, i, x);
                    const auto q = gather<kSpace, L>(b, j, x);
                    if (test::closest_points<kSpace, K, L>(p, q).distance_squared
                        < kDistance * kDistance) {
                        EXPECT_TRUE(found.contains({i, j})) << i << ' ' << j;
                        ++near_;
                    }
                }
            }
        }
        for (const auto& [pair, times] : found) {
            EXPECT_EQ(times, 1) << pair.first << ' ' << pair.second;
        }
    }

    test::Scene<kSpace> scene_;
    Positions<kSpace> rest_;
    Positions<kSpace> from_;
    Positions<kSpace> to_;
    Eigen::VectorXd inflation_;
    std::int64_t near_ = 0;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(SurfacePatchesTest, Dimensions);

TYPED_TEST(SurfacePatchesTest, HaveEachSimplexOnceInBoxesAroundItsPath) {
    constexpr int kDim = TypeParam::value;
    const PositionsView<kDim> from = this->from_;
    const PositionsView<kDim> to = this->to_;
    const std::vector<Box> boxes =
        this->boxes({.from = from, .to = to, .inflation = &this->inflation_});
    SurfacePatches<kDim> patches(this->scene_.surfaces[0], this->rest_);
    patches.fit({.from = from, .to = to, .inflation = &this->inflation_}, boxes);
    EXPECT_EQ(patches.refit(), kDim);
    this->template expect_all_simplices<1>(patches, boxes);
    this->template expect_all_simplices<2>(patches, boxes);
    this->template expect_all_simplices<3>(patches, boxes);
    this->template expect_all_simplices<kDim>(patches, boxes);
    patches.fit({from, to}, boxes);
    for (const double inflation : patches.template of<kDim>().inflation) {
        EXPECT_EQ(inflation, 0);
    }
}

TYPED_TEST(SurfacePatchesTest, FindAllThatComesNearOfTwoSurfacesAndOfOne) {
    constexpr int kDim = TypeParam::value;
    for (const bool is_still : {false, true}) {
        const PositionsView<kDim> from = this->from_;
        const PositionsView<kDim> to = is_still ? from : PositionsView<kDim>(this->to_);
        const Paths<kDim> paths{.from = from, .to = to, .inflation = &this->inflation_};
        const std::vector<Box> boxes = this->boxes(paths);
        std::vector<SurfacePatches<kDim>> patches;
        for (const Surface<kDim>& surface : this->scene_.surfaces) {
            patches.emplace_back(surface, this->rest_);
            patches.back().fit(paths, boxes);
            patches.back().set_lanes(paths);
        }
        for (const int second : {0, 1}) {
            const auto& of_second = patches[static_cast<std::size_t>(second)];
            this->template expect_all_near<1, kDim>(
                this->template found<1, kDim>(patches[0], of_second, is_still), 0, second,
                is_still);
            this->template expect_all_near<2, kDim - 1>(
                this->template found<2, kDim - 1>(patches[0], of_second, is_still), 0, second,
                is_still);
        }
    }
    EXPECT_GT(this->near_, 1000);  // the test is about something
}

}  // namespace
}  // namespace pent::contact
