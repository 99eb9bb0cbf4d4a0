#include <pent/surface_measures.h>

#include <Eigen/Geometry>

namespace pent {

double triangle_area(const Positions<3>& points, const Simplices<3>& triangles) {
    double twice = 0;
    for (const auto& t : triangles.colwise()) {
        const Eigen::Vector3d a = points.col(t[0]);
        const Eigen::Vector3d b = points.col(t[1]);
        const Eigen::Vector3d c = points.col(t[2]);
        twice += (b - a).cross(c - a).norm();
    }
    return twice / 2;
}

double enclosed_volume(const Positions<3>& points, const Simplices<3>& triangles) {
    if (triangles.cols() == 0) {
        return 0;
    }
    const Eigen::Vector3d origin = points.col(0);
    double six_volume = 0;
    for (const auto& t : triangles.colwise()) {
        const Eigen::Vector3d a = points.col(t[0]) - origin;
        const Eigen::Vector3d b = points.col(t[1]) - origin;
        const Eigen::Vector3d c = points.col(t[2]) - origin;
        six_volume += a.cross(b).dot(c);
    }
    return six_volume / 6;
}

}  // namespace pent
