#include "pent/viewer/camera.h"

#include "framing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace pent::viewer {
namespace {

// Where a point is in the picture: -1..1 from left to right and from bottom to top.
Eigen::Vector2d place_in_picture(const Camera& camera,
                                 double aspect,
                                 const Eigen::Vector3d& point) {
    const Eigen::Vector3d q = camera_frame(camera).transpose() * (point - camera.position);
    const double slope = std::tan(camera.field_of_view / 2);
    return {q.x() / (-q.z() * slope * aspect), q.y() / (-q.z() * slope)};
}

TEST(CameraFit, SeesAllPointsAndTouchesTheMargin) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    const ViewOptions view;
    for (int repeat = 0; repeat < 20; ++repeat) {
        CameraFit fit(16.0 / 9, view);
        Positions<3> points(3, 40);
        for (double& x : points.reshaped()) {
            x = 100 + coordinate(random);
        }
        points.row(repeat % 3) *= 1.1;
        fit.add(points);
        const Camera camera = fit.camera();
        double reach = 0;
        for (const auto& point : points.colwise()) {
            reach =
                std::max(reach, place_in_picture(camera, 16.0 / 9, point).cwiseAbs().maxCoeff());
        }
        EXPECT_NEAR(reach, 1 - 2 * view.margin, 1e-9);
    }
}

TEST(CameraFit, LeavesTheLegendItsShareAtTheBottomAlone) {
    const ViewOptions view;
    constexpr double kLegend = 0.3;
    CameraFit fit(1, view, kLegend);
    const Positions<3> points = Positions<3>::Identity(3, 3) * 2;
    fit.add(points);
    double top = -1;
    double bottom = 1;
    for (const auto& point : points.colwise()) {
        const Eigen::Vector2d place = place_in_picture(fit.camera(), 1, point);
        top = std::max(top, place.y());
        bottom = std::min(bottom, place.y());
        EXPECT_LE(std::abs(place.x()), 1 - 2 * view.margin + 1e-9);
    }
    // Room between the margin above and the legend below is shared or used up.
    const double above = 1 - 2 * view.margin - top;
    const double below = bottom + 1 - 2 * kLegend;
    EXPECT_GE(above, -1e-9);
    EXPECT_GE(below, -1e-9);
}

TEST(CameraFit, LooksFromTheDirectionAskedFor) {
    CameraFit fit(1, {.azimuth = 90, .elevation = 0});
    fit.add(Positions<3>::Identity(3, 3));
    const Camera camera = fit.camera();
    const Eigen::Vector3d back = (camera.position - camera.target).normalized();
    EXPECT_NEAR((back - Eigen::Vector3d::UnitX()).norm(), 0, 1e-12);
}

TEST(CameraFit, WorksForNoPointAndForOne) {
    CameraFit fit(1, {});
    EXPECT_GT((fit.camera().position - fit.camera().target).norm(), 0.1);
    fit.add(Eigen::Vector3d(5, 6, 7));
    EXPECT_NEAR((fit.camera().position - Eigen::Vector3d(5, 6, 7)).norm(), 1, 1e-12);
    CameraFit far(1, {});
    far.add(Eigen::Vector3d(5e19, 6e19, 7e19));
    const Eigen::Vector3d away = far.camera().position - far.camera().target;
    EXPECT_GT(away.dot(camera_frame(far.camera()).col(2)), 0);
}

// Of what is far from the origin, rounding is all that remains of differences: 1e-16 of the place.
TEST(CameraFit, ScalesWithThePoints) {
    const Positions<3> points = Positions<3>::Identity(3, 3);
    CameraFit fit(1.5, {});
    fit.add(points);
    const Eigen::Vector3d position = fit.camera().position;
    for (const double scale : {1e-200, 1e-12, 1e19, 1e200}) {
        CameraFit other(1.5, {});
        other.add(scale * points);
        EXPECT_NEAR((other.camera().position / scale - position).norm(), 0, 1e-12) << scale;
    }
}

TEST(Framing, SeesWhatIsRoundWhereItIsNoLargerThanTheBodiesReach) {
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto points = [&](int count) {
        return Positions<3>(Positions<3>::NullaryExpr(3, count, [&] { return number(engine); }));
    };
    const CameraFit tile(1.5, {});
    const CameraFit sheet(1, {.azimuth = -50});
    for (int repeat = 0; repeat < 50; ++repeat) {
        Framing framing(tile, sheet);
        CameraFit expected_tile = tile;
        CameraFit expected_sheet = sheet;
        const Positions<3> body = points(20);
        framing.add(body);
        expected_tile.add(body);
        expected_sheet.add(body);
        Eigen::AlignedBox3d box(body.rowwise().minCoeff(), body.rowwise().maxCoeff());
        const double reach = box.diagonal().norm();
        for (int round = 0; round < 30; ++round) {
            // Some of one radius, and some at the very limit.
            const double radius = round % 5 == 0 ? reach : round % 3 == 0 ? 1 : 9 * number(engine);
            const Positions<3> around = 5 * points(7);
            framing.add_round(around, radius);
            if (radius <= reach) {
                expected_tile.add(around);
                expected_sheet.add(around);
                box.extend(around.rowwise().minCoeff()).extend(around.rowwise().maxCoeff());
            }
        }
        framing.settle();
        EXPECT_EQ(framing.reach(), reach);
        EXPECT_TRUE(framing.box().isApprox(box, 0));
        EXPECT_EQ(framing.tile_camera().position, expected_tile.camera().position);
        EXPECT_EQ(framing.tile_camera().target, expected_tile.camera().target);
        EXPECT_EQ(framing.sheet_camera().position, expected_sheet.camera().position);
        EXPECT_EQ(framing.sheet_camera().target, expected_sheet.camera().target);
    }
}

}  // namespace
}  // namespace pent::viewer
