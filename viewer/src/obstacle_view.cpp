#include "obstacle_view.h"

#include <pent/viewer/attributes.h>
#include <pent/viewer/obstacle_surface.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

namespace pent::viewer {

namespace {

// Angles between triangles of which an edge is seen, in radians: no edge of an ellipsoid is that
// sharp, and every edge of a box is.
constexpr double kSmooth = 1.0;
constexpr double kFlat = 0.1;

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

int round_circle(const Sphere& ball, const Camera& camera, int height) {
    constexpr double kDent = 0.1;  // pixels; samples at edges are an eighth apart
    const double distance = (ball.center - camera.position).norm() - ball.radius;
    const double pixels =
        ball.radius * height / (2 * std::tan(camera.field_of_view / 2) * distance);
    if (!(distance > 0)) {
        return kFineCircle;  // around the eye
    }
    // A chord is r (1 - cos(pi / n)) inside, which is below r (pi / n)^2 / 2.
    const double eighths = std::ceil(std::numbers::pi * std::sqrt(pixels / (2 * kDent)) / 8);
    return 8 * static_cast<int>(std::clamp(eighths, 1.0, kFineCircle / 8.0));
}

RenderObject wall_object(const ObstacleSlice& slice,
                         const Color& color,
                         float opacity,
                         int circle) {
    TriangleMesh mesh = wall_surface(slice, circle);
    Positions<3> normals;
    if (slice.ball) {
        normals.resize(3, 3 * mesh.triangle_count());
        for (Eigen::Index corner = 0; corner < normals.cols(); ++corner) {
            const Eigen::Vector3d point =
                mesh.positions.col(mesh.triangles(corner % 3, corner / 3));
            normals.col(corner) = (point - slice.ball->center) / slice.ball->radius;
        }
    } else {
        normals = corner_normals(mesh, kFlat);
    }
    return to_object(std::move(mesh), std::move(normals), color, opacity);
}

RenderObject outline_object(const ObstacleShape<4>& obstacle,
                            const Projection& projection,
                            float opacity,
                            const Camera& camera,
                            int height) {
    TriangleMesh mesh = obstacle_outline(obstacle, projection, kCoarseCircle);
    if (std::holds_alternative<Ball<4>>(obstacle) && mesh.vertex_count() > 0) {
        const Eigen::AlignedBox3d box = bounding_box(mesh);
        const Sphere around{box.center(), 0.5 * box.sizes().maxCoeff()};
        mesh = obstacle_outline(obstacle, projection, round_circle(around, camera, height));
    }
    Positions<3> normals =
        corner_normals(mesh, std::holds_alternative<Ball<4>>(obstacle) ? kSmooth : kFlat);
    return to_object(std::move(mesh), std::move(normals), obstacle_color(), opacity);
}

TriangleMesh obstacle_outline(const ObstacleShape<4>& obstacle,
                              const Projection& projection,
                              int circle) {
    if (const auto* ball = std::get_if<Ball<4>>(&obstacle)) {
        return outline(*ball, projection, circle);
    }
    if (const auto* box = std::get_if<Cuboid<4>>(&obstacle)) {
        return outline(*box, projection);
    }
    return {};
}

std::optional<double> radius_of(const ObstacleSlice& slice) {
    if (slice.ball || slice.hollow) {
        return (slice.ball ? slice.ball : slice.hollow)->radius;
    }
    if (slice.block) {
        return 0.5 * bounding_box(*slice.block).diagonal().norm();
    }
    return std::nullopt;
}

bool has_ground_below(const std::vector<ObstacleSlice>& slices) {
    return std::any_of(slices.begin(), slices.end(), [](const ObstacleSlice& slice) {
        return slice.plane ? slice.plane->normal.y() > 0.5
                           : slice.hollow.has_value() || slice.is_everything();
    });
}

}  // namespace pent::viewer
