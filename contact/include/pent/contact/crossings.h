#pragma once

#include <pent/contact/contact_scene.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pent::contact {

enum class CrossingKind : std::uint8_t {
    Through,   ///< Two simplices go through each other.
    Touching,  ///< Two simplices are not further apart than they have to be.
    Inside,    ///< A vertex is inside another body or an obstacle.
};

/// Two simplices that should not be where they are.
struct Crossing {
    CrossingKind kind = CrossingKind::Through;
    Collider first;  ///< A body.
    Collider second;
    std::vector<std::uint32_t> first_corners;   ///< Vertices of the scene.
    std::vector<std::uint32_t> second_corners;  ///< None of an obstacle, or for Inside.
    double distance = 0;                        ///< m; 0 for Through.
};

/// "edge 3-7 of 'a' goes through tetrahedron 10-11-12-13 of 'b'": one line. Vertices are counted
/// within each body, from its lowest.
template <int Dim>
[[nodiscard]] std::string describe(const Crossing& crossing, const ContactScene<Dim>& scene);

}  // namespace pent::contact
