#include <pent/mesher/size_field.h>

#include <algorithm>
#include <cmath>

namespace pent::mesher {

double SizeField::distance(const Eigen::Vector4d& p) const {
    if (plane) {
        return std::abs(plane->normal.dot(p) - plane->offset) / plane->normal.norm();
    }
    return point ? (p - *point).norm() : 0;
}

double SizeField::edge_within(double shortest, const Eigen::Vector4d& center, double radius) const {
    const double nearest = std::max(distance(center) - radius, 0.0);
    return std::max(shortest, std::min(shortest + growth * nearest, longest));
}

}  // namespace pent::mesher
