#include "layer_places.h"

#include "requested_layers.h"
#include "support/messages.h"

#include <pent/mesher/make_body.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace pent::mesher {
namespace {

std::vector<double> heights_of(const std::vector<double>& places) {
    std::vector<double> heights;
    for (std::size_t l = 1; l < places.size(); ++l) {
        heights.push_back(places[l] - places[l - 1]);
    }
    return heights;
}

TEST(GradedPlaces, AreSymmetricToTheLastBitAboutAMiddleSlice) {
    for (const int slabs : {1, 2, 5, 8, 31}) {
        const std::vector<double> places = graded_places(slabs, 1.3, 0.5);
        ASSERT_EQ(places.size(), slabs + 1U);
        EXPECT_EQ(places.front(), -0.5);
        for (int l = 0; l <= slabs; ++l) {
            EXPECT_EQ(places[l], -places[slabs - l]) << slabs;
        }
    }
}

TEST(GradedPlaces, GrowAwayFromTheSliceByTheSameFactor) {
    // Beside the slab that the slice may lie in, each is 1.3 times its neighbor towards the slice,
    // to the rounding of differences of places: the lowest of these slabs is 1e-3.
    for (const double slice : {0.0, 0.2, 0.5, 0.77, 1.0}) {
        const std::vector<double> places = graded_places(20, 1.3, slice);
        EXPECT_EQ(places.front(), -slice);
        EXPECT_EQ(places.back(), 1 - slice);
        const std::vector<double> heights = heights_of(places);
        int compared = 0;
        for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
            ASSERT_GT(heights[i], 0);
            if (places[i] >= 0) {
                EXPECT_NEAR(heights[i + 1] / heights[i], 1.3, 1e-11);
                ++compared;
            } else if (places[i + 2] <= 0) {
                EXPECT_NEAR(heights[i] / heights[i + 1], 1.3, 1e-11);
                ++compared;
            }
        }
        EXPECT_GE(compared, 17) << slice;
    }
}

TEST(GradedPlaces, AreEvenWithoutGrowth) {
    EXPECT_EQ(graded_places(4, 1, 0.5), (std::vector<double>{-0.5, -0.25, 0, 0.25, 0.5}));
    EXPECT_EQ(graded_places(2, 1, 0), (std::vector<double>{0, 0.5, 1}));
}

TEST(GradedPlaces, RefuseNeedles) {
    test::expect_contains(test::error_of([] { static_cast<void>(graded_places(100, 2, 0.5)); }),
                          {"100 layers", "2 times", "over a million", "grade nearer to 1"});
}

TEST(GradedSlabs, MakeTheLowestAsHighAsIsAskedFor) {
    for (const double slice : {0.0, 0.3, 0.5}) {
        const int slabs = graded_slabs(0.01, 1.2, slice);
        const std::vector<double> heights = heights_of(graded_places(slabs, 1.2, slice));
        const double lowest = *std::min_element(heights.begin(), heights.end());
        // Rounded to a whole number of slabs, and one of them may lie across the slice.
        EXPECT_NEAR(lowest, 0.01, 0.002) << slice;
        EXPECT_LT(slabs, 100) << "as many as without a grade";
    }
    EXPECT_EQ(graded_slabs(0.1, 1, 0.5), 10);
    EXPECT_EQ(graded_slabs(5, 1.5, 0.5), 1);
}

TEST(ListedPlaces, GoOutwardToBothSides) {
    const std::vector<double> both = listed_places({1, 1, 2}, 0.5);
    EXPECT_EQ(both, (std::vector<double>{-0.5, -0.25, -0.125, 0, 0.125, 0.25, 0.5}));
    EXPECT_EQ(listed_places({1, 3}, 0), (std::vector<double>{0, 0.25, 1}));
    EXPECT_EQ(listed_places({1, 3}, 1), (std::vector<double>{-1, -0.25, 0}));
    EXPECT_EQ(listed_places({1}, 0.25), (std::vector<double>{-0.25, 0, 0.75}));
}

TEST(ListedPlaces, RefuseWhatIsNoHeight) {
    for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        EXPECT_FALSE(test::error_of([&] {
                         static_cast<void>(listed_places({1, bad}, 0.5));
                     }).empty());
    }
    EXPECT_FALSE(test::error_of([] { static_cast<void>(listed_places({}, 0.5)); }).empty());
}

TEST(RequestedLayers, TakeListedHeightsAsTheThickness) {
    ExtrusionRequest request;
    request.layer_heights = {0.1, 0.3};
    const Layers<4> both = requested_layers<4>(request, {1, 2, 0.1});
    ASSERT_EQ(both.layers.size(), 5U);
    EXPECT_EQ(both.layers[0].offset[3], -0.4);
    EXPECT_EQ(both.layers[3].offset[3], 0.1);
    EXPECT_EQ(both.volume, 2 * 0.8);
    request.anchor = Anchor::Start;
    const Layers<4> one = requested_layers<4>(request, {1, 2, 0.1});
    ASSERT_EQ(one.layers.size(), 3U);
    EXPECT_EQ(one.layers[1].offset[3], 0.1);
    request.thickness = -4;  // which they share out
    EXPECT_EQ(requested_layers<4>(request, {1, 2, 0.1}).layers[1].offset[3], -1);
}

TEST(RequestedLayers, GradeRoundBodiesAndThreeDimensions) {
    ExtrusionRequest request;
    request.grade = 1.5;
    request.layers = 6;
    const Layers<3> flat = requested_layers<3>(request, {5, 1, 0.1});
    ASSERT_EQ(flat.layers.size(), 7U);
    const double inner = flat.layers[4].offset[2] - flat.layers[3].offset[2];
    const double outer = flat.layers[5].offset[2] - flat.layers[4].offset[2];
    EXPECT_NEAR(outer / inner, 1.5, 1e-13);
    request.round = true;
    const Layers<4> round = requested_layers<4>(request, {2, 1, 0.1});
    ASSERT_EQ(round.layers.size(), 7U);
    EXPECT_TRUE(round.layers.front().is_point() && round.layers.back().is_point());
    // Angles from the widest layer, of radius 1: 1.5 times as far apart.
    const auto angle = [&](int l) { return std::asin(round.layers[l].offset[3]); };
    EXPECT_NEAR((angle(5) - angle(4)) / (angle(4) - angle(3)), 1.5, 1e-13);
}

TEST(MakeBody, SaysHowThinAndThickItsLayersAre) {
    BodyRequest request;
    request.input = BallShape{2, 1};
    request.extrusion.thickness = 2;
    request.extrusion.grade = 1.25;
    const Body<4> body = make_body(request);
    EXPECT_TRUE(body.report.proof.holds());
    EXPECT_GT(body.report.highest_layer, body.report.lowest_layer * 1.2);
    // Layers are counted so that the lowest has the best height, rounded to whole ones.
    EXPECT_NEAR(body.report.lowest_layer, 0.7 * body.report.base_edge, 0.3 * body.report.base_edge);
    request.extrusion.grade = 0.5;
    test::expect_contains(test::error_of([&] { static_cast<void>(make_body(request)); }),
                          {"a grade of 0.5"});
}

}  // namespace
}  // namespace pent::mesher
