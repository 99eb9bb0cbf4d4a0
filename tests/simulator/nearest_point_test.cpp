#include "model/nearest_point.h"

#include "contact_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

namespace pent::simulator {
namespace {

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class NearestPoint : public testing::Test {};
TYPED_TEST_SUITE(NearestPoint, Dimensions);

template <int Dim>
Eigen::Matrix<double, Dim, Dim + 1> corners_of(const SimplexMesh<Dim>& mesh, Eigen::Index cell) {
    Eigen::Matrix<double, Dim, Dim + 1> corners;
    for (int i = 0; i <= Dim; ++i) {
        corners.col(i) = mesh.positions.col(mesh.cells(i, cell));
    }
    return corners;
}

template <int Dim>
MaterialPoint<Dim> nearest_point(const Positions<Dim>& positions,
                                 const Simplices<Dim + 1>& cells,
                                 const Vector<Dim>& point) {
    const NearestPointSearch<Dim> search(positions, cells);
    const std::optional<Eigen::Index> first = search.first_at(point, search.distance(point));
    EXPECT_TRUE(first);
    return search.nearest_in(first.value_or(0), point);
}

// q is the nearest point of a convex body to p just where no corner c has (p - q) . (c - q) > 0:
// of each cell alone, and of all of them the first cell counts that has none nearer but for
// rounding.
TYPED_TEST(NearestPoint, IsThatOfTheNearestCell) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> mesh = test::cube<kDim>(3);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shake(-0.03, 0.03);
    mesh.positions = mesh.positions.unaryExpr([&](double x) { return x + shake(random); }).eval();
    std::uniform_real_distribution<double> place(-0.15, 0.9);
    int inside = 0;
    for (int i = 0; i < 12; ++i) {
        const Vector<kDim> p = Vector<kDim>::NullaryExpr([&] { return place(random); });
        const MaterialPoint<kDim> nearest = nearest_point<kDim>(mesh.positions, mesh.cells, p);
        EXPECT_GE(nearest.weights.minCoeff(), 0);
        EXPECT_NEAR(nearest.weights.sum(), 1, 1e-14);
        Vector<kDim> q = Vector<kDim>::Zero();
        for (std::size_t k = 0; k <= kDim; ++k) {
            q += nearest.weights[static_cast<Eigen::Index>(k)]
                 * mesh.positions.col(nearest.vertices[k]);
        }
        EXPECT_NEAR((p - q).norm(), nearest.distance, 1e-14);
        inside += nearest.distance == 0 ? 1 : 0;
        std::vector<double> distances;
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            const Simplices<kDim + 1> alone = mesh.cells.col(cell);
            const MaterialPoint<kDim> of_cell = nearest_point<kDim>(mesh.positions, alone, p);
            distances.push_back(of_cell.distance);
            const auto corners = corners_of<kDim>(mesh, cell);
            const Vector<kDim> foot = corners * of_cell.weights;
            const auto along = (p - foot).transpose() * (corners.colwise() - foot);
            EXPECT_LE(along.maxCoeff(), 1e-13);
        }
        const double least = *std::min_element(distances.begin(), distances.end());
        EXPECT_NEAR(nearest.distance, least, 1e-14);
        const auto first = std::find_if(distances.begin(), distances.end(),
                                        [&](double x) { return x < least + 1e-12; })
                           - distances.begin();
        for (std::size_t k = 0; k <= kDim; ++k) {
            EXPECT_EQ(nearest.vertices[k], mesh.cells(static_cast<Eigen::Index>(k), first));
        }
    }
    EXPECT_GT(inside, 0);
    EXPECT_LT(inside, 12);
}

TYPED_TEST(NearestPoint, OfEqualOnesIsThatOfTheFirstCell) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = test::cube<kDim>(2);
    // The middle, a corner of many cells.
    const Vector<kDim> middle = Vector<kDim>::Constant(0.25);
    const MaterialPoint<kDim> nearest = nearest_point<kDim>(mesh.positions, mesh.cells, middle);
    EXPECT_EQ(nearest.distance, 0);
    Eigen::Index first = 0;
    while ((corners_of<kDim>(mesh, first).colwise() - middle).colwise().norm().minCoeff() > 0) {
        ++first;
    }
    for (std::size_t i = 0; i <= kDim; ++i) {
        EXPECT_EQ(nearest.vertices[i], mesh.cells(static_cast<Eigen::Index>(i), first));
    }
}

// Beyond ridges and corners, where cells meet: everything moved and turned a little is rounded in
// other ways each time.
TYPED_TEST(NearestPoint, IsOfTheSameCellHoweverNumbersAreRounded) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = test::cube<kDim>(2);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shift(-1, 1);
    for (int sides = 2; sides <= kDim; ++sides) {  // that the point is beyond
        Vector<kDim> point = Vector<kDim>::LinSpaced(0.11, 0.17);
        point.head(sides).setConstant(0.7);
        const auto expected = nearest_point<kDim>(mesh.positions, mesh.cells, point).vertices;
        for (int i = 0; i < 50; ++i) {
            const Vector<kDim> by = Vector<kDim>::NullaryExpr([&] { return shift(random); });
            const Matrix<kDim> turn = plane_rotation<kDim>({0, kDim - 1}, 100 * shift(random));
            const Positions<kDim> moved = (turn * mesh.positions).colwise() + by;
            const Vector<kDim> there = turn * point + by;
            EXPECT_EQ(nearest_point<kDim>(moved, mesh.cells, there).vertices, expected);
        }
    }
}

TYPED_TEST(NearestPoint, IsNoneWhereThereAreNoCellsOrAllAreFarther) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = test::cube<kDim>(1);
    const Vector<kDim> point = Vector<kDim>::Constant(1);
    const NearestPointSearch<kDim> none(mesh.positions, Simplices<kDim + 1>(kDim + 1, 0));
    EXPECT_TRUE(std::isinf(none.distance(point)));
    EXPECT_FALSE(none.first_at(point, 10));
    const NearestPointSearch<kDim> all(mesh.positions, mesh.cells);
    EXPECT_FALSE(all.first_at(point, 0.999 * all.distance(point)));
}

TYPED_TEST(NearestPoint, HasNoWeightAtCornersThatTheNearestFaceLacks) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = test::cube<kDim>(1);
    Vector<kDim> above = Vector<kDim>::Constant(0.1);
    above[1] = 0.35;  // 0.1 m above a side at 0.25 m
    const MaterialPoint<kDim> nearest = nearest_point<kDim>(mesh.positions, mesh.cells, above);
    EXPECT_NEAR(nearest.distance, 0.1, 1e-15);
    int zeros = 0;
    for (std::size_t i = 0; i <= kDim; ++i) {
        const double weight = nearest.weights[static_cast<Eigen::Index>(i)];
        zeros += weight == 0 ? 1 : 0;
        EXPECT_TRUE(weight == 0 || mesh.positions(1, nearest.vertices[i]) == 0.25);
    }
    EXPECT_GE(zeros, 1);
}

TYPED_TEST(NearestPoint, GoesOnBeyondTheFacesByBarycentricCoordinates) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = test::cube<kDim>(1);
    const auto corners = corners_of<kDim>(mesh, 3);
    const Vector<kDim> far = Vector<kDim>::LinSpaced(-0.3, 0.9);
    const auto weights = barycentric<kDim>(corners, far);
    EXPECT_NEAR(weights.sum(), 1, 1e-14);
    EXPECT_LT(weights.minCoeff(), 0);
    EXPECT_LT((corners * weights - far).norm(), 1e-14);
}

}  // namespace
}  // namespace pent::simulator
