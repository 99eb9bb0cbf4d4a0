// Surfaces as users bring them, each made to break one stage: what comes out is a proven body of
// about the right volume, or a refusal that says why.

#include "shapes.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/mesher/make_body.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

namespace pent::mesher {
namespace {

BodyReport body_of(const Surface& surface) {
    const test::TempFolder folder;
    std::ofstream file(folder / "dirty.obj");
    file.precision(17);
    for (const auto& p : surface.points.colwise()) {
        file << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    }
    for (const auto& t : surface.triangles.colwise()) {
        file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    }
    file.close();
    BodyRequest request;
    request.input = folder / "dirty.obj";
    request.tetrahedra.worker = PENT_TETGEN_WORKER;
    request.repair.wrap_distance = 0.04;  // a coarse wrap is a quick one
    request.extrusion.layers = 1;
    const Body<4> body = make_body(request);
    EXPECT_TRUE(body.report.proof.holds());
    return body.report;
}

Surface cube(const Eigen::Vector3d& low, double edge = 1) {
    return test::box_surface(low, low.array() + edge);
}

void add_triangle(Surface& surface, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    surface.triangles.conservativeResize(3, surface.triangle_count() + 1);
    surface.triangles.col(surface.triangle_count() - 1) << a, b, c;
}

void add_point(Surface& surface, const Eigen::Vector3d& point) {
    surface.points.conservativeResize(3, surface.point_count() + 1);
    surface.points.col(surface.point_count() - 1) = point;
}

// A band around z, radius 1: closed after `turns` half turns. Even: open tube; odd: Moebius band.
Surface band(int turns) {
    constexpr std::uint32_t kSteps = 48;
    Surface surface;
    surface.points.resize(3, 0);
    surface.triangles.resize(3, 0);
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSteps;
        const double tilt = turns * angle / 2;
        for (const double side : {-0.4, 0.4}) {
            const double radius = 1 + side * std::sin(tilt);
            add_point(surface,
                      {radius * std::cos(angle), radius * std::sin(angle), side * std::cos(tilt)});
        }
    }
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const bool is_crossed = i + 1 == kSteps && turns % 2 == 1;
        const std::uint32_t next = 2 * ((i + 1) % kSteps);
        const std::uint32_t low = next + (is_crossed ? 1 : 0);
        const std::uint32_t high = next + (is_crossed ? 0 : 1);
        add_triangle(surface, 2 * i, low, high);
        add_triangle(surface, 2 * i, high, 2 * i + 1);
    }
    return surface;
}

TEST(DirtyShapes, MoebiusBandIsCutAndItsHolesFilled) {
    const BodyReport report = body_of(band(1));
    EXPECT_GT(report.surface_read.border_edges.count, 0);
    EXPECT_EQ(report.repair, Repair::Light);
    EXPECT_GT(report.base_volume, 0);
}

TEST(DirtyShapes, OpenTubeIsClosedAtBothEnds) {
    const BodyReport report = body_of(band(0));
    EXPECT_EQ(report.repair, Repair::Light);
    // A prism of height 0.8 over the regular polygon of 48 corners.
    EXPECT_NEAR(report.base_volume, 0.8 * 24 * std::sin(std::numbers::pi / 24), 1e-12);
}

TEST(DirtyShapes, InnerBoxIsACavityWhicheverWayItTurns) {
    Surface inner = cube({1, 1, 1});
    for (int turn = 0; turn < 2; ++turn) {
        const BodyReport report = body_of(test::join(cube({0, 0, 0}, 3), inner));
        EXPECT_EQ(report.cavities, 1);
        EXPECT_NEAR(report.base_volume, 26, 1e-12);
        inner.triangles.row(0).swap(inner.triangles.row(1));
    }
}

TEST(DirtyShapes, CubesWithACommonEdgeAreJoined) {
    const BodyReport report = body_of(test::join(cube({0, 0, 0}), cube({1, 1, 0})));
    EXPECT_EQ(report.repair, Repair::Wrap);
    EXPECT_EQ(report.components, 1);
    EXPECT_GT(report.base_volume, 2);
}

TEST(DirtyShapes, ManyBoxesThroughEachOtherBecomeOneBody) {
    // A staircase: each step shares an eighth with the next.
    Surface stairs = cube({0, 0, 0});
    for (int i = 1; i < 12; ++i) {
        stairs = test::join(stairs, cube(Eigen::Vector3d::Constant(0.5 * i)));
    }
    const BodyReport report = body_of(stairs);
    EXPECT_EQ(report.repair, Repair::Light);
    EXPECT_EQ(report.components, 1);
    EXPECT_NEAR(report.base_volume, 12 - 11 * 0.125, 1e-9);
}

TEST(DirtyShapes, HundredsOfComponentsAreAllFilled) {
    Surface boxes = cube({0, 0, 0});
    for (int i = 1; i < 300; ++i) {
        boxes = test::join(boxes, cube({2.0 * (i % 20), 2.0 * (i / 20), 0}));
    }
    const BodyReport report = body_of(boxes);
    EXPECT_EQ(report.components, 300);
    EXPECT_NEAR(report.base_volume, 300, 1e-9);
}

TEST(DirtyShapes, TJunctionIsMended) {
    // The middle of an edge is a corner for the triangle on one side of it alone.
    Surface box = cube({0, 0, 0});
    add_point(box, {0.5, 0, 0});
    box.triangles.col(4) << 0, 8, 5;  // was 0 1 5
    add_triangle(box, 8, 1, 5);
    EXPECT_NEAR(body_of(box).base_volume, 1, 0.2);
}

TEST(DirtyShapes, PointAHairAboveASideIsNoObstacle) {
    Surface box = cube({0, 0, 0});
    add_point(box, {0.5, 0.5, 1e-13});  // on the diagonal of the lower side, a little inside
    box.triangles.col(0) << 0, 2, 8;    // was 0 2 3
    add_triangle(box, 2, 3, 8);
    add_triangle(box, 3, 0, 8);
    EXPECT_NEAR(body_of(box).base_volume, 1, 0.2);
}

TEST(DirtyShapes, FarAndSmallAndLargeBodiesAreFilled) {
    // Coordinates up to 2^40 with unit steps are exact.
    EXPECT_NEAR(body_of(cube(Eigen::Vector3d::Constant(std::ldexp(1.0, 40)))).base_volume, 1, 1e-9);
    EXPECT_NEAR(body_of(cube({0, 0, 0}, 1e-12)).base_volume * 1e36, 1, 1e-9);
    EXPECT_NEAR(body_of(cube({0, 0, 0}, 1e12)).base_volume * 1e-36, 1, 1e-9);
}

TEST(DirtyShapes, WhatHasNoInsideIsRefused) {
    Surface triangle;
    triangle.points = Eigen::Matrix3d::Identity();
    triangle.triangles.resize(3, 0);
    add_triangle(triangle, 0, 1, 2);
    test::expect_contains(test::error_of([&] { static_cast<void>(body_of(triangle)); }),
                          {"dirty.obj", "in a plane"});
    Surface broken = cube({0, 0, 0});
    broken.points(1, 3) = std::nan("");
    test::expect_contains(test::error_of([&] { static_cast<void>(body_of(broken)); }),
                          {"dirty.obj", "line 4", "nan"});
}

}  // namespace
}  // namespace pent::mesher
