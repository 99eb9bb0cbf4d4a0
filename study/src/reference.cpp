#include "reference.h"

#include <pent/error.h>

#include <algorithm>
#include <utility>

namespace pent::study {

namespace {

// Each vertex in its own body of the reference: where bodies touch, others have cells there, too.
Interpolation locate_by_body(const Trajectory& run, const Trajectory& reference) {
    const std::vector<Eigen::Index>& points = run.first_vertex();
    const std::vector<Eigen::Index>& vertices = reference.first_vertex();
    const std::vector<Eigen::Index>& cells = reference.first_cell();
    Interpolation all;
    all.corners.resize(reference.cells().rows(), points.back());
    all.weights.resize(reference.cells().rows(), points.back());
    for (std::size_t body = 0; body + 1 < points.size(); ++body) {
        const auto columns = [body](const auto& matrix, const std::vector<Eigen::Index>& first) {
            return matrix.middleCols(first[body], first[body + 1] - first[body]);
        };
        const auto first = static_cast<std::uint32_t>(vertices[body]);
        const Interpolation one =
            locate(columns(run.rest(), points), columns(reference.rest(), vertices),
                   columns(reference.cells(), cells).array() - first);
        all.corners.middleCols(points[body], one.corners.cols()) = one.corners.array() + first;
        all.weights.middleCols(points[body], one.weights.cols()) = one.weights;
        all.farthest = std::max(all.farthest, one.farthest);
    }
    return all;
}

}  // namespace

Reference::Reference(const simulator::Scene& scene,
                     const std::filesystem::path& folder,
                     std::uint32_t meshes)
    : frames_per_second_(scene.frames_per_second),
      meshes_(meshes),
      trajectory_(scene, folder),
      window_(window_of(trajectory_, scene.frames_per_second)) {}

const Interpolation& Reference::where(const Trajectory& run, std::uint32_t meshes) {
    // A body's layers may reach a hair beyond those of a coarser one; a cell's height is another
    // mesh.
    constexpr double kMaxOutside = 0.5;
    if (const auto known = where_.find(meshes); known != where_.end()) {
        return known->second;
    }
    Interpolation where;
    if (meshes != meshes_) {
        where = locate_by_body(run, trajectory_);
        if (where.farthest > kMaxOutside) {
            throw Error(
                "the meshes of the study are of different shapes; expected layers or"
                " subdivisions of one body");
        }
    }
    return where_.emplace(meshes, std::move(where)).first->second;
}

Errors Reference::errors_of(const Trajectory& run, std::uint32_t meshes) {
    return compare(run, trajectory_, where(run, meshes), window_, frames_per_second_);
}

ReferenceReport Reference::convergence(const std::vector<const Trajectory*>& levels) const {
    ReferenceReport report;
    for (std::size_t level = 0; level + 1 < levels.size(); ++level) {
        report.last = compare(*levels[level], *levels[level + 1], {}, window_, frames_per_second_);
        report.difference.push_back(report.last.position);
    }
    const std::size_t last = report.difference.size() - 1;
    const Convergence convergence =
        convergence_of(report.difference[last - 1], report.difference[last]);
    report.order = convergence.order;
    report.error_bar = convergence.error_bar;
    report.is_converged = convergence.is_converged;
    report.window = window_.end;
    report.has_contact = window_.has_contact;
    return report;
}

}  // namespace pent::study
