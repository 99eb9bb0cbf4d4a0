#include "step/force_scales.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cstdint>

namespace pent::simulator {

namespace {

// The largest of a number of materials over the largest of those that each vertex has; empty if
// there is but one.
template <int Dim, typename Number>
Eigen::VectorXd scales_by(const Bodies<Dim>& bodies, const Number& number) {
    double smallest = number(bodies.ranges.front().material);
    double largest = smallest;
    for (const CellRange& range : bodies.ranges) {
        smallest = std::min(smallest, number(range.material));
        largest = std::max(largest, number(range.material));
    }
    if (smallest == largest) {
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
    return largest * of_vertices.cwiseInverse().transpose();
}

}  // namespace

template <int Dim>
ForceScales<Dim>::ForceScales(const Bodies<Dim>& bodies)
    : by_stiffness_(scales_by(bodies, [](const Material& own) { return own.lame.mu; })),
      by_density_(scales_by(bodies, [](const Material& own) { return own.density; })) {}

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
