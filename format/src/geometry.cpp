#include <pent/geometry.h>

namespace pent {

Eigen::Vector2d normal_to(const Eigen::Matrix<double, 2, 1>& edges) {
    return {-edges(1, 0), edges(0, 0)};
}

Eigen::Vector3d normal_to(const Eigen::Matrix<double, 3, 2>& edges) {
    return {edges(1, 0) * edges(2, 1) - edges(2, 0) * edges(1, 1),
            edges(2, 0) * edges(0, 1) - edges(0, 0) * edges(2, 1),
            edges(0, 0) * edges(1, 1) - edges(1, 0) * edges(0, 1)};
}

Eigen::Vector4d normal_to(const Eigen::Matrix<double, 4, 3>& edges) {
    const auto minor = [&](int a, int b, int c) {
        return edges(a, 0) * (edges(b, 1) * edges(c, 2) - edges(c, 1) * edges(b, 2))
               - edges(b, 0) * (edges(a, 1) * edges(c, 2) - edges(c, 1) * edges(a, 2))
               + edges(c, 0) * (edges(a, 1) * edges(b, 2) - edges(b, 1) * edges(a, 2));
    };
    return {-minor(1, 2, 3), minor(0, 2, 3), -minor(0, 1, 3), minor(0, 1, 2)};
}

}  // namespace pent
