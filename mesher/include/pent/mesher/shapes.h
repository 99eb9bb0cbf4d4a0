#pragma once

#include <pent/mesher/surface.h>

#include <array>

namespace pent::mesher {

/// How each cube of a box is cut.
enum class CubeCut {
    Paths,    ///< Dim! simplices along the paths from the lowest to the highest corner (Kuhn).
    Corners,  ///< Every second corner cut off, the rest around one diagonal: 2, 5 or 16 simplices.
};

/// A box of cubes, from the origin; the middle of the other axes is at 0 only if it is moved there.
/// Neighboring cubes agree: Paths cut all alike, Corners mirror every second one.
///
/// @param count  Cubes along each axis, 1 or more.
/// @param size   Edge of the box along each axis, m, above 0.
/// Throws an Error for counts or sizes out of range.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> box(const std::array<int, Dim>& count,
                                   const std::array<double, Dim>& size,
                                   CubeCut cut = CubeCut::Paths);

/// The unit sphere around the origin as an icosahedron with edges cut in `frequency` parts and all
/// points moved outward: 20 frequency^2 triangles, 10 frequency^2 + 2 points.
///
/// @param frequency  1 to 1000.
[[nodiscard]] Surface sphere(int frequency);

/// The tetrahedra between the triangles of sphere() and the origin: 20 frequency^2 of them. The
/// origin is the last point.
[[nodiscard]] SimplexMesh<3> ball(int frequency);

}  // namespace pent::mesher
