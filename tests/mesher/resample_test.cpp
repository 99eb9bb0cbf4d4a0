#include "shapes.h"

#include <pent/error.h>
#include <pent/mesher/resample.h>
#include <pent/mesher/surface_check.h>

#include <gtest/gtest.h>

namespace pent::mesher {
namespace {

TEST(Resample, RefinesToTheExactNumberWithoutChangingTheShape) {
    const Surface box = test::box_surface({0, 0, 0}, {1, 2, 3});
    for (const std::int64_t triangles : {12, 14, 20, 500, 1001}) {
        const Surface fine = resample(box, triangles);
        EXPECT_EQ(fine.triangle_count(), triangles - triangles % 2);
        EXPECT_TRUE(check_surface(fine).is_clean());
        EXPECT_NEAR(enclosed_volume(fine), 6, 1e-12);  // rounding of 1000 terms
        EXPECT_NEAR(area(fine), 22, 1e-12);
        EXPECT_EQ(fine.points.leftCols<8>(), box.points);
    }
}

TEST(Resample, LeavesNoLongEdgeBehind) {
    // 12 x 4^k triangles of a cube: bisection has then halved every edge k times over.
    const Surface fine = resample(test::box_surface({0, 0, 0}, {1, 1, 1}), 12 * 64);
    double longest = 0;
    for (const auto& t : fine.triangles.colwise()) {
        longest = std::max(longest, (fine.points.col(t[0]) - fine.points.col(t[1])).norm());
    }
    EXPECT_LE(longest, std::sqrt(2.0) / 8 + 1e-12);
}

TEST(Resample, CoarsensAndStaysClean) {
    const Surface octopus = read_surface(std::string(PENT_MODELS) + "/octopus_5246f.obj").surface;
    const Surface coarse = resample(octopus, 2000);
    EXPECT_LE(coarse.triangle_count(), 2000);
    EXPECT_GE(coarse.triangle_count(), 1990);
    EXPECT_TRUE(check_surface(coarse).is_clean());
    // Lindstrom and Turk preserve the volume of each step up to rounding.
    EXPECT_NEAR(enclosed_volume(coarse) / enclosed_volume(octopus), 1, 0.01);
}

TEST(Resample, RefusesWhatCannotBe) {
    EXPECT_THROW(static_cast<void>(resample(test::box_surface({0, 0, 0}, {1, 1, 1}), 3)), Error);
}

}  // namespace
}  // namespace pent::mesher
