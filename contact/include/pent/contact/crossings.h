#pragma once

#include <pent/contact/contacts.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pent::contact {

/// Whether two simplices of K + L = Dim + 2 corners have a point inside both in common: an edge and a
/// facet, and in R^4 two triangles. Two surfaces of dimension Dim - 1 cannot cross without such a pair:
/// the corners of what two crossing facets have in common are of these kinds.
///
/// Dim + 2 points have one affine dependency; the simplices cross if it is positive on one and negative
/// on the other [ziegler1995, Radon]. Its signs are determinants, in long double, and only those that
/// rounding cannot have decided count: where one is in doubt, a face of the pair is within rounding of
/// touching, which is for distances to tell.
template <int Dim, int K, int L>
[[nodiscard]] bool is_crossing(const Corners<Dim, K>& first, const Corners<Dim, L>& second);

enum class CrossingKind : std::uint8_t {
    Through,   ///< Two simplices go through each other.
    Touching,  ///< Two simplices are not further apart than they have to be.
    Inside,    ///< A vertex is inside another body.
};

/// Two simplices that should not be where they are.
struct Crossing {
    CrossingKind kind = CrossingKind::Through;
    std::int32_t first_body = 0;
    std::int32_t second_body = 0;       ///< -1 - i for obstacle i.
    std::vector<std::uint32_t> first;   ///< Corners, vertices of the scene.
    std::vector<std::uint32_t> second;  ///< Corners; empty for Inside and for obstacles.
    double distance = 0;                ///< m; 0 for Through.
};

/// All that crosses, touches or is inside something else at these positions.
///
/// @param separation  m, >= 0: pairs have to be further apart than this and than rounding (1e-12 of the
///                    largest coordinate).
/// @param is_held     One for each vertex of the scene: held vertices alone may touch.
/// @param self        Whether bodies meet themselves.
/// @param most        No more than these are looked for, in order of bodies.
template <int Dim>
[[nodiscard]] std::vector<Crossing> find_crossings(const std::vector<ContactBody<Dim>>& bodies,
                                                   const std::vector<Obstacle<Dim>>& obstacles,
                                                   const std::vector<bool>& is_held,
                                                   const PositionsView<Dim>& positions,
                                                   double separation,
                                                   bool self,
                                                   std::size_t most = 1000);

/// "edge 3-7 of 'a' goes through tetrahedron 10-11-12-13 of 'b'": one line. Vertices are counted within
/// each body, from its lowest.
template <int Dim>
[[nodiscard]] std::string describe(const Crossing& crossing,
                                   const std::vector<ContactBody<Dim>>& bodies);

}  // namespace pent::contact
