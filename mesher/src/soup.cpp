#include "soup.h"

#include <Eigen/Geometry>

namespace pent::mesher {

std::size_t SoupBuilder::fan_start(std::span<const std::uint32_t> polygon) const {
    const std::size_t n = polygon.size();
    if (n == 3) {
        return 0;
    }
    const auto normal_of = [&](std::size_t start, std::size_t i) -> Eigen::Vector3d {
        const Eigen::Vector3d& a = points_[polygon[start]];
        return (points_[polygon[(start + i) % n]] - a)
            .cross(points_[polygon[(start + i + 1) % n]] - a);
    };
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // of the whole polygon, from any start
    for (std::size_t i = 1; i + 1 < n; ++i) {
        normal += normal_of(0, i);
    }
    for (std::size_t start = 0; start < n; ++start) {
        bool is_turned = false;
        for (std::size_t i = 1; i + 1 < n && !is_turned; ++i) {
            is_turned = normal_of(start, i).dot(normal) <= 0;
        }
        if (!is_turned) {
            return start;
        }
    }
    return 0;
}

void SoupBuilder::add_polygon(std::span<const std::uint32_t> polygon) {
    const std::size_t n = polygon.size();
    const std::size_t start = fan_start(polygon);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        corners_.push_back(polygon[start]);
        corners_.push_back(polygon[(start + i) % n]);
        corners_.push_back(polygon[(start + i + 1) % n]);
    }
}

TriangleSoup SoupBuilder::soup() const {
    TriangleSoup soup;
    soup.points.resize(3, point_count());
    for (std::size_t i = 0; i < points_.size(); ++i) {
        soup.points.col(static_cast<Eigen::Index>(i)) = points_[i];
    }
    soup.triangles = Eigen::Map<const Simplices<3>>(corners_.data(), 3,
                                                    static_cast<Eigen::Index>(corners_.size() / 3));
    soup.left_out = left_out_;
    return soup;
}

}  // namespace pent::mesher
