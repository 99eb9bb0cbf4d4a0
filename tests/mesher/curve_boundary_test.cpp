#include "support/messages.h"

#include <pent/error.h>
#include <pent/mesher/curve_boundary.h>
#include <pent/mesher/make_body.h>
#include <pent/mesher/primitives.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/stuff.h>
#include <pent/mesher/subdivide.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <ostream>
#include <vector>

namespace pent::mesher {
namespace {

using Eigen::Vector4d;
using pent::test::error_of;
using pent::test::expect_contains;

constexpr double kPi = std::numbers::pi;

TEST(CutEdges, HaveTheirMiddlesAtTheVerticesBehindThoseOfTheMesh) {
    const SimplexMesh<4> mesh = box<4>({2, 1, 1, 1}, {2, 1, 1, 1}, CubeCut::Paths);
    const SimplexMesh<4> fine = make_quadratic<4>(mesh);
    const auto edges = cut_edges<4>(mesh);
    ASSERT_EQ(static_cast<Eigen::Index>(edges.size()), fine.vertex_count() - mesh.vertex_count());
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const Vector4d middle =
            (mesh.positions.col(edges[i][0]) + mesh.positions.col(edges[i][1])) / 2;
        EXPECT_EQ(fine.positions.col(mesh.vertex_count() + static_cast<Eigen::Index>(i)), middle);
    }
}

// Of tetrahedra with ten nodes: their Jacobian is of degree 3, for which Keast's rule is exact,
// -4/5 at the center and 9/20 at points halfway between it and the corners.
double curved_volume(const SimplexMesh<3>& straight, const SimplexMesh<3>& quadratic) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    auto next = static_cast<std::uint32_t>(straight.vertex_count());
    for (const auto& [a, b] : cut_edges<3>(straight)) {
        middles[std::minmax(a, b)] = next++;
    }
    double volume = 0;
    for (Eigen::Index cell = 0; cell < straight.cell_count(); ++cell) {
        const auto jacobian = [&](const Eigen::Vector4d& l) {
            Eigen::Matrix<double, 3, 4> corners;
            for (int a = 0; a < 4; ++a) {
                const std::uint32_t own = straight.cells(a, cell);
                corners.col(a) = (4 * l[a] - 1) * quadratic.positions.col(own);
                for (int b = 0; b < 4; ++b) {
                    if (a != b) {
                        corners.col(a) += 4 * l[b]
                                          * quadratic.positions.col(middles.at(
                                              std::minmax(own, straight.cells(b, cell))));
                    }
                }
            }
            return simplex_volume<3>(corners);
        };
        volume -= 0.8 * jacobian(Vector4d::Constant(0.25));
        for (int a = 0; a < 4; ++a) {
            Vector4d l = Vector4d::Constant(1.0 / 6);
            l[a] = 0.5;
            volume += 0.45 * jacobian(l);
        }
    }
    return volume;
}

// Of the map from barycentric coordinates to space, at the nodes of all cells and at the points of
// elements, by differences: of one row of coordinates along another.
template <int Dim>
double least_jacobian(const SimplexMesh<Dim>& straight, const SimplexMesh<Dim>& quadratic) {
    using Coordinates = Eigen::Matrix<double, Dim + 1, 1>;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    auto next = static_cast<std::uint32_t>(straight.vertex_count());
    for (const auto& [a, b] : cut_edges<Dim>(straight)) {
        middles[std::minmax(a, b)] = next++;
    }
    std::vector<Coordinates> points;
    const double far = (Dim + 2 - std::sqrt(Dim + 2.0)) / ((Dim + 1) * (Dim + 2));
    for (int a = 0; a <= Dim; ++a) {
        points.push_back(Coordinates::Constant(far));
        points.back()[a] = 1 - Dim * far;
        for (int b = a; b <= Dim; ++b) {
            points.push_back((Coordinates::Unit(a) + Coordinates::Unit(b)) / 2);
        }
    }
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index cell = 0; cell < straight.cell_count(); ++cell) {
        const auto own = straight.cells.col(cell);
        const auto place = [&](const Coordinates& l) {
            Eigen::Matrix<double, Dim, 1> x = Eigen::Matrix<double, Dim, 1>::Zero();
            for (int a = 0; a <= Dim; ++a) {
                x += l[a] * (2 * l[a] - 1) * quadratic.positions.col(own[a]);
                for (int b = a + 1; b <= Dim; ++b) {
                    x += 4 * l[a] * l[b]
                         * quadratic.positions.col(middles.at(std::minmax(own[a], own[b])));
                }
            }
            return x;
        };
        for (const Coordinates& l : points) {
            constexpr double kStep = 1e-3;  // differences of quadratics are exact
            Eigen::Matrix<double, Dim, Dim> slopes;
            for (int axis = 0; axis < Dim; ++axis) {
                const Coordinates way =
                    kStep * (Coordinates::Unit(axis + 1) - Coordinates::Unit(0));
                slopes.col(axis) = (place(l + way) - place(l - way)) / (2 * kStep);
            }
            least = std::min(least, slopes.determinant());
        }
    }
    return least;
}

