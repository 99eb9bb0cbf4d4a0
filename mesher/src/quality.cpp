#include <pent/formatted.h>
#include <pent/mesher/quality.h>
#include <pent/parallel.h>

#include <Eigen/LU>

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <numbers>
#include <numeric>

namespace pent::mesher {

namespace {

template <int Dim>
using Matrix = Eigen::Matrix<double, Dim, Dim>;

// Edges at the first corner of the regular simplex with edge 1, upper triangular: corner i + 1
// lies above the center of the corners before it.
template <int Dim>
Matrix<Dim> regular_edges() {
    Matrix<Dim> W = Matrix<Dim>::Zero();
    for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < i; ++j) {
            W(j, i) = W(j, j) / (j + 2);
        }
        W(i, i) = std::sqrt((i + 2.0) / (2.0 * (i + 1)));
    }
    return W;
}

template <int Dim>
struct Reference {
    Matrix<Dim> edges = regular_edges<Dim>();
    Matrix<Dim> inverse = edges.inverse();
    double mean_ratio_scale = std::pow(edges.determinant(), -2.0 / Dim);
};

// Between the facets opposite to corners i and j: their normals are the gradients of the
// barycentric coordinates, pointing inward.
template <int Dim>
void measure_angles(const Matrix<Dim>& inverse_edges, CellQuality& quality) {
    Eigen::Matrix<double, Dim + 1, Dim> normals;
    normals.template bottomRows<Dim>() = inverse_edges;
    normals.row(0) = -inverse_edges.colwise().sum();
    normals.rowwise().normalize();
    double lowest = 1;
    double highest = -1;
    for (int i = 0; i <= Dim; ++i) {
        for (int j = i + 1; j <= Dim; ++j) {
            const double cosine = -normals.row(i).dot(normals.row(j));
            lowest = std::min(lowest, cosine);
            highest = std::max(highest, cosine);
        }
    }
    constexpr double kDegrees = 180 / std::numbers::pi;
    quality.smallest_angle = kDegrees * std::acos(std::clamp(highest, -1.0, 1.0));
    quality.largest_angle = kDegrees * std::acos(std::clamp(lowest, -1.0, 1.0));
}

template <int Dim>
Matrix<Dim> edges_at_first(const Eigen::Matrix<double, Dim, Dim + 1>& corners) {
    return corners.template rightCols<Dim>().colwise() - corners.col(0);
}

// Of all edges, from those at the first corner, p_0 = 0: the sum of |p_i - p_j|^2 over all pairs of
// Dim + 1 points is (Dim + 1) times the sum of |p_i|^2, less the square of the sum of p_i. At least
// the sum of |p_i|^2 is left, so nothing cancels.
template <int Dim>
double mean_squared_edge(const Matrix<Dim>& Dm) {
    const double sum = (Dim + 1) * Dm.squaredNorm() - Dm.rowwise().sum().squaredNorm();
    return sum / (Dim * (Dim + 1) / 2);
}

// det(Dm)^(2/Dim): a square root or two where that will do, since pow() would take half the time.
template <int Dim>
double squared_size(double determinant) {
    const double positive = std::max(determinant, 0.0);
    if constexpr (Dim == 2) {
        return positive;
    } else if constexpr (Dim == 3) {
        const double root = std::cbrt(positive);
        return root * root;
    } else {
        static_assert(Dim == 4);
        return std::sqrt(positive);
    }
}

template <int Dim>
CellQuality measure(const Eigen::Matrix<double, Dim, Dim + 1>& corners,
                    const Reference<Dim>& reference) {
    const Matrix<Dim> Dm = edges_at_first<Dim>(corners);
    const Matrix<Dim> inverse_Dm = Dm.inverse();
    CellQuality quality;
    quality.mean_ratio = squared_size<Dim>(Dm.determinant()) * reference.mean_ratio_scale
                         / mean_squared_edge<Dim>(Dm);
    quality.condition =
        (Dm * reference.inverse).norm() * (reference.edges * inverse_Dm).norm() / Dim;
    measure_angles<Dim>(inverse_Dm, quality);
    return quality;
}

double percentile(std::vector<double>& values, double fraction) {
    const auto place = static_cast<std::ptrdiff_t>(
        std::llround(fraction * static_cast<double>(values.size() - 1)));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[place];
}

Spread spread_of(const std::vector<CellQuality>& cells, double CellQuality::*measure) {
    std::vector<double> values(cells.size());
    std::transform(cells.begin(), cells.end(), values.begin(),
                   [&](const CellQuality& cell) { return cell.*measure; });
    Spread spread;
    spread.mean =
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    spread.min = percentile(values, 0);
    spread.percentile_1 = percentile(values, 0.01);
    spread.percentile_5 = percentile(values, 0.05);
    spread.median = percentile(values, 0.5);
    spread.percentile_95 = percentile(values, 0.95);
    spread.percentile_99 = percentile(values, 0.99);
    spread.max = percentile(values, 1);
    return spread;
}

