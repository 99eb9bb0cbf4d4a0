#include "model/distance_field.h"

#include "support/kuhn_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pent::simulator {
namespace {

using pent::test::kuhn_box;

template <typename T>
class DistanceWithin : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(DistanceWithin, Dimensions);

template <int Dim>
std::array<int, Dim> counts(int count) {
    std::array<int, Dim> all{};
    all.fill(count);
    return all;
}

template <int Dim>
std::array<double, Dim> sides(double side) {
    std::array<double, Dim> all{};
    all.fill(side);
    return all;
}

template <int Dim, typename IsSource>
std::vector<std::uint32_t> vertices_where(const SimplexMesh<Dim>& mesh, const IsSource& is_source) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        if (is_source(mesh.positions.col(v))) {
            found.push_back(v);
        }
    }
    return found;
}

// A plane wave is what each update supposes: exact.
TYPED_TEST(DistanceWithin, FromAFaceOfABoxIsTheCoordinateAndItsGradientTheAxis) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> mesh = kuhn_box<kDim>(counts<kDim>(3), sides<kDim>(0.9));
    mesh.positions.row(1) *= 1.7;
    const Eigen::VectorXd distance = distance_within<kDim>(
        mesh, vertices_where(mesh, [](const auto& x) { return x[1] < 1e-9; }));
    EXPECT_LT((distance.transpose() - mesh.positions.row(1)).cwiseAbs().maxCoeff(), 1e-13);
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        const Eigen::Matrix<double, kDim, 1> up = Eigen::Matrix<double, kDim, 1>::Unit(1);
        EXPECT_LT((gradient_in_cell(mesh, cell, distance) - up).norm(), 1e-12);
    }
}

// Ways from a corner of a box are straight lines, which a mesh makes longer, never shorter; less so
// the finer it is, and no longer than the way along its edges, which lead along every diagonal:
// with the coordinates in decreasing order, (a - b) + (b - c) sqrt(2) + c sqrt(3) in three
// dimensions.
TYPED_TEST(DistanceWithin, FromACornerIsNoShorterThanALineAndConvergesToIt) {
    constexpr int kDim = TypeParam::value;
    const auto largest_error = [](int count) {
        const SimplexMesh<kDim> mesh = kuhn_box<kDim>(counts<kDim>(count), sides<kDim>(1));
        const Eigen::VectorXd distance = distance_within<kDim>(mesh, {0});
        const Eigen::VectorXd line =
            (mesh.positions.colwise() - mesh.positions.col(0)).colwise().norm();
        EXPECT_GT((distance - line).minCoeff(), -1e-12);
        for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
            Eigen::Matrix<double, kDim, 1> x = mesh.positions.col(v);
            std::sort(x.begin(), x.end());
            double along_edges = 0;
            for (int axis = 0; axis < kDim; ++axis) {
                const double rise = x[axis] - (axis > 0 ? x[axis - 1] : 0);
                along_edges += rise * std::sqrt(kDim - axis);
            }
            EXPECT_LT(distance[v], along_edges + 1e-12);
        }
        return (distance - line).maxCoeff();
    };
    EXPECT_LT(largest_error(6), largest_error(3));
}

// Around a corner of an L the shortest way is that along its inner edges.
TYPED_TEST(DistanceWithin, GoesAroundWhatIsNotOfTheBody) {
    constexpr int kDim = TypeParam::value;
    std::array<int, kDim> count = counts<kDim>(1);
    std::array<double, kDim> side = sides<kDim>(1);
    count[0] = count[1] = 6;
    side[0] = side[1] = 6;
    SimplexMesh<kDim> mesh = kuhn_box<kDim>(count, side);
    Simplices<kDim + 1> kept(kDim + 1, 0);
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        Eigen::Matrix<double, kDim, 1> center = Eigen::Matrix<double, kDim, 1>::Zero();
        for (const std::uint32_t v : mesh.cells.col(cell)) {
            center += mesh.positions.col(v) / (kDim + 1);
        }
        if (center[0] < 1 || center[1] < 1) {
            kept.conservativeResize(Eigen::NoChange, kept.cols() + 1);
            kept.rightCols(1) = mesh.cells.col(cell);
        }
    }
    mesh.cells = kept;
    const auto at = [&](double x, double y) {
        return vertices_where(mesh, [&](const auto& p) {
            return std::abs(p[0] - x) < 1e-9 && std::abs(p[1] - y) < 1e-9;
        });
    };
    const Eigen::VectorXd distance = distance_within<kDim>(mesh, at(6, 1));
    for (const std::uint32_t v : at(1, 6)) {
        EXPECT_NEAR(distance[v], 10, 1e-9);  // 5 to the inner corner, 5 from there
    }
    for (const std::uint32_t v : at(6, 6)) {
        EXPECT_EQ(distance[v], std::numeric_limits<double>::infinity());  // of no cell
    }
}

}  // namespace
}  // namespace pent::simulator
