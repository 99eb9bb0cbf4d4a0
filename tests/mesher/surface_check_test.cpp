#include "shapes.h"

#include <pent/mesher/surface_check.h>

#include <gtest/gtest.h>

#include <random>

namespace pent::mesher {
namespace {

SurfaceReport check_model(const std::string& name) {
    return check_surface(read_surface(std::string(PENT_MODELS) + "/" + name).surface);
}

TEST(SurfaceCheck, FindsNothingWrongWithCleanModels) {
    for (const char* name : {"octopus_5246f.obj", "alien_4006f.obj", "dirty/d_cube.off"}) {
        const SurfaceReport report = check_model(name);
        EXPECT_TRUE(report.is_clean()) << name << ": " << describe(report);
        EXPECT_EQ(report.misoriented_edges.count, 0);
        EXPECT_EQ(report.components, 1);
    }
    EXPECT_EQ(describe(check_model("dirty/d_cube.off")),
              "closed, manifold, free of self-intersections");
}

TEST(SurfaceCheck, CountsTheFaultsOfEachDirtyModel) {
    // The models are cubes of 12 triangles with one fault each; the counts follow by hand.
    EXPECT_EQ(check_model("dirty/d_open.off").border_edges.count, 3);
    EXPECT_EQ(check_model("dirty/d_flipped.off").misoriented_edges.count, 3);
    EXPECT_EQ(check_model("dirty/d_degenerate.off").degenerate.count, 1);
    EXPECT_EQ(check_model("dirty/d_degenerate.off").degenerate.first_triangle, 12);
    EXPECT_EQ(check_model("dirty/d_dupface.off").duplicate.count, 1);
    EXPECT_EQ(check_model("dirty/d_dupface.off").non_manifold_edges.count, 3);
    EXPECT_EQ(check_model("dirty/d_sharevertex.off").non_manifold_points.count, 1);
    EXPECT_EQ(check_model("dirty/d_sharevertex.off").non_manifold_points.place,
              Eigen::Vector3d(1, 1, 1));
    EXPECT_EQ(check_model("dirty/d_shareface.off").non_manifold_edges.count, 5);
    EXPECT_GT(check_model("dirty/d_twocubes_overlap.off").self_intersections.count, 0);
    EXPECT_TRUE(check_model("dirty/d_nested.off").is_clean());
    EXPECT_EQ(check_model("dirty/d_nested.off").components, 2);
    EXPECT_TRUE(check_model("dirty/d_bigsmall.off").is_clean());
    EXPECT_TRUE(check_model("dirty/d_flipped.off").is_clean());
}

TEST(SurfaceCheck, SaysWhatHowManyAndWhere) {
    EXPECT_EQ(describe(check_model("dirty/d_open.off")),
              "3 border edges (first at triangle 2, near (0, 0, 1))");
}

TEST(SurfaceCheck, CountsBordersOfASingleTriangle) {
    Surface surface = test::box_surface({0, 0, 0}, {1, 1, 1});
    surface.triangles = surface.triangles.leftCols<1>().eval();
    EXPECT_EQ(check_surface(surface).border_edges.count, 3);
}

TEST(SelfIntersections, LeaveOutNeighborsAndFindTouching) {
    const Surface a = test::box_surface({0, 0, 0}, {1, 1, 1});
    EXPECT_TRUE(self_intersections(a).empty());
    // Apart by one unit in the last place: not touching. Sharing a plane: touching.
    const double above = std::nextafter(1.0, 2.0);
    EXPECT_TRUE(
        self_intersections(test::join(a, test::box_surface({0, 0, above}, {1, 1, 2}))).empty());
    EXPECT_FALSE(
        self_intersections(test::join(a, test::box_surface({0.25, 0.25, 1}, {0.5, 0.5, 2})))
            .empty());
}

TEST(SelfIntersections, FindAFlatFold) {
    Surface surface;
    surface.points.resize(3, 4);
    surface.points << 0, 1, 0, 0.25, 0, 0, 1, 0.5, 0, 0, 0, 0;
    surface.triangles.resize(3, 2);
    surface.triangles << 0, 1, 1, 0, 2, 3;
    EXPECT_EQ(self_intersections(surface).size(), 1U);  // both lie on the same side of edge 0 1
    surface.points(1, 3) = -0.5;
    EXPECT_TRUE(self_intersections(surface).empty());
}

// An independent oracle in exact integer arithmetic. Two triangles that share no plane meet if and
// only if an edge of one meets the other.
using Point = std::array<std::int64_t, 3>;

std::int64_t orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
    const auto at = [&a](const Point& p, int i) { return p[i] - a[i]; };
    return at(b, 0) * (at(c, 1) * at(d, 2) - at(c, 2) * at(d, 1))
           - at(b, 1) * (at(c, 0) * at(d, 2) - at(c, 2) * at(d, 0))
           + at(b, 2) * (at(c, 0) * at(d, 1) - at(c, 1) * at(d, 0));
}

bool segment_meets(const Point& p, const Point& q, const std::array<Point, 3>& t) {
    const std::int64_t above = orientation(t[0], t[1], t[2], p);
    const std::int64_t below = orientation(t[0], t[1], t[2], q);
    if ((above > 0 && below > 0) || (above < 0 && below < 0)) {
        return false;
    }
    std::int64_t lowest = 1;
    std::int64_t highest = -1;
    for (int i = 0; i < 3; ++i) {
        const std::int64_t side = orientation(p, q, t[i], t[(i + 1) % 3]);
        lowest = std::min(lowest, side);
        highest = std::max(highest, side);
    }
    return lowest >= 0 || highest <= 0;
}

TEST(SelfIntersections, AgreeWithExactBruteForce) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> coordinate(0, 20);
    constexpr int kTriangles = 60;
    std::vector<std::array<Point, 3>> triangles(kTriangles);
    Surface surface;
    surface.points.resize(3, 3 * kTriangles);
    surface.triangles.resize(3, kTriangles);
    for (int t = 0; t < kTriangles; ++t) {
        for (int i = 0; i < 3; ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                triangles[t][i][axis] = coordinate(random);
                surface.points(axis, 3 * t + i) = static_cast<double>(triangles[t][i][axis]);
            }
            surface.triangles(i, t) = 3 * t + i;
        }
    }
    std::vector<std::array<std::uint32_t, 2>> expected;
    for (std::uint32_t a = 0; a < kTriangles; ++a) {
        for (std::uint32_t b = a + 1; b < kTriangles; ++b) {
            const auto& s = triangles[a];
            const auto& t = triangles[b];
            // The oracle does not hold within one plane.
            ASSERT_FALSE(orientation(s[0], s[1], s[2], t[0]) == 0
                         && orientation(s[0], s[1], s[2], t[1]) == 0
                         && orientation(s[0], s[1], s[2], t[2]) == 0);
            bool do_meet = false;
            for (int i = 0; i < 3; ++i) {
                do_meet = do_meet || segment_meets(s[i], s[(i + 1) % 3], t)
                          || segment_meets(t[i], t[(i + 1) % 3], s);
            }
            if (do_meet) {
                expected.push_back({a, b});
            }
        }
    }
    EXPECT_GT(expected.size(), 50U);
    EXPECT_EQ(self_intersections(surface), expected);
}

}  // namespace
}  // namespace pent::mesher
