#include "step/force_scales.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace pent::simulator {

namespace {

// Vertices of one material count as all alike if their volumes are within this factor, which spares
// a norm.
constexpr double kAlike = 10;

// The volume that belongs to a vertex of each body, in the mean, m^Dim: of its densest material.
template <int Dim>
std::vector<double> vertex_volumes(const Bodies<Dim>& bodies) {
    std::vector<double> densities(bodies.count(), 0);
    for (const CellRange& range : bodies.ranges) {
        densities[range.body] = std::max(densities[range.body], range.material.density);
    }
    std::vector<double> volumes;
    for (std::size_t body = 0; body < bodies.count(); ++body) {
        const auto [begin, size] = bodies.vertices(body);
        volumes.push_back(bodies.masses.segment(begin, size).mean() / densities[body]);
    }
    return volumes;
}

// The largest of a number of materials, times a power of the volume of a vertex, over the largest
// of those that each vertex has; empty if all are alike.
template <int Dim, typename Number>
Eigen::VectorXd scales_by(const Bodies<Dim>& bodies, double power, const Number& number) {
    const std::vector<double> volumes = vertex_volumes(bodies);
    const auto [least, most] = std::minmax_element(volumes.begin(), volumes.end());
    const bool is_one_size = *most < kAlike * *least;
    std::vector<double> of_ranges;
    bool is_one_material = true;
    for (const CellRange& range : bodies.ranges) {
        const double own = number(range.material);
        is_one_material = is_one_material && own == number(bodies.ranges.front().material);
        of_ranges.push_back(is_one_size ? own : own * std::pow(volumes[range.body], power));
    }
    if (is_one_size && is_one_material) {
        return {};
    }
    Eigen::Matrix<double, 1, Eigen::Dynamic> of_vertices =
        Eigen::RowVectorXd::Zero(bodies.vertex_count());
    for (std::size_t r = 0; r < bodies.ranges.size(); ++r) {
        const CellRange& range = bodies.ranges[r];
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
            for (const std::uint32_t vertex : bodies.cells().col(cell)) {
                of_vertices[vertex] = std::max(of_vertices[vertex], of_ranges[r]);
            }
        }
    }
    bodies.sharing.gather(of_vertices);
    const double largest = *std::max_element(of_ranges.begin(), of_ranges.end());
    return largest * of_vertices.cwiseInverse().transpose();
}

}  // namespace

template <int Dim>
ForceScales<Dim>::ForceScales(const Bodies<Dim>& bodies)
    // Of equal strains, and of equal accelerations.
    : by_stiffness_(
        scales_by(bodies, (Dim - 1.0) / Dim, [](const Material& own) { return own.lame.mu; })),
      by_density_(scales_by(bodies, 1, [](const Material& own) { return own.density; })) {}

template <int Dim>
std::vector<const Eigen::VectorXd*> ForceScales<Dim>::scales() const {
    std::vector<const Eigen::VectorXd*> all;
    if (by_stiffness_.size() > 0) {
        all.push_back(&by_stiffness_);
    }
    if (by_density_.size() > 0 && has_inertia_) {
        all.push_back(&by_density_);
    }
    return all;
}

template <int Dim>
GradientNorms ForceScales<Dim>::norms(const Positions<Dim>& gradient) const {
    GradientNorms norms = {gradient.norm()};
    for (const Eigen::VectorXd* scale : scales()) {
        norms.push_back((gradient * scale->asDiagonal()).norm());
    }
    return norms;
}

template <int Dim>
std::vector<Eigen::VectorXd> ForceScales<Dim>::weights(const DofMap& rows) const {
    std::vector<Eigen::VectorXd> weights;
    for (const Eigen::VectorXd* scale : scales()) {
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