TEST(CurvedBall, HasItsMiddlesOnTheSphereAndNearlyItsVolume) {
    SimplexMesh<3> straight = ball(4);
    straight.positions *= 2;
    SimplexMesh<3> quadratic = make_quadratic<3>(straight);
    const CurveReport report = curve_boundary<3>(straight, onto_sphere(2), quadratic);
    EXPECT_EQ(report.moved, 480);  // 320 triangles have so many edges
    std::int64_t on_sphere = 0;
    for (Eigen::Index v = straight.vertex_count(); v < quadratic.vertex_count(); ++v) {
        on_sphere += std::abs(quadratic.positions.col(v).norm() - 2) < 1e-12 ? 1 : 0;
    }
    EXPECT_EQ(on_sphere, 480);
    const double volume = 4.0 / 3 * kPi * 8;
    // Of fourth order in place of second: edges are 0.3 radii long.
    EXPECT_GT(volume - total_volume(straight), 0.02 * volume);
    EXPECT_NEAR(curved_volume(straight, quadratic), volume, 2e-4 * volume);
}

TEST(CurvedSolid, HasTheMiddlesOfItsBoundaryOnItAndIsProven) {
    for (const Solid& solid : {ball_solid(1), duocylinder_solid({1, 0.8})}) {
        const SimplexMesh<4> straight = stuff(solid, 0.3).mesh;
        SimplexMesh<4> quadratic = make_quadratic<4>(straight);
        const SimplexMesh<4> before = quadratic;
        const CurveReport report = curve_boundary<4>(straight, onto_boundary(solid), quadratic);
        EXPECT_GT(report.moved, 0);
        EXPECT_LT(report.farthest, 0.1);  // a circle of 0.8 is 0.03 above the chord of an edge
        std::int64_t moved = 0;
        for (Eigen::Index v = 0; v < quadratic.vertex_count(); ++v) {
            if (quadratic.positions.col(v) != before.positions.col(v)) {
                EXPECT_GE(v, straight.vertex_count());
                EXPECT_LT(std::abs(solid.value(quadratic.positions.col(v))), 1e-5);
                ++moved;
            }
        }
        EXPECT_EQ(moved, report.moved);
        EXPECT_TRUE(prove<4>(quadratic, 0).holds());
    }
}

// Whatever a surface asks for, cells are whole at every point that elements see, and every linear
// cell is: what would fold them goes a part of its way, all others the whole of it.
TEST(CurvedBoundary, GoesNoFurtherThanCellsStayWhole) {
    const SimplexMesh<3> straight = box<3>({1, 1, 1}, {1, 1, 1}, CubeCut::Paths);
    SimplexMesh<3> quadratic = make_quadratic<3>(straight);
    const CurveReport report = curve_boundary<3>(
        straight,
        [](const Eigen::Vector3d& from, const Eigen::Vector3d& to) -> Eigen::Vector3d {
            return from.norm() + to.norm() > 2.7 ? (from + to) / 2 : from;
        },
        quadratic);
    EXPECT_GT(report.limited, 0);
    EXPECT_TRUE(prove<3>(quadratic, 0).holds());
    EXPECT_GT(least_jacobian<3>(straight, quadratic), 0);
}

struct NativeShape {
    const char* name;
    Solid solid;
    double longest;  // edges at which the shape is just resolved, m
};

void PrintTo(const NativeShape& shape, std::ostream* out) {
    *out << shape.name;
}

class CurvedShape : public testing::TestWithParam<NativeShape> {};

