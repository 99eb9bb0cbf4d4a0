#include "pent/viewer/hyperplane.h"

#include <pent/error.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace pent::viewer {
namespace {

// A product of a few rotations is a rotation to a few units in the last place.
constexpr double kRounding = 1e-14;

void expect_rotation(const Eigen::Matrix4d& frame) {
    EXPECT_NEAR((frame * frame.transpose() - Eigen::Matrix4d::Identity()).norm(), 0, kRounding);
    EXPECT_NEAR(frame.determinant(), 1, kRounding);
}

TEST(RotationMatrix, TakesTheFirstAxisTowardsTheSecond) {
    const PlaneRotation quarter{0, 3, std::numbers::pi / 2};
    const Eigen::Vector4d turned = rotation_matrix({&quarter, 1}) * Eigen::Vector4d::UnitX();
    EXPECT_NEAR((turned - Eigen::Vector4d::UnitW()).norm(), 0, kRounding);
}

TEST(RotationMatrix, OfReversedPlaneIsTheInverse) {
    const PlaneRotation forth{1, 2, 0.7};
    const PlaneRotation back{2, 1, 0.7};
    const PlaneRotation both[] = {forth, back};
    EXPECT_NEAR((rotation_matrix(both) - Eigen::Matrix4d::Identity()).norm(), 0, kRounding);
}

TEST(RotationMatrix, AppliesListsInTheOrderWritten) {
    // x to y, then y to z: x ends at z.
    const double quarter = std::numbers::pi / 2;
    const PlaneRotation list[] = {{0, 1, quarter}, {1, 2, quarter}};
    const Eigen::Vector4d turned = rotation_matrix(list) * Eigen::Vector4d::UnitX();
    EXPECT_NEAR((turned - Eigen::Vector4d::UnitZ()).norm(), 0, kRounding);
}

TEST(Hyperplane, AtPlainOffsetKeepsTheAxesToTheBit) {
    EXPECT_EQ(hyperplane_at(0.25).frame, Eigen::Matrix4d::Identity());
    EXPECT_EQ(hyperplane_across({0, 0, 0, 2}, 0.25).frame, Eigen::Matrix4d::Identity());
}

TEST(Hyperplane, AcrossAnyNormalHasARightHandedFrameEndingInIt) {
    std::mt19937 random(1);
    std::normal_distribution<double> coordinate;
    for (int i = 0; i < 100; ++i) {
        const Eigen::Vector4d normal(coordinate(random), coordinate(random), coordinate(random),
                                     coordinate(random));
        const FramedHyperplane plane = hyperplane_across(normal, 0.5);
        expect_rotation(plane.frame);
        EXPECT_NEAR((plane.frame.row(3).transpose() - normal.normalized()).norm(), 0, kRounding);
    }
}

TEST(Hyperplane, AcrossNormalsNearMinusWIsStillARotation) {
    for (const double tilt : {0.0, 1e-300, 1e-16, 1e-8, 1e-3}) {
        const Eigen::Vector4d normal(tilt, -tilt, tilt / 2, -1);
        const FramedHyperplane plane = hyperplane_across(normal, 0);
        expect_rotation(plane.frame);
        EXPECT_NEAR((plane.frame.row(3).transpose() - normal.normalized()).norm(), 0, kRounding);
    }
}

TEST(Hyperplane, AcrossHugeAndTinyNormalsNeitherOverflowsNorVanishes) {
    EXPECT_EQ(hyperplane_across({0, 0, 0, 1e300}, 1).frame, Eigen::Matrix4d::Identity());
    EXPECT_EQ(hyperplane_across({0, 0, 0, 1e-300}, 1).frame, Eigen::Matrix4d::Identity());
}

TEST(Hyperplane, RefusesANormalThatHasNoDirection) {
    EXPECT_THROW((void)hyperplane_across(Eigen::Vector4d::Zero(), 0), Error);
    EXPECT_THROW((void)hyperplane_across(Eigen::Vector4d::Constant(std::nan("")), 0), Error);
}

}  // namespace
}  // namespace pent::viewer
