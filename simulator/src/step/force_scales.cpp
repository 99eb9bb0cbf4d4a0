#include "step/force_scales.h"

#include <pent/dimensions.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace pent::simulator {

namespace {

// Pieces of one material count as alike, which spares a norm, if the mean volumes of their vertices
// are within this factor.
constexpr double kAlike = 10;

using AnyCells = Eigen::Ref<const Eigen::Matrix<std::uint32_t, Eigen::Dynamic, Eigen::Dynamic>>;

// The lowest vertex of the piece that each vertex is in: connected components by cells, of which
// ranks have some each. Union-find with path halving.
std::vector<std::uint32_t> find_pieces(const AnyCells& cells,
                                       Eigen::Index vertices,
                                       const Sharing& sharing) {
    std::vector<std::uint32_t> lowest(static_cast<std::size_t>(vertices));
    std::iota(lowest.begin(), lowest.end(), 0U);
    const auto root = [&](std::uint32_t vertex) {
        while (lowest[vertex] != vertex) {
            vertex = lowest[vertex] = lowest[lowest[vertex]];
        }
        return vertex;
    };
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        lowest[std::max(a, b)] = std::min(a, b);
        return a != b;
    };
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        for (Eigen::Index corner = 1; corner < cells.rows(); ++corner) {
            join(cells(0, cell), cells(corner, cell));
        }
    }
    // Repeats until no rank learns more of what others have joined.
    for (bool is_new = sharing.is_shared(); is_new;) {
        Eigen::Matrix<double, 1, Eigen::Dynamic> told(lowest.size());
        for (std::uint32_t vertex = 0; vertex < lowest.size(); ++vertex) {
            told[vertex] = root(vertex);
        }
        sharing.gather(told);
        is_new = false;
        for (std::uint32_t vertex = 0; vertex < lowest.size(); ++vertex) {
            is_new = join(vertex, static_cast<std::uint32_t>(told[vertex])) || is_new;
        }
        is_new = sharing.any(is_new);
    }
    for (std::uint32_t vertex = 0; vertex < lowest.size(); ++vertex) {
        lowest[vertex] = root(vertex);
    }
    return lowest;
}

// The largest value, among the materials of the cells at each vertex, of a number of a material.
template <int Dim>
Eigen::VectorXd largest_at(const Bodies<Dim>& bodies, double (*number)(const Material&)) {
    Eigen::Matrix<double, 1, Eigen::Dynamic> of_vertices =
        Eigen::RowVectorXd::Zero(bodies.vertex_count());
    for (const CellRange& range : bodies.ranges) {
        const double own = number(range.material);
        for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
            for (const std::uint32_t vertex : bodies.cells().col(cell)) {
                of_vertices[vertex] = std::max(of_vertices[vertex], own);
            }
        }
    }
    bodies.sharing.gather(of_vertices);
    return of_vertices.transpose();
}

// The mean volume of a vertex of the piece that each vertex is in, m^Dim, by its mass and its
// densest material. Empty if all are about alike.
template <int Dim>
Eigen::VectorXd volumes_by_piece(const Bodies<Dim>& bodies) {
    const std::vector<std::uint32_t> pieces =
        find_pieces(bodies.cells(), bodies.vertex_count(), bodies.sharing);
    const Eigen::VectorXd densities =
        largest_at(bodies, [](const Material& own) { return own.density; });
    const Eigen::Index count = bodies.vertex_count();
    Eigen::VectorXd masses = Eigen::VectorXd::Zero(count);  // here and below at lowest vertices
    Eigen::VectorXd vertices = Eigen::VectorXd::Zero(count);
    Eigen::VectorXd densest = Eigen::VectorXd::Zero(count);
    for (Eigen::Index vertex = 0; vertex < count; ++vertex) {
        const std::uint32_t piece = pieces[static_cast<std::size_t>(vertex)];
        masses[piece] += bodies.masses[vertex];
        vertices[piece] += 1;
        densest[piece] = std::max(densest[piece], densities[vertex]);
    }
    Eigen::VectorXd volumes(count);
    for (Eigen::Index vertex = 0; vertex < count; ++vertex) {
        const std::uint32_t piece = pieces[static_cast<std::size_t>(vertex)];
        volumes[vertex] = masses[piece] / vertices[piece] / densest[piece];
    }
    return volumes.maxCoeff() < kAlike * volumes.minCoeff() ? Eigen::VectorXd() : volumes;
}

// The largest product of a number of materials and a power of the volume, over that at each vertex;
// empty if all are alike.
//
// @param volumes  One a vertex; empty if they are alike.
template <int Dim>
Eigen::VectorXd scales_by(const Bodies<Dim>& bodies,
                          const Eigen::VectorXd& volumes,
                          double power,
                          double (*number)(const Material&)) {
    const double first = number(bodies.ranges.front().material);
    const bool is_one_material =
        std::all_of(bodies.ranges.begin(), bodies.ranges.end(),
                    [&](const CellRange& range) { return number(range.material) == first; });
    if (volumes.size() == 0 && is_one_material) {
        return {};
    }
    Eigen::VectorXd of_vertices = largest_at(bodies, number);
    for (Eigen::Index vertex = 0; vertex < volumes.size(); ++vertex) {
        of_vertices[vertex] *= std::pow(volumes[vertex], power);
    }
    return of_vertices.maxCoeff() * of_vertices.cwiseInverse();
}

}  // namespace

template <int Dim>
ForceScales<Dim>::ForceScales(const Bodies<Dim>& bodies) {
    const Eigen::VectorXd volumes = volumes_by_piece(bodies);
    // Forces that equal strains cause, and those that equal accelerations cause.
    by_stiffness_ = scales_by(bodies, volumes, (Dim - 1.0) / Dim,
                              [](const Material& own) { return own.lame.mu; });
    by_density_ = scales_by(bodies, volumes, 1, [](const Material& own) { return own.density; });
}

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
