#pragma once

#include <pent/pent_file.h>
#include <pent/simplex_mesh.h>
#include <pent/viewer/boundary.h>
#include <pent/viewer/hyperplane.h>
#include <pent/viewer/surface.h>

#include <Eigen/Core>

#include <optional>
#include <span>

namespace pent::viewer {

/// How a four-dimensional body is seen whole from a point or a direction: what a photograph is to a
/// three-dimensional one, with a three-dimensional film.
struct Projection {
    /// Points in it stay where they are, so a slice by it lies within the image of its body.
    FramedHyperplane film;
    /// Under the eye, in the film's frame.
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    /// Of the eye from the film along its normal, m, over 0; none: infinitely far, orthographic.
    std::optional<double> eye_distance{};
};

/// The images of points on the film, in its frame.
///
/// Throws an Error if a point is not in front of the eye.
[[nodiscard]] Positions<3> project(const Positions<4>& positions, const Projection& projection);

/// The outline of a body's image: where the boundary turns away from the eye.
///
/// In three dimensions the outline of a body is a curve; here it is a surface: the triangles of the
/// boundary between a tetrahedron that faces the eye and one that does not (edge-on counts as not).
/// It is closed and turned outward; at some edges more than two triangles may meet. Throws as
/// project() does.
[[nodiscard]] Surface outline(const Boundary<4>& boundary,
                              const Positions<4>& positions,
                              const Projection& projection);

/// What a user says of a projection.
struct ProjectionOptions {
    bool is_perspective = false;
    /// For a perspective, m, over 0; none: three times the reach of the bodies from their middle.
    std::optional<double> eye_distance{};
};

/// The projection onto a hyperplane, centered on the bodies.
///
/// @param frames  Of all bodies at the start.
/// Throws an Error for an eye distance that is not over 0.
[[nodiscard]] Projection make_projection(const ProjectionOptions& options,
                                         const FramedHyperplane& film,
                                         std::span<const Frame<4>> frames);

}  // namespace pent::viewer
