#pragma once

#include <pent/simplex_mesh.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pent::mesher {

constexpr int kHistogramBins = 20;

/// How one measure is spread over the cells.
struct Spread {
    double min = 0;
    double percentile_1 = 0;
    double percentile_5 = 0;
    double median = 0;
    double percentile_95 = 0;
    double percentile_99 = 0;
    double max = 0;
    double mean = 0;
};

/// The shapes of the cells of a mesh, compared with the regular simplex.
struct QualityReport {
    /// c V^(2/Dim) / (mean squared edge): 1 for the regular simplex, 0 for a flat one.
    Spread mean_ratio;
    /// |S| |S^-1| / Dim in the Frobenius norm, S the map from the regular simplex to the cell: 1
    /// for the regular simplex, without bound for a flat one [knupp2001].
    Spread condition;
    Spread smallest_angle;  ///< The smallest dihedral angle of each cell, degrees.
    Spread largest_angle;   ///< The largest, degrees.
    std::array<std::int64_t, kHistogramBins> histogram{};  ///< Cells by mean ratio, 0 to 1.
    std::vector<std::int64_t> worst_cells;  ///< Up to 10 of lowest mean ratio, worst first.
};

/// The four measures of one cell.
struct CellQuality {
    double mean_ratio = 0;
    double condition = 0;
    double smallest_angle = 0;  ///< Degrees.
    double largest_angle = 0;   ///< Degrees.
};

/// Measures one simplex of positive volume; the result depends on its shape alone: not on the order
/// of the corners, size, place or rotation.
///
/// @param corners  One corner a column.
template <int Dim>
[[nodiscard]] CellQuality measure_cell(const Eigen::Matrix<double, Dim, Dim + 1>& corners);

/// The mean ratio alone, which is cheaper.
template <int Dim>
[[nodiscard]] double mean_ratio(const Eigen::Matrix<double, Dim, Dim + 1>& corners);

/// Measures all cells of a mesh that passes validate().
template <int Dim>
[[nodiscard]] QualityReport measure_quality(const SimplexMesh<Dim>& mesh);

/// The histogram of mean ratios as text, one line a bin, and the percentiles of all measures.
[[nodiscard]] std::string quality_text(const QualityReport& report);

/// The histogram of mean ratios as an SVG picture, with a title and labeled axes.
[[nodiscard]] std::string quality_svg(const QualityReport& report, const std::string& title);

}  // namespace pent::mesher
