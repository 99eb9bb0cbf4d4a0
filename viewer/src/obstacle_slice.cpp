#include "pent/viewer/obstacle_slice.h"

#include <pent/viewer/boundary.h>
#include <pent/viewer/slice.h>

#include <cmath>

namespace pent::viewer {

namespace {

constexpr double kParallel = 1e-12;

template <int Dim>
using Vector = Eigen::Matrix<double, Dim, 1>;

// What is met of the half-space normal . p < offset, in a frame whose axes behind the third have
// the value `w` in the slice: their part of the product is the same all over it.
template <int Dim>
ObstacleSlice cut_plane(const Vector<Dim>& normal, double offset, double w) {
    const double left = Dim == 4 ? offset - normal[Dim - 1] * w : offset;
    const Eigen::Vector3d within = normal.template head<3>();
    const double length = within.norm();
    if (length < kParallel) {
        return {.is_empty = !(left > 0)};
    }
    return {.plane = Plane{within / length, left / length}};
}

// The ball's part in the slice, a ball or nothing: r^2 - h^2 at the height h over its center.
template <int Dim>
std::optional<Sphere> cut_ball(const Vector<Dim>& center, double radius, double w) {
    const double height = Dim == 4 ? w - center[Dim - 1] : 0;
    const double square = (radius - height) * (radius + height);
    if (!(square > 0)) {
        return std::nullopt;
    }
    return Sphere{center.template head<3>(), std::sqrt(square)};
}

template <int Dim>
struct Cut {
    Eigen::Matrix<double, Dim, Dim> frame;
    double w = 0;

    ObstacleSlice operator()(const HalfSpace<Dim>& plane) const {
        return cut_plane<Dim>(frame * plane.normal, plane.offset, w);
    }
    ObstacleSlice operator()(const Ball<Dim>& ball) const {
        const auto inside = cut_ball<Dim>(frame * ball.center, ball.radius, w);
        return {.is_empty = !inside, .ball = inside};
    }
    ObstacleSlice operator()(const Cavity<Dim>& cavity) const {
        return {.hollow = cut_ball<Dim>(frame * cavity.center, cavity.radius, w)};
    }
    ObstacleSlice operator()(const Bowl<Dim>& bowl) const {
        ObstacleSlice ground = cut_plane<Dim>(frame * bowl.up, bowl.up.dot(bowl.center), w);
        const auto hollow = cut_ball<Dim>(frame * bowl.center, bowl.radius, w);
        if (ground.is_empty || !hollow) {
            return ground;
        }
        const bool is_above =
            ground.plane
            && ground.plane->normal.dot(hollow->center) - ground.plane->offset >= hollow->radius;
        if (!is_above) {
            ground.hollow = hollow;
        }
        return ground;
    }
    ObstacleSlice operator()(const Cuboid<Dim>& box) const {
        const SimplexMesh<Dim> mesh = to_mesh<Dim>(box);
        const Boundary<Dim> boundary = make_boundary<Dim>(mesh, "box");
        Surface surface;
        if constexpr (Dim == 4) {
            surface = merge_coincident(viewer::slice(
                boundary, mesh.positions, FramedHyperplane{.frame = frame, .offset = w}));
        } else {
            surface = skin(boundary, mesh.positions);
        }
        if (!(enclosed_volume(surface) > 0)) {
            return {.is_empty = true};
        }
        return {.block = static_cast<TriangleMesh&&>(surface)};
    }
};

}  // namespace

ObstacleSlice slice(const ObstacleShape<4>& obstacle, const FramedHyperplane& hyperplane) {
    return std::visit(Cut<4>{hyperplane.frame, hyperplane.offset}, obstacle);
}

ObstacleSlice whole(const ObstacleShape<3>& obstacle) {
    return std::visit(Cut<3>{Eigen::Matrix3d::Identity()}, obstacle);
}

}  // namespace pent::viewer
