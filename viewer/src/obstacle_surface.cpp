#include "pent/viewer/obstacle_surface.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace pent::viewer {

namespace {

constexpr double kPi = std::numbers::pi;

// A curve in the half-plane beside an axis, as distances from the axis and heights along it.
using Profile = std::vector<Eigen::Vector2d>;

// The arc of a circle about the axis' origin, by the angle from straight below, 0..pi, or reverse.
Profile arc(double radius, double from, double to, int circle) {
    const int steps =
        std::max(2, static_cast<int>(std::lround(std::abs(to - from) * circle / (2 * kPi))));
    Profile profile;
    for (int i = 0; i <= steps; ++i) {
        const double angle = i == steps ? to : from + (to - from) * i / steps;
        const bool is_pole = angle == 0 || angle == kPi;
        profile.emplace_back(is_pole ? 0 : radius * std::sin(angle), -radius * std::cos(angle));
    }
    return profile;
}

// Turns a profile about an axis. Seen from above, where the profile leads outward, triangles turn
// counter-clockwise.
TriangleMesh revolve(const Profile& profile,
                     const Eigen::Vector3d& center,
                     const Eigen::Vector3d& axis,
                     int circle) {
    const Eigen::Vector3d across = axis.unitOrthogonal();
    const Eigen::Vector3d beyond = axis.cross(across);
    std::vector<Eigen::Vector3d> points;
    std::vector<std::uint32_t> rings;  // where each begins
    for (const Eigen::Vector2d& p : profile) {
        rings.push_back(static_cast<std::uint32_t>(points.size()));
        for (int k = 0; k < (p.x() > 0 ? circle : 1); ++k) {
            const double angle = 2 * kPi * k / circle;
            points.push_back(center + p.y() * axis
                             + p.x() * (std::cos(angle) * across + std::sin(angle) * beyond));
        }
    }
    std::vector<Eigen::Vector3<std::uint32_t>> triangles;
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        const bool has_ring = profile[i].x() > 0;
        const bool has_next_ring = profile[i + 1].x() > 0;
        const auto count = static_cast<std::uint32_t>(circle);
        for (std::uint32_t k = 0; k < count; ++k) {
            const std::uint32_t next = (k + 1) % count;
            const std::uint32_t a = rings[i] + (has_ring ? k : 0);
            const std::uint32_t b = rings[i + 1] + (has_next_ring ? k : 0);
            if (has_next_ring) {
                triangles.emplace_back(a, b, rings[i + 1] + next);
            }
            if (has_ring) {
                triangles.emplace_back(a, rings[i + 1] + (has_next_ring ? next : 0),
                                       rings[i] + next);
            }
        }
    }
    TriangleMesh mesh;
    mesh.positions.resize(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        mesh.positions.col(static_cast<Eigen::Index>(i)) = points[i];
    }
    mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        mesh.triangles.col(static_cast<Eigen::Index>(i)) = triangles[i];
    }
    return mesh;
}

TriangleMesh together(const TriangleMesh& a, const TriangleMesh& b) {
    TriangleMesh both;
    both.positions.resize(3, a.vertex_count() + b.vertex_count());
    both.positions << a.positions, b.positions;
    both.triangles.resize(3, a.triangle_count() + b.triangle_count());
    both.triangles << a.triangles,
        (b.triangles.array() + static_cast<std::uint32_t>(a.vertex_count())).matrix();
    return both;
}

TriangleMesh ball_surface(const Sphere& ball, int circle) {
    return revolve(arc(ball.radius, kPi, 0, circle), ball.center, Eigen::Vector3d::UnitY(), circle);
}

// How far up the wall of a hollow goes: the angle from straight below, about the plane's normal.
double rim_angle(const ObstacleSlice& slice) {
    if (!slice.plane) {
        return kPi;
    }
    const double height = slice.plane->offset - slice.plane->normal.dot(slice.hollow->center);
    return std::acos(std::clamp(-height / slice.hollow->radius, -1.0, 1.0));
}

Eigen::Vector3d axis_of(const ObstacleSlice& slice) {
    return slice.plane ? slice.plane->normal : Eigen::Vector3d::UnitY();
}

Profile hollow_profile(const ObstacleSlice& slice, int circle) {
    return arc(slice.hollow->radius, 0, rim_angle(slice), circle);
}

}  // namespace

TriangleMesh wall_surface(const ObstacleSlice& slice, int circle) {
    if (slice.ball) {
        return ball_surface(*slice.ball, circle);
    }
    if (slice.block) {
        return *slice.block;
    }
    if (!slice.hollow) {
        return {};
    }
    return revolve(hollow_profile(slice, circle), slice.hollow->center, axis_of(slice), circle);
}

TriangleMesh obstacle_surface(const ObstacleSlice& slice, const Sphere& view, int circle) {
    if (!slice.plane) {
        return wall_surface(slice, circle);
    }
    const Plane& plane = *slice.plane;
    const auto foot = [&](const Eigen::Vector3d& point) {
        return Eigen::Vector3d(point + (plane.offset - plane.normal.dot(point)) * plane.normal);
    };
    const Eigen::Vector3d middle = foot(view.center);
    if (!slice.hollow || rim_angle(slice) == kPi) {  // none, or one that is buried
        const TriangleMesh ground =
            revolve({{0, 0}, {view.radius, 0}}, middle, plane.normal, circle);
        return together(ground, wall_surface(slice, circle));
    }
    Profile profile = hollow_profile(slice, circle);
    const Eigen::Vector2d rim = profile.back();
    const double off = (middle - foot(slice.hollow->center)).norm();
    profile.emplace_back(std::max(2 * rim.x(), off + view.radius), rim.y());
    return revolve(profile, slice.hollow->center, plane.normal, circle);
}

TriangleMesh outline(const Cuboid<4>& box, const Projection& projection) {
    const SimplexMesh<4> mesh = to_mesh<4>(box);
    if (projection.eye_distance) {
        const double eye = projection.film.offset + *projection.eye_distance;
        if (!((projection.film.frame.row(3) * mesh.positions).maxCoeff() < eye)) {
            return {};
        }
    }
    return outline(make_boundary<4>(mesh, "box"), mesh.positions, projection);
}

// Tangents from the eye touch a ball in a sphere across the way to it; its image is the outline.
// For an eye infinitely far away that is the sphere parallel to the film through the center.
TriangleMesh outline(const Ball<4>& ball, const Projection& projection, int circle) {
    const Eigen::Vector4d center = projection.film.frame * ball.center;
    Eigen::Vector4d middle = center;
    double radius = ball.radius;
    Eigen::Matrix<double, 4, 3> axes = Eigen::Matrix<double, 4, 3>::Identity();
    if (projection.eye_distance) {
        Eigen::Vector4d to_eye;
        to_eye << projection.center, projection.film.offset + *projection.eye_distance;
        to_eye -= center;
        if (!(to_eye.w() > ball.radius)) {
            return {};
        }
        const double share = ball.radius / to_eye.norm();
        middle += share * share * to_eye;
        radius *= std::sqrt((1 - share) * (1 + share));
        axes = hyperplane_across(to_eye, 0).frame.topRows<3>().transpose();
    }
    TriangleMesh mesh = ball_surface({Eigen::Vector3d::Zero(), 1}, circle);
    const Positions<4> touched = (radius * axes * mesh.positions).colwise() + middle;
    mesh.positions = project(projection.film.frame.transpose() * touched, projection);
    return mesh;
}

}  // namespace pent::viewer
