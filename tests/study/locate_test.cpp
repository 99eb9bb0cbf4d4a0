#include "locate.h"

#include "support/kuhn_box.h"

#include <gtest/gtest.h>

namespace pent::study {
namespace {

// Any linear field is found again at the vertices of a mesh with other cells.
template <int Dim>
void expect_linear_fields(const std::array<int, Dim>& coarse, const std::array<int, Dim>& fine) {
    std::array<double, Dim> size{};
    size.fill(0.7);
    size[0] = 2;
    const SimplexMesh<Dim> from = pent::test::kuhn_box<Dim>(coarse, size);
    const SimplexMesh<Dim> to = pent::test::kuhn_box<Dim>(fine, size);
    const Interpolation where = locate(to.positions, from.positions, from.cells);
    EXPECT_LT(where.farthest, 1e-9);
    const Eigen::MatrixXd map = Eigen::MatrixXd::Random(Dim, Dim);
    // Barycentric coordinates of a cell no flatter than 1:3, by a solve in double.
    EXPECT_LT((where(map * from.positions) - map * to.positions).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Locate, GivesLinearFieldsExactlyInThreeDimensions) {
    expect_linear_fields<3>({3, 2, 2}, {5, 3, 4});
}

TEST(Locate, GivesLinearFieldsExactlyInFourDimensions) {
    expect_linear_fields<4>({3, 2, 1, 2}, {4, 3, 2, 2});
}

TEST(Locate, SaysHowFarAPointLiesOutside) {
    const SimplexMesh<3> mesh = pent::test::kuhn_box<3>({1, 1, 1}, {1, 1, 1});
    const Eigen::Vector3d outside(0.5, 0.25, 3);  // two heights of a unit cell above
    EXPECT_NEAR(locate(outside, mesh.positions, mesh.cells).farthest, 2, 1e-9);
}

TEST(Interpolation, WithoutCornersIsTheIdentity) {
    const Eigen::MatrixXd values = Eigen::MatrixXd::Random(4, 7);
    EXPECT_EQ(Interpolation{}(values), values);
}

}  // namespace
}  // namespace pent::study
