#include <pent/surface_measures.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>

namespace pent {
namespace {

// A tetrahedron somewhere, its faces counterclockwise from outside.
struct Tetrahedron {
    Positions<3> points{3, 4};
    Simplices<3> faces{3, 4};

    explicit Tetrahedron(double far) {
        points << 0, 1, 0.2, 0.3, 0, 0.1, 2, 0.4, 0, -0.2, 0.3, 3;
        points.array() += far;
        faces << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3;
    }
    [[nodiscard]] Eigen::Matrix3d edges() const {
        return points.rightCols<3>().colwise() - points.col(0);
    }
};

TEST(SurfaceMeasures, OfATetrahedronAreThoseOfItsEdges) {
    for (const double far : {0.0, -3.0, 1e6}) {
        const Tetrahedron shape(far);
        const double rounding = 1e-14 * (1 + std::abs(far));  // of the coordinates
        EXPECT_NEAR(enclosed_volume(shape.points, shape.faces), shape.edges().determinant() / 6,
                    10 * rounding);
        double area = 0;
        for (const auto& face : shape.faces.colwise()) {  // Heron's
            const double a = (shape.points.col(face[0]) - shape.points.col(face[1])).norm();
            const double b = (shape.points.col(face[1]) - shape.points.col(face[2])).norm();
            const double c = (shape.points.col(face[2]) - shape.points.col(face[0])).norm();
            const double half = (a + b + c) / 2;
            area += std::sqrt(half * (half - a) * (half - b) * (half - c));
        }
        EXPECT_NEAR(triangle_area(shape.points, shape.faces), area, 100 * rounding);
    }
}

TEST(SurfaceMeasures, ChangeSignWithTheOrientationAndTheSquareAndCubeOfTheScale) {
    Tetrahedron shape(0.7);
    const double volume = enclosed_volume(shape.points, shape.faces);
    const double area = triangle_area(shape.points, shape.faces);
    EXPECT_GT(volume, 0);
    shape.points *= 2;
    EXPECT_EQ(enclosed_volume(shape.points, shape.faces), 8 * volume);  // powers of two are exact
    EXPECT_EQ(triangle_area(shape.points, shape.faces), 4 * area);
    shape.faces.row(1).swap(shape.faces.row(2));
    EXPECT_NEAR(enclosed_volume(shape.points, shape.faces), -8 * volume, 1e-14);
    EXPECT_EQ(triangle_area(shape.points, shape.faces), 4 * area);
}

TEST(SurfaceMeasures, AreZeroWithoutATriangle) {
    EXPECT_EQ(triangle_area({}, {}), 0);
    EXPECT_EQ(enclosed_volume({}, {}), 0);
}

}  // namespace
}  // namespace pent
