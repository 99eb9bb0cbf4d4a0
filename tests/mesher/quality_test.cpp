#include "support/kuhn_box.h"

#include <pent/mesher/quality.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

namespace pent::mesher {
namespace {

template <int Dim>
using Corners = Eigen::Matrix<double, Dim, Dim + 1>;

template <typename Dimension>
class QualityInDimension : public testing::Test {};
template <int Dim>
using Constant = std::integral_constant<int, Dim>;
using Dimensions = testing::Types<Constant<2>, Constant<3>, Constant<4>>;
TYPED_TEST_SUITE(QualityInDimension, Dimensions);

// The unit vectors and the point a (1, ..., 1) at the same distance from each other.
template <int Dim>
Corners<Dim> regular() {
    Corners<Dim> corners;
    corners.template leftCols<Dim>().setIdentity();
    corners.col(Dim).setConstant((1 + std::sqrt(Dim + 1.0)) / Dim);
    if (simplex_volume<Dim>(corners) < 0) {
        corners.col(0).swap(corners.col(1));
    }
    return corners;
}

TYPED_TEST(QualityInDimension, IsOneForTheRegularSimplex) {
    constexpr int kDim = TypeParam::value;
    const CellQuality quality = measure_cell<kDim>(regular<kDim>());
    EXPECT_NEAR(quality.mean_ratio, 1, 1e-14);
    EXPECT_NEAR(quality.condition, 1, 1e-14);
    const double angle = std::acos(1.0 / kDim) * 180 / std::numbers::pi;
    EXPECT_NEAR(quality.smallest_angle, angle, 1e-12);
    EXPECT_NEAR(quality.largest_angle, angle, 1e-12);
}

TYPED_TEST(QualityInDimension, DependsOnTheShapeAlone) {
    constexpr int kDim = TypeParam::value;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    for (int round = 0; round < 20; ++round) {
        Corners<kDim> corners = Corners<kDim>::NullaryExpr([&] { return coordinate(random); });
        if (simplex_volume<kDim>(corners) < 0) {
            corners.col(0).swap(corners.col(1));
        }
        // Of dynamic size: decompositions are slow to compile, and one is enough for all
        // dimensions.
        const Eigen::MatrixXd any =
            Eigen::MatrixXd::NullaryExpr(kDim, kDim, [&] { return coordinate(random); });
        Eigen::MatrixXd Q = any.householderQr().householderQ();
        if (Q.determinant() < 0) {
            Q.col(0) = -Q.col(0);
        }
        Corners<kDim> moved = (3 * Eigen::Matrix<double, kDim, kDim>(Q) * corners).colwise()
                              + Q.col(0).template head<kDim>();
        // Three corners in turn: an even permutation.
        moved.col(0).swap(moved.col(1));
        moved.col(1).swap(moved.col(2));
        const CellQuality a = measure_cell<kDim>(corners);
        const CellQuality b = measure_cell<kDim>(moved);
        // Random cells have conditions up to about 100: some digits of 16 are lost.
        EXPECT_NEAR(a.mean_ratio, b.mean_ratio, 1e-12);
        EXPECT_NEAR(a.condition / b.condition, 1, 1e-10);
        EXPECT_NEAR(a.smallest_angle, b.smallest_angle, 1e-9);
        EXPECT_NEAR(a.largest_angle, b.largest_angle, 1e-9);
        EXPECT_LE(a.mean_ratio, 1);
        EXPECT_GE(a.condition, 1);
    }
}

TEST(MeasureCell, KnowsTheRightCornerOfASquare) {
    // Legs 1 and 1: c = 4 / sqrt(3) makes 1 for the equilateral triangle; mean squared edge 4 / 3.
    const CellQuality quality = measure_cell<2>((Corners<2>() << 0, 1, 0, 0, 0, 1).finished());
    EXPECT_NEAR(quality.mean_ratio, 4 / std::sqrt(3.0) * 0.5 / (4.0 / 3.0), 1e-15);
    EXPECT_NEAR(quality.smallest_angle, 45, 1e-12);
    EXPECT_NEAR(quality.largest_angle, 90, 1e-12);
    // S S^T = [1 -1/sqrt 3; 0 2/sqrt 3] squared: |S|^2 = 8/3, |S^-1|^2 = |S|^2 / det^2 = 2.
    EXPECT_NEAR(quality.condition, std::sqrt(8.0 / 3.0 * 2.0) / 2, 1e-14);
}

TEST(MeasureCell, KnowsThePathSimplexOfATesseract) {
    // Volume 1/24, squared edges 1 2 3 4, 1 2 3, 1 2, 1: mean 2. The regular pentachoron with edge
    // l has volume sqrt(5) l^4 / 96. Facets meet at 45, 60 and 90 degrees.
    Corners<4> corners = Corners<4>::Zero();
    for (int i = 1; i <= 4; ++i) {
        corners.col(i).head(i).setOnes();
    }
    const CellQuality quality = measure_cell<4>(corners);
    EXPECT_NEAR(quality.mean_ratio, std::sqrt(96 / std::sqrt(5.0) / 24) / 2, 1e-14);
    EXPECT_NEAR(quality.smallest_angle, 45, 1e-12);
    EXPECT_NEAR(quality.largest_angle, 90, 1e-12);
}

TEST(MeasureQuality, SumsUpWhatMeasureCellSays) {
    SimplexMesh<3> mesh = test::kuhn_box<3>({2, 2, 2}, {1, 1, 1});
    mesh.positions.col(13) += Eigen::Vector3d(0.2, 0.1, -0.1);  // the vertex in the middle
    const QualityReport report = measure_quality(mesh);
    std::vector<double> ratios;
    for (const auto& cell : mesh.cells.colwise()) {
        Corners<3> corners;
        for (int i = 0; i < 4; ++i) {
            corners.col(i) = mesh.positions.col(cell[i]);
        }
        ratios.push_back(measure_cell<3>(corners).mean_ratio);
    }
    const auto worst = std::min_element(ratios.begin(), ratios.end());
    EXPECT_EQ(report.mean_ratio.min, *worst);
    EXPECT_EQ(report.mean_ratio.max, *std::max_element(ratios.begin(), ratios.end()));
    EXPECT_EQ(report.worst_cells.front(), worst - ratios.begin());
    EXPECT_EQ(report.worst_cells.size(), 10U);
    std::int64_t counted = 0;
    for (const std::int64_t count : report.histogram) {
        counted += count;
    }
    EXPECT_EQ(counted, mesh.cell_count());
    EXPECT_NE(quality_text(report).find("worst cells: "), std::string::npos);
}

// Of 401 values the places of all percentiles are whole numbers.
TEST(MeasureQuality, HasThePercentilesOfEveryMeasure) {
    SimplexMesh<2> mesh;
    constexpr int kCells = 401;
    mesh.positions.resize(2, 3 * kCells);
    mesh.cells.resize(3, kCells);
    std::mt19937 random(12);
    std::uniform_real_distribution<double> coordinate(0.1, 1);
    std::vector<std::vector<double>> values(4);
    for (int cell = 0; cell < kCells; ++cell) {
        Corners<2> corners;
        corners << 0, 1, -coordinate(random), 0, coordinate(random) - 0.1, 2 * coordinate(random);
        mesh.positions.middleCols<3>(3 * cell) = corners;
        mesh.cells.col(cell) << 3U * cell, 3U * cell + 1, 3U * cell + 2;
        const CellQuality quality = measure_cell<2>(corners);
        values[0].push_back(quality.mean_ratio);
        values[1].push_back(quality.condition);
        values[2].push_back(quality.smallest_angle);
        values[3].push_back(quality.largest_angle);
    }
    const QualityReport report = measure_quality(mesh);
    const std::array<Spread, 4> spreads = {report.mean_ratio, report.condition,
                                           report.smallest_angle, report.largest_angle};
    for (std::size_t measure = 0; measure < 4; ++measure) {
        std::vector<double>& sorted = values[measure];
        const Spread& spread = spreads[measure];
        EXPECT_NEAR(spread.mean, std::accumulate(sorted.begin(), sorted.end(), 0.0) / kCells,
                    1e-12 * spread.mean);
        std::sort(sorted.begin(), sorted.end());
        EXPECT_EQ(spread.min, sorted[0]);
        EXPECT_EQ(spread.percentile_1, sorted[4]);
        EXPECT_EQ(spread.percentile_5, sorted[20]);
        EXPECT_EQ(spread.median, sorted[200]);
        EXPECT_EQ(spread.percentile_95, sorted[380]);
        EXPECT_EQ(spread.percentile_99, sorted[396]);
        EXPECT_EQ(spread.max, sorted[400]);
    }
}

TEST(QualitySvg, DrawsABarForEachBinAndEscapesTheTitle) {
    const std::string svg =
        quality_svg(measure_quality(test::kuhn_box<3>({1, 1, 1}, {1, 1, 1})), "a<b&c");
    EXPECT_NE(svg.find("a&lt;b&amp;c"), std::string::npos);
    std::size_t bars = 0;
    for (std::size_t at = svg.find("#3b6ea5"); at != std::string::npos;
         at = svg.find("#3b6ea5", at + 1)) {
        ++bars;
    }
    EXPECT_EQ(bars, static_cast<std::size_t>(kHistogramBins));
}

}  // namespace
}  // namespace pent::mesher
