#include "ground.h"

#include <algorithm>
#include <cmath>

namespace pent::viewer {

namespace {

// Where a ray enters (side -1) or leaves (side 1) a ball; negative if it misses it.
double crossing(const Sphere& ball,
                const Eigen::Vector3d& from,
                const Eigen::Vector3d& direction,
                int side) {
    const Eigen::Vector3d off = from - ball.center;
    const double middle = -off.dot(direction);
    const double square = ball.radius * ball.radius - (off + middle * direction).squaredNorm();
    return square > 0 ? middle + side * std::sqrt(square) : -1;
}

}  // namespace

Ground::Ground(const ObstacleSlice& slice, const RaySpace& space) : slice_(slice) {
    nearest_ = std::numeric_limits<double>::infinity();
    if (slice_.plane) {
        double& offset = slice_.plane->offset;
        offset = (offset - slice_.plane->normal.dot(space.origin)) / space.unit;
        nearest_ = std::abs(slice_.plane->offset);
    }
    for (std::optional<Sphere>* round : {&slice_.ball, &slice_.hollow}) {
        if (*round) {
            (*round)->center = ((*round)->center - space.origin) / space.unit;
            (*round)->radius /= space.unit;
            nearest_ = std::min(nearest_, std::abs((*round)->radius - (*round)->center.norm()));
        }
    }
}

// In double precision: balls and hollows may be much larger than the scene.
GroundHit Ground::first_hit(const Vec& from, const Vec& direction) const {
    const Eigen::Vector3d eye = from.cast<double>();
    const Eigen::Vector3d ray = direction.cast<double>();
    GroundHit hit;
    const auto meet = [&](double distance, const Eigen::Vector3d& normal) {
        if (distance > 0 && static_cast<float>(distance) < hit.distance) {
            hit.distance = static_cast<float>(distance);
            hit.normal = normal.cast<float>();
        }
    };
    if (slice_.plane && slice_.plane->normal.dot(ray) < 0) {
        const Plane& plane = *slice_.plane;
        const double distance = (plane.offset - plane.normal.dot(eye)) / plane.normal.dot(ray);
        const Eigen::Vector3d point = eye + distance * ray;
        if (!slice_.hollow || (point - slice_.hollow->center).norm() >= slice_.hollow->radius) {
            meet(distance, plane.normal);
        }
    }
    if (slice_.ball) {
        const Sphere& ball = *slice_.ball;
        const double distance = crossing(ball, eye, ray, -1);
        meet(distance, (eye + distance * ray - ball.center) / ball.radius);
    }
    if (slice_.hollow) {  // where the ray leaves the hollow it goes into the solid
        const Sphere& hollow = *slice_.hollow;
        const double distance = crossing(hollow, eye, ray, 1);
        const Eigen::Vector3d point = eye + distance * ray;
        if (!slice_.plane || slice_.plane->normal.dot(point) < slice_.plane->offset) {
            meet(distance, (hollow.center - point) / hollow.radius);
        }
    }
    return hit;
}

float Ground::spread(const Vec& point) const {
    const double distance = point.cast<double>().norm();
    const double square = (distance - nearest_) * (distance + nearest_);
    return static_cast<float>(std::sqrt(std::max(square, 0.0)));
}

}  // namespace pent::viewer
