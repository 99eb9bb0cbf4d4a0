#include "model/rotation.h"
#include "support/kuhn_box.h"

#include <pent/simulator/rigid_fit.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pent::simulator {
namespace {

template <int Dim>
SimplexMesh<Dim> box() {
    std::array<int, Dim> count{};
    std::array<double, Dim> size{};
    for (int axis = 0; axis < Dim; ++axis) {
        count[static_cast<std::size_t>(axis)] = 2;
        size[static_cast<std::size_t>(axis)] = 1 + axis;
    }
    return pent::test::kuhn_box<Dim>(count, size);
}

Eigen::VectorXd uneven_masses(Eigen::Index count) {
    return Eigen::VectorXd::LinSpaced(count, 1, 3);
}

TEST(NonRigid, IsZeroForRotationsInAllPlanesAndTranslations) {
    const Positions<4> start = box<4>().positions;
    const Eigen::VectorXd masses = uneven_masses(start.cols());
    const Matrix<4> turn = plane_rotation<4>({0, 3}, 1.1) * plane_rotation<4>({1, 2}, -2.5)
                           * plane_rotation<4>({2, 3}, 3.1);
    const Positions<4> now = (turn * start).colwise() + Vector<4>(5, -2, 1, 0.5);
    EXPECT_LT(non_rigid<4>(start, now, masses), 1e-14);
}

// Scaling by 1.1 about the centroid: every point is off by 0.1 of its distance from there.
TEST(NonRigid, IsTheExcessOfAUniformScaling) {
    const Positions<3> start = box<3>().positions;
    const Eigen::VectorXd masses = uneven_masses(start.cols());
    const Positions<3> now = plane_rotation<3>({0, 2}, 0.7) * (1.1 * start);
    EXPECT_NEAR(non_rigid<3>(start, now, masses), 0.1, 1e-13);
}

TEST(NonRigid, DoesNotTakeAReflectionForARotation) {
    const Positions<4> start = box<4>().positions;
    Positions<4> now = start;
    now.row(3) *= -1;
    EXPECT_GT(non_rigid<4>(start, now, Eigen::VectorXd::Ones(start.cols())), 0.1);
}

// Determinants are 1 but for rounding, on either side of it.
template <int Dim>
void expect_that_no_rotation_shows() {
    std::mt19937 random(8);
    std::normal_distribution<double> normal;
    const Positions<Dim> start = box<Dim>().positions;
    const Eigen::VectorXd masses = uneven_masses(start.cols());
    Positions<Dim> mirrored = start;
    mirrored.row(0) *= -1;
    for (int round = 0; round < 100; ++round) {
        const Matrix<Dim> any = Matrix<Dim>::NullaryExpr([&] { return normal(random); });
        Matrix<Dim> turn = Eigen::HouseholderQR<Matrix<Dim>>(any).householderQ();
        if (turn.determinant() < 0) {
            turn.col(0) *= -1;
        }
        EXPECT_LT(non_rigid<Dim>(start, turn * start, masses), 1e-13);
        EXPECT_GT(non_rigid<Dim>(mirrored, turn * start, masses), 0.1);
    }
}

TEST(NonRigid, IsZeroForRotationsDrawnAtRandomAndNotForTheirMirrorImages) {
    expect_that_no_rotation_shows<3>();
    expect_that_no_rotation_shows<4>();
}

}  // namespace
}  // namespace pent::simulator
