#include "extract.h"

#include <algorithm>
#include <vector>

namespace pent::mesher {

Surface extract(const Surface& surface, std::span<const std::uint32_t> triangles) {
    std::vector<std::uint32_t> used;
    for (const std::uint32_t t : triangles) {
        for (int i = 0; i < 3; ++i) {
            used.push_back(surface.triangles(i, t));
        }
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    Surface result;
    result.points.resize(3, static_cast<Eigen::Index>(used.size()));
    for (std::size_t i = 0; i < used.size(); ++i) {
        result.points.col(static_cast<Eigen::Index>(i)) = surface.points.col(used[i]);
    }
    result.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (int i = 0; i < 3; ++i) {
            const auto place =
                std::lower_bound(used.begin(), used.end(), surface.triangles(i, triangles[t]));
            result.triangles(i, static_cast<Eigen::Index>(t)) =
                static_cast<std::uint32_t>(place - used.begin());
        }
    }
    return result;
}

}  // namespace pent::mesher
