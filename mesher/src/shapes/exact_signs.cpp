#include "exact_signs.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/MP_Float.h>
#include <CGAL/determinant.h>
#include <array>
#include <cmath>

namespace pent::mesher {

namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point2 = Kernel::Point_2;
using Point3 = Kernel::Point_3;

Point3 shadow_of(const Vector4d& p) {
    return {p[0], p[1], p[2]};
}

int flat_sign(const std::array<Point3, 3>& t, int first, int second) {
    return CGAL::orientation(Point2(t[0][first], t[0][second]), Point2(t[1][first], t[1][second]),
                             Point2(t[2][first], t[2][second]));
}

// Sign of det[t1 - t0, t2 - t0, p - t0] for the perturbed point; 0 for flat triangles alone.
int side_sign(const std::array<Point3, 3>& t, const Point3& p) {
    const int sign = CGAL::orientation(t[0], t[1], t[2], p);
    if (sign != 0) {
        return sign;
    }
    for (const auto& [first, second] : {std::pair(1, 2), std::pair(2, 0), std::pair(0, 1)}) {
        if (const int of_axis = flat_sign(t, first, second); of_axis != 0) {
            return of_axis;
        }
    }
    return 0;
}

// Sign of det[b - a, c - a, d - a, p - a].
int height_sign(const Matrix4d& corners, const Vector4d& p) {
    Matrix4d edges;
    edges.leftCols<3>() = corners.rightCols<3>().colwise() - corners.col(0);
    edges.col(3) = p - corners.col(0);
    // Bounds the rounding of the differences and of some 40 operations on products of at most these
    // lengths, so that exact arithmetic, which is slow, is for the few that are closer to 0.
    constexpr double kRounding = 1e-14;
    const double bound =
        kRounding * edges.colwise().norm().prod()
        + kRounding * corners.cwiseAbs().maxCoeff() * edges.colwise().norm().array().cube().sum();
    const double value = CGAL::determinant(edges(0, 0), edges(0, 1), edges(0, 2), edges(0, 3),
                                           edges(1, 0), edges(1, 1), edges(1, 2), edges(1, 3),
                                           edges(2, 0), edges(2, 1), edges(2, 2), edges(2, 3),
                                           edges(3, 0), edges(3, 1), edges(3, 2), edges(3, 3));
    if (std::abs(value) > bound) {
        return value > 0 ? 1 : -1;
    }
    using Exact = CGAL::MP_Float;
    std::array<std::array<Exact, 4>, 4> e;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 3; ++column) {
            e[row][column] = Exact(corners(row, column + 1)) - Exact(corners(row, 0));
        }
        e[row][3] = Exact(p[row]) - Exact(corners(row, 0));
    }
    return CGAL::sign(CGAL::determinant(e[0][0], e[0][1], e[0][2], e[0][3], e[1][0], e[1][1],
                                        e[1][2], e[1][3], e[2][0], e[2][1], e[2][2], e[2][3],
                                        e[3][0], e[3][1], e[3][2], e[3][3]));
}

}  // namespace

int crossing_sign(const Matrix4d& corners, const Vector4d& point) {
    const std::array<Point3, 4> c = {shadow_of(corners.col(0)), shadow_of(corners.col(1)),
                                     shadow_of(corners.col(2)), shadow_of(corners.col(3))};
    const Point3 p = shadow_of(point);
    const int sign = CGAL::orientation(c[0], c[1], c[2], c[3]);
    // Whether the point is on the inner side of each face: with the point in place of each corner
    // the sign stays. Moving it to the last place, where side_sign() has it, turns every other one
    // over.
    const bool is_within = sign != 0 && side_sign({c[0], c[1], c[2]}, p) == sign
                           && side_sign({c[0], c[1], c[3]}, p) == -sign
                           && side_sign({c[0], c[2], c[3]}, p) == sign
                           && side_sign({c[1], c[2], c[3]}, p) == -sign;
    // Points beyond the tetrahedron have the sign of its shadow.
    return is_within && height_sign(corners, point) == -sign ? sign : 0;
}

}  // namespace pent::mesher
