#include "step/force_scales.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>

namespace pent::simulator {

namespace {

// The largest of a number of materials over the largest of those that each vertex has.
template <int Dim, typename Number>
std::vector<float> scales_by(const Bodies<Dim>& bodies, const Number& number) {
    double largest = 0;
    bool differ = false;
    for (const CellRange& range : bodies.ranges) {
        differ = differ || number(range.material) != number(bodies.ranges.front().material);
        largest = std::max(largest, number(range.material));
    }
    if (!differ) {
        return {};
    }
    Eigen::Matrix<double, 1, Eigen::Dynamic> of_vertices =
        Eigen::RowVectorXd::Zero(bodies.vertex_count());
    for (const CellRange& range : bodies.ranges) {
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
            for (const std::uint32_t vertex : bodies.cells().col(cell)) {
                of_vertices[vertex] = std::max(of_vertices[vertex], number(range.material));
            }
        }
    }
    bodies.sharing.gather(of_vertices);
    std::vector<float> scales;
    scales.reserve(static_cast<std::size_t>(of_vertices.size()));
    for (const double own : of_vertices) {
        scales.push_back(static_cast<float>(largest / own));
    }
    return scales;
}

}  // namespace

template <int Dim>
ForceScales<Dim>::ForceScales(const Bodies<Dim>& bodies)
    : by_stiffness_(scales_by(bodies, [](const Material& own) { return own.lame.mu; })),
      by_density_(scales_by(bodies, [](const Material& own) { return own.density; })) {}

template <int Dim>
std::vector<const std::vector<float>*> ForceScales<Dim>::scales() const {
    std::vector<const std::vector<float>*> all;
    if (!by_stiffness_.empty()) {
        all.push_back(&by_stiffness_);
    }
    if (!by_density_.empty() && has_inertia_) {
        all.push_back(&by_density_);
    }
    return all;
}

template <int Dim>
GradientNorms ForceScales<Dim>::norms(const Positions<Dim>& gradient) const {
    GradientNorms norms = {gradient.norm()};
    for (const std::vector<float>* scale : scales()) {
        double sum = 0;
        for (Eigen::Index vertex = 0; vertex < gradient.cols(); ++vertex) {
            const double factor = (*scale)[static_cast<std::size_t>(vertex)];
            sum += factor * factor * gradient.col(vertex).squaredNorm();
        }
        norms.push_back(std::sqrt(sum));
    }
    return norms;
}

template <int Dim>
std::vector<Eigen::VectorXd> ForceScales<Dim>::weights(const DofMap& rows) const {
    std::vector<Eigen::VectorXd> weights;
    for (const std::vector<float>* scale : scales()) {
        Eigen::VectorXd& own = weights.emplace_back(rows.row_count());
        for (std::uint32_t row = 0; row < rows.row_count(); ++row) {
            const double factor = (*scale)[rows.vertex_of(row)];
            own[row] = factor * factor;
        }
    }
    return weights;
}

#define PENT_INSTANTIATE(Dim) template class ForceScales<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
