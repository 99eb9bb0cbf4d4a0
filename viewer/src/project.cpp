#include "pent/viewer/project.h"

#include <pent/error.h>
#include <pent/facets.h>
#include <pent/parallel.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace pent::viewer {

namespace {

// An outward tetrahedron faces an eye above the film if its image is negatively oriented:
// det[e_w, t1 - t0, t2 - t0, t3 - t0] = -det3 of the images' edges. The images of a perspective
// have the same sign, as all of the body is in front of the eye.
std::vector<std::uint32_t> facing_facets(const Boundary<4>& boundary, const Positions<3>& images) {
    std::vector<char> is_facing(static_cast<std::size_t>(boundary.facets.cols()));
    parallel_for(boundary.facets.cols(), kLightChunk, [&](Eigen::Index f) {
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) {
            edges.col(k) =
                images.col(boundary.facets(k + 1, f)) - images.col(boundary.facets(0, f));
        }
        is_facing[static_cast<std::size_t>(f)] = edges.determinant() < 0 ? 1 : 0;
    });
    std::vector<std::uint32_t> facing;
    for (std::size_t f = 0; f < is_facing.size(); ++f) {
        if (is_facing[f] != 0) {
            facing.push_back(static_cast<std::uint32_t>(f));
        }
    }
    return facing;
}

}  // namespace

Positions<3> project(const Positions<4>& positions, const Projection& projection) {
    const Positions<4> seen = projection.film.frame * positions;
    Positions<3> images = seen.topRows<3>();
    if (!projection.eye_distance) {
        return images;
    }
    const double distance = *projection.eye_distance;
    for (Eigen::Index v = 0; v < seen.cols(); ++v) {
        const double depth = projection.film.offset + distance - seen(3, v);
        if (!(depth > 0)) {
            throw Error("projection: vertex " + std::to_string(v) + " is not in front of the eye, "
                        + std::to_string(distance)
                        + " m from the slice; move the eye further away");
        }
        images.col(v) =
            projection.center + (images.col(v) - projection.center) * (distance / depth);
    }
    return images;
}

Surface outline(const Boundary<4>& boundary,
                const Positions<4>& positions,
                const Projection& projection) {
    const Positions<3> images = project(positions, projection);
    const std::vector<std::uint32_t> facing = facing_facets(boundary, images);
    Simplices<4> tets(4, static_cast<Eigen::Index>(facing.size()));
    for (std::size_t i = 0; i < facing.size(); ++i) {
        tets.col(static_cast<Eigen::Index>(i)) = boundary.facets.col(facing[i]);
    }
    FacetMatch<3> match = match_facets<3>(tets, positions.cols());
    Surface surface;
    // Outward for positive tetrahedra, and all of these are negative.
    match.boundary.row(1).swap(match.boundary.row(2));
    std::vector<std::uint32_t> number(static_cast<std::size_t>(positions.cols()),
                                      std::numeric_limits<std::uint32_t>::max());
    for (const std::uint32_t vertex : match.boundary.reshaped()) {
        number[vertex] = 0;
    }
    std::uint32_t vertices = 0;
    for (std::uint32_t& n : number) {
        n = n == 0 ? vertices++ : n;
    }
    surface.positions.resize(3, vertices);
    surface.ends.resize(2, vertices);
    surface.weights.setZero(vertices);
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] < vertices) {
            surface.positions.col(number[v]) = images.col(static_cast<Eigen::Index>(v));
            surface.ends.col(number[v]).setConstant(static_cast<std::uint32_t>(v));
        }
    }
    surface.triangles = match.boundary.unaryExpr([&](std::uint32_t v) { return number[v]; });
    for (const std::uint32_t cell : match.boundary_cells) {
        surface.facets.push_back(facing[cell]);
    }
    return surface;
}

Projection make_projection(const ProjectionOptions& options,
                           const FramedHyperplane& film,
                           std::span<const Frame<4>> frames) {
    Eigen::AlignedBox<double, 4> box;
    for (const Frame<4>& frame : frames) {
        for (const auto& point : frame.positions.colwise()) {
            box.extend(film.frame * point);
        }
    }
    Projection projection;
    projection.film = film;
    projection.center = box.center().head<3>();
    if (options.is_perspective) {
        const double distance = options.eye_distance.value_or(1.5 * box.diagonal().norm());
        if (!(distance > 0)) {
            throw Error("projection: found an eye distance of " + std::to_string(distance)
                        + " m; expected one over 0");
        }
        projection.eye_distance = distance;
    }
    return projection;
}

}  // namespace pent::viewer