INSTANTIATE_TEST_SUITE_P(
    All,
    CurvedShape,
    testing::Values(NativeShape{"ball", ball_solid(1), 0.6},
                    NativeShape{"capsule", capsule_solid(0.6, 1), 0.6},
                    NativeShape{"spherinder", spherinder_solid(0.8, 1.2), 0.6},
                    NativeShape{"cubinder", cubinder_solid(0.8, {1.2, 1.2}), 0.6},
                    NativeShape{"duocylinder", duocylinder_solid({0.8, 0.8}), 0.6},
                    NativeShape{"spheritorus", spheritorus_solid(0.8, 0.35), 0.45},
                    NativeShape{"torisphere", torisphere_solid(0.8, 0.35), 0.6},
                    NativeShape{"tiger", tiger_solid({0.8, 0.8}, 0.35), 0.6},
                    NativeShape{"ditorus", ditorus_solid({0.9, 0.5}, 0.25), 0.45},
                    NativeShape{"clifford_torus", clifford_torus_solid(1, 0.7), 0.6},
                    NativeShape{"box", box_solid({1.5, 1.2, 1, 1.3}), 0.6},
                    NativeShape{"polytope", polytope_solid(24, 1), 0.6}),
    [](const auto& shape) { return shape.param.name; });

// Also along ridges, which stay where they are, and where edges are as long as the body is thick.
TEST_P(CurvedShape, IsWholeOfEveryEdgeLength) {
    const NativeShape& shape = GetParam();
    for (const double part : {1.0, 0.9, 0.8, 0.7}) {
        const SimplexMesh<4> straight = stuff(shape.solid, part * shape.longest).mesh;
        SimplexMesh<4> quadratic = make_quadratic<4>(straight);
        const SimplexMesh<4> before = quadratic;
        const CurveReport report =
            curve_boundary<4>(straight, onto_boundary(shape.solid), quadratic);
        EXPECT_TRUE(prove<4>(quadratic, 0).holds()) << part;
        EXPECT_GT(least_jacobian<4>(straight, quadratic), 0) << part;
        const auto edges = cut_edges<4>(straight);
        std::int64_t off = 0;
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const Eigen::Index v = straight.vertex_count() + static_cast<Eigen::Index>(i);
            const Vector4d from = straight.positions.col(edges[i][0]);
            const Vector4d to = straight.positions.col(edges[i][1]);
            const double most = 1e-5 * (to - from).norm();
            if (quadratic.positions.col(v) == before.positions.col(v)) {
                continue;
            }
            // On all pieces that the edge has its ends on, or between it and them.
            double largest = 0;
            for (int piece = 0; piece < shape.solid.piece_count(); ++piece) {
                const auto value_at = [&](const Vector4d& p) {
                    return std::abs(shape.solid.piece_value(piece, p));
                };
                if (value_at(from) <= most && value_at(to) <= most) {
                    const double value = value_at(quadratic.positions.col(v));
                    EXPECT_LE(value, value_at(before.positions.col(v)) + most);
                    largest = std::max(largest, value);
                }
            }
            off += largest > most ? 1 : 0;
        }
        EXPECT_LE(off, report.limited) << part;
    }
}

TEST(CurvedBody, IsForQuadraticCellsOfSurfacesThatAreNotFlat) {
    BodyRequest request;
    request.input = BallShape{};
    request.is_curved = true;
    expect_contains(error_of([&] { static_cast<void>(make_solid(request)); }),
                    {"a curved boundary is for quadratic cells"});
    request.is_quadratic = true;
    EXPECT_EQ(make_solid(request).report.curve.moved, 480);
    request.subdivide = 2;
    expect_contains(error_of([&] { static_cast<void>(make_solid(request)); }),
                    {"not subdivided before"});
    request.subdivide = 1;
    request.input = SphereShape{};
    request.tetrahedra.worker = PENT_TETGEN_WORKER;
    EXPECT_GT(make_solid(request).report.curve.moved, 400);
    request.edge_length = 0.4;
    expect_contains(error_of([&] { static_cast<void>(make_solid(request)); }),
                    {"the sphere: its surface was made anew", "leave out"});
    request.edge_length = 0;
    request.input = BoxShape{};
    expect_contains(error_of([&] { static_cast<void>(make_body(request)); }),
                    {"its surface is flat between its vertices"});
}

}  // namespace
}  // namespace pent::mesher
