#include "shapes.h"
#include "support/messages.h"

#include <pent/error.h>
#include <pent/mesher/resample.h>
#include <pent/mesher/surface_check.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pent::mesher {
namespace {

// A torus of n x n squares, each cut in two.
Surface torus(int n) {
    Surface surface;
    surface.points.resize(3, n * n);
    surface.triangles.resize(3, 2 * n * n);
    const double step = 2 * std::numbers::pi / n;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const double rho = 3 + std::cos(step * j);
            surface.points.col(i * n + j) << rho * std::cos(step * i), rho * std::sin(step * i),
                std::sin(step * j);
            const auto at = [&](int a, int b) {
                return static_cast<std::uint32_t>(a % n * n + b % n);
            };
            surface.triangles.col(2 * (i * n + j)) << at(i, j), at(i + 1, j), at(i + 1, j + 1);
            surface.triangles.col(2 * (i * n + j) + 1) << at(i, j), at(i + 1, j + 1), at(i, j + 1);
        }
    }
    return surface;
}

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
    // No torus has fewer than 14 triangles.
    test::expect_contains(test::error_of([] { static_cast<void>(resample(torus(6), 8)); }),
                          {"cannot be brought from 72 to 8 triangles", "ask for more triangles"});
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    test::expect_contains(
        test::error_of([] { static_cast<void>(resample(torus(600), 700'000, {.memory_mib = 1})); }),
        {"cannot be brought from 720000 to 700000", "coarsening", "1 MiB of memory"});
#endif
    // At 1e16 coordinates are 2 apart: no point fits between the corners.
    const double far = 1e16;
    const Surface tiny = test::box_surface({far, far, far}, {far + 2, far + 2, far + 2});
    test::expect_contains(test::error_of([&] { static_cast<void>(resample(tiny, 100)); }),
                          {"cannot be refined to 100 triangles in double precision"});
}

}  // namespace
}  // namespace pent::mesher
