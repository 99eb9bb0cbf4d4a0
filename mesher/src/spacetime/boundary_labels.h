#pragma once

#include <pent/mesher/moving_mesh.h>
#include <pent/mesher/space_time.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace pent::mesher {

using Triangle = std::array<std::uint32_t, 3>;

/// Labels of triangles of the base, by their sorted corners.
class TriangleLabels {
public:
    void add(Triangle corners, std::uint16_t label) {
        std::sort(corners.begin(), corners.end());
        known_.emplace_back(corners, label);
    }
    void sort() {
        std::stable_sort(known_.begin(), known_.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
    }
    /// 0 where there is none.
    [[nodiscard]] std::uint16_t of(const Triangle& corners) const {
        const auto found =
            std::lower_bound(known_.begin(), known_.end(), corners,
                             [](const auto& a, const Triangle& b) { return a.first < b; });
        return found != known_.end() && found->first == corners ? found->second : 0;
    }

private:
    std::vector<std::pair<Triangle, std::uint16_t>> known_;
};

/// What the first and the last layer of a body are.
struct EndLabels {
    BoundaryLabel first = BoundaryLabel::Bottom;
    BoundaryLabel last = BoundaryLabel::Top;
};

/// Labels every facet of the boundary of a body with columns, layers and regions.
void label_boundary(const SimplexMesh<4>& mesh,
                    const TriangleLabels& triangles,
                    const EndLabels& ends,
                    MeshExtras<4>& extras);

/// The labels of a moving mesh.
[[nodiscard]] TriangleLabels labels_of(const MovingMesh& moving);

/// The same as they stand at the sides of a body.
[[nodiscard]] TriangleLabels labels_of(const SpaceTimeBody& body);

}  // namespace pent::mesher