std::vector<std::int64_t> worst_of(const std::vector<CellQuality>& cells) {
    std::vector<std::int64_t> order(cells.size());
    std::iota(order.begin(), order.end(), 0);
    const auto count = static_cast<std::ptrdiff_t>(std::min<std::size_t>(10, cells.size()));
    std::partial_sort(order.begin(), order.begin() + count, order.end(),
                      [&](std::int64_t a, std::int64_t b) {
                          return cells[a].mean_ratio != cells[b].mean_ratio
                                     ? cells[a].mean_ratio < cells[b].mean_ratio
                                     : a < b;
                      });
    order.resize(count);
    return order;
}

void append_line(std::string& text, const char* name, const Spread& spread) {
    text += formatted("  %-16s %9.4g %9.4g %9.4g %9.4g %9.4g %9.4g %9.4g %9.4g\n", name, spread.min,
                      spread.percentile_1, spread.percentile_5, spread.median, spread.mean,
                      spread.percentile_95, spread.percentile_99, spread.max);
}

}  // namespace

template <int Dim>
CellQuality measure_cell(const Eigen::Matrix<double, Dim, Dim + 1>& corners) {
    return measure<Dim>(corners, Reference<Dim>());
}

template <int Dim>
double mean_ratio(const Eigen::Matrix<double, Dim, Dim + 1>& corners) {
    static const double scale = Reference<Dim>().mean_ratio_scale;
    const Matrix<Dim> Dm = edges_at_first<Dim>(corners);
    return squared_size<Dim>(Dm.determinant()) * scale / mean_squared_edge<Dim>(Dm);
}

template <int Dim>
QualityReport measure_quality(const SimplexMesh<Dim>& mesh) {
    const Reference<Dim> reference;
    std::vector<CellQuality> cells(mesh.cell_count());
    parallel_for(cells.size(), kLightChunk, [&](std::size_t cell) {
        Eigen::Matrix<double, Dim, Dim + 1> corners;
        for (int i = 0; i <= Dim; ++i) {
            corners.col(i) = mesh.positions.col(mesh.cells(i, cell));
        }
        cells[cell] = measure<Dim>(corners, reference);
    });
    QualityReport report;
    report.mean_ratio = spread_of(cells, &CellQuality::mean_ratio);
    report.condition = spread_of(cells, &CellQuality::condition);
    report.smallest_angle = spread_of(cells, &CellQuality::smallest_angle);
    report.largest_angle = spread_of(cells, &CellQuality::largest_angle);
    for (const CellQuality& cell : cells) {
        const int bin = static_cast<int>(cell.mean_ratio * kHistogramBins);
        ++report.histogram[std::clamp(bin, 0, kHistogramBins - 1)];
    }
    report.worst_cells = worst_of(cells);
    return report;
}

std::string quality_text(const QualityReport& report) {
    std::string text =
        "                         min        1%        5%    median      mean"
        "       95%       99%       max\n";
    append_line(text, "mean ratio", report.mean_ratio);
    append_line(text, "condition of Dm", report.condition);
    append_line(text, "smallest angle", report.smallest_angle);
    append_line(text, "largest angle", report.largest_angle);
    const std::int64_t most = *std::max_element(report.histogram.begin(), report.histogram.end());
    text += "  cells by mean ratio\n";
    for (int bin = 0; bin < kHistogramBins; ++bin) {
        constexpr std::int64_t kWidest = 50;
        const std::int64_t count = report.histogram[bin];
        const auto width = static_cast<std::size_t>((count * kWidest + most - 1) / most);
        text += formatted("  %.2f-%.2f %9" PRId64 " ", bin / static_cast<double>(kHistogramBins),
                          (bin + 1) / static_cast<double>(kHistogramBins), count)
                + std::string(width, '#') + "\n";
    }
    text += "  worst cells:";
    for (const std::int64_t cell : report.worst_cells) {
        text += " " + std::to_string(cell);
    }
    return text + "\n";
}

template CellQuality measure_cell<2>(const Eigen::Matrix<double, 2, 3>&);
template CellQuality measure_cell<3>(const Eigen::Matrix<double, 3, 4>&);
template CellQuality measure_cell<4>(const Eigen::Matrix<double, 4, 5>&);
template double mean_ratio<2>(const Eigen::Matrix<double, 2, 3>&);
template double mean_ratio<3>(const Eigen::Matrix<double, 3, 4>&);
template double mean_ratio<4>(const Eigen::Matrix<double, 4, 5>&);
template QualityReport measure_quality<2>(const SimplexMesh<2>&);
template QualityReport measure_quality<3>(const SimplexMesh<3>&);
template QualityReport measure_quality<4>(const SimplexMesh<4>&);

}  // namespace pent::mesher
