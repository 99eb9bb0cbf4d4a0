#pragma once

#include <pent/simplex_mesh.h>

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace pent {

/// Which parts of bodies an obstacle keeps out where nothing may cross.
enum class Repels : std::uint8_t {
    Vertices,  ///< Enough where the free side is convex: facets lie between their vertices.
    Facets,    ///< Where a facet can cut the solid and no vertex does. The shape has a core, below.
};

/// What a field of a shape may be.
enum class ShapeField : std::uint8_t {
    Point,        ///< A vector, m.
    Direction,    ///< A vector of unit length, which has to be given.
    UpDirection,  ///< The same; along the second axis if it is not given.
    Number,       ///< Any finite number, m; 0 if it is not given.
    Length,       ///< A number above 0, m; or a vector of them.
    Axes,         ///< A rotation matrix, one axis a column; that of no turn if it is not given.
};

// A shape has a name, as scenes know it, and fields() calls visit(name, value, ShapeField) for each
// of its fields: readers, writers and checks of scenes follow from it. Dim is 3, 4, or
// Eigen::Dynamic in a scene, whose dimension is not known when it is compiled. A new shape is added
// here, to the list Obstacle too; docs/architecture.md tells what measures, slices and shows it.

/// Solid below a hyperplane: {x : normal . x < offset}.
template <int Dim>
struct HalfSpace {
    static constexpr const char* kName = "half_space";
    static constexpr Repels kRepels = Repels::Vertices;
    static constexpr bool kIsFreeSideConvex = true;
    Eigen::Matrix<double, Dim, 1> normal;  ///< Unit length, out of the solid.
    double offset = 0;                     ///< m.

    template <typename Shape, typename Visit>
    static void fields(Shape& shape, const Visit& visit) {
        visit("normal", shape.normal, ShapeField::Direction);
        visit("offset", shape.offset, ShapeField::Number);
    }
};

/// A solid ball; bodies stay outside.
template <int Dim>
struct Ball {
    static constexpr const char* kName = "ball";
    static constexpr Repels kRepels = Repels::Facets;
    static constexpr bool kIsFreeSideConvex = false;
    Eigen::Matrix<double, Dim, 1> center;  ///< m.
    double radius = 0;                     ///< m, > 0.

    template <typename Shape, typename Visit>
    static void fields(Shape& shape, const Visit& visit) {
        visit("center", shape.center, ShapeField::Point);
        visit("radius", shape.radius, ShapeField::Length);
    }
};

/// A hollow ball in a solid; bodies stay inside.
template <int Dim>
struct Cavity {
    static constexpr const char* kName = "cavity";
    static constexpr Repels kRepels = Repels::Vertices;
    static constexpr bool kIsFreeSideConvex = true;
    Eigen::Matrix<double, Dim, 1> center;  ///< m.
    double radius = 0;                     ///< m, > 0.

    template <typename Shape, typename Visit>
    static void fields(Shape& shape, const Visit& visit) {
        visit("center", shape.center, ShapeField::Point);
        visit("radius", shape.radius, ShapeField::Length);
    }
};

/// Half a hollow ball in solid ground: the ground is the half-space below the rim, the bowl is dug
/// into it. What goes over the rim lies on the ground beside it; there a facet may hang into the
/// ground between its vertices.
template <int Dim>
struct Bowl {
    static constexpr const char* kName = "bowl";
    static constexpr Repels kRepels = Repels::Vertices;
    static constexpr bool kIsFreeSideConvex = false;
    Eigen::Matrix<double, Dim, 1> center;  ///< Of the ball and of its rim, m.
    double radius = 0;                     ///< m, > 0.
    Eigen::Matrix<double, Dim, 1> up;      ///< Unit length, out of the ground.

    template <typename Shape, typename Visit>
    static void fields(Shape& shape, const Visit& visit) {
        visit("center", shape.center, ShapeField::Point);
        visit("radius", shape.radius, ShapeField::Length);
        visit("up", shape.up, ShapeField::UpDirection);
    }
};

/// A solid box around its center; bodies stay outside.
template <int Dim>
struct Cuboid {
    static constexpr const char* kName = "box";
    static constexpr Repels kRepels = Repels::Facets;
    static constexpr bool kIsFreeSideConvex = false;
    Eigen::Matrix<double, Dim, 1> center;  ///< m.
    Eigen::Matrix<double, Dim, 1> sides;   ///< Lengths, m, > 0.
    /// Which way the sides go, one a column; of a dimension that is not known when it is compiled
    /// it may have no numbers: along the axes.
    Eigen::Matrix<double, Dim, Dim> axes = Eigen::Matrix<double, Dim, Dim>::Identity(kSize, kSize);

    template <typename Shape, typename Visit>
    static void fields(Shape& shape, const Visit& visit) {
        visit("center", shape.center, ShapeField::Point);
        visit("sides", shape.sides, ShapeField::Length);
        visit("axes", shape.axes, ShapeField::Axes);
    }

private:
    static constexpr int kSize = Dim == Eigen::Dynamic ? 0 : Dim;
};

/// The shape of an obstacle and where it stands.
template <int Dim>
using ObstacleShape = std::variant<HalfSpace<Dim>, Ball<Dim>, Cavity<Dim>, Bowl<Dim>, Cuboid<Dim>>;

/// The name of its shape, as scenes know it.
template <int Dim>
[[nodiscard]] std::string_view name_of(const ObstacleShape<Dim>& obstacle);

/// The same obstacle with the dimension known.
template <int Dim>
[[nodiscard]] ObstacleShape<Dim> fixed_size(const ObstacleShape<Eigen::Dynamic>& obstacle);

/// One of every shape, with its fields of the given dimension not set: for readers to choose from.
[[nodiscard]] std::vector<ObstacleShape<Eigen::Dynamic>> all_shapes(int dimension);

/// A box as a mesh of 6 tetrahedra or 24 pentachora, which have all of its corners for vertices.
template <int Dim>
[[nodiscard]] SimplexMesh<Dim> to_mesh(const Cuboid<Dim>& box);

/// Whether the columns are unit vectors across one another, to 1e-9, and none mirrors the others.
[[nodiscard]] bool is_rotation(const Eigen::Ref<const Eigen::MatrixXd>& axes);

/// Throws an Error, beginning with `what`, unless numbers are finite, lengths > 0, directions of
/// unit length (to 1e-9), axes a rotation, and vectors of the dimension.
template <int Dim>
void check(const ObstacleShape<Dim>& obstacle, int dimension, const std::string& what);

}  // namespace pent
