#include "obstacle_view.h"

#include <pent/viewer/attributes.h>
#include <pent/viewer/obstacle_surface.h>

#include <algorithm>
#include <utility>

namespace pent::viewer {

namespace {

RenderObject to_object(TriangleMesh mesh, Positions<3> normals, const Color& color, float opacity) {
    RenderObject object;
    object.colors = color.replicate(1, mesh.vertex_count());
    object.positions = std::move(mesh.positions);
    object.triangles = std::move(mesh.triangles);
    object.normals = std::move(normals);
    object.opacity = opacity;
    return object;
}

}  // namespace

Color obstacle_color() {
    return from_oklch(0.80F, 0.012F, 75);
}

RenderObject ball_object(const Sphere& ball, const Color& color, float opacity) {
    TriangleMesh mesh = wall_surface({.ball = ball});
    Positions<3> normals(3, 3 * mesh.triangle_count());
    for (Eigen::Index corner = 0; corner < normals.cols(); ++corner) {
        const Eigen::Vector3d point = mesh.positions.col(mesh.triangles(corner % 3, corner / 3));
        normals.col(corner) = (point - ball.center) / ball.radius;
    }
    return to_object(std::move(mesh), std::move(normals), color, opacity);
}

RenderObject outline_object(const Ball<4>& ball, const Projection& projection, float opacity) {
    constexpr double kSmooth = 1.0;  // radians: no edge of an ellipsoid is that sharp
    TriangleMesh mesh = outline(ball, projection);
    Positions<3> normals = corner_normals(mesh, kSmooth);
    return to_object(std::move(mesh), std::move(normals), obstacle_color(), opacity);
}

bool has_ground_below(const std::vector<ObstacleSlice>& slices) {
    return std::any_of(slices.begin(), slices.end(), [](const ObstacleSlice& slice) {
        return slice.plane ? slice.plane->normal.y() > 0.5
                           : slice.hollow.has_value() || slice.is_everything();
    });
}

}  // namespace pent::viewer
