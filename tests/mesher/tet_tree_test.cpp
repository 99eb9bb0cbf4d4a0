#include "shapes/tet_tree.h"

#include "shapes/exact_signs.h"

#include <pent/exchange/tet_surface.h>
#include <pent/geometry.h>
#include <pent/mesher/primitives.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/stuff.h>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

namespace pent::mesher {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

Vector4d random_point(std::mt19937& random, double size = 1) {
    std::uniform_real_distribution<double> uniform(-size, size);
    return Vector4d(uniform(random), uniform(random), uniform(random), uniform(random));
}

Matrix4d random_corners(std::mt19937& random) {
    Matrix4d corners;
    for (int i = 0; i < 4; ++i) {
        corners.col(i) = random_point(random);
    }
    return corners;
}

// A tetrahedron, or one in a plane, on a line or in a point.
Matrix4d random_simplex(int kind, std::mt19937& random) {
    Matrix4d corners = random_corners(random);
    for (int i = 3; i > 3 - kind; --i) {
        corners.col(i) = 0.3 * corners.col(0) + 0.7 * corners.col(i - 1);
    }
    return corners;
}

// The nearest point of a convex set is the one from which no corner is on the point's side.
TEST(NearestPoint, HasNoCornerOnThePointsSideOfIt) {
    std::mt19937 random(1);
    for (int i = 0; i < 4000; ++i) {
        const Matrix4d corners = random_simplex(i % 4, random);
        const Vector4d p = random_point(random, i % 8 < 4 ? 2 : 0.3);
        const Vector4d nearest = nearest_point(corners, p);
        for (int k = 0; k < 4; ++k) {
            // Sizes are about 2; what is flatter than 3e-7 of it counts as flat.
            EXPECT_LE((p - nearest).dot(corners.col(k) - nearest), 1e-6) << i;
        }
        Eigen::Matrix<double, 5, 4> system;
        system << corners, Eigen::RowVector4d::Ones();
        Eigen::Vector<double, 5> target;
        target << nearest, 1;
        const Vector4d weights = system.completeOrthogonalDecomposition().solve(target);
        EXPECT_LT((system * weights - target).norm(), 1e-6) << i;
        if (i % 4 == 0) {
            EXPECT_GE(weights.minCoeff(), -1e-9) << i;
        }
    }
}

// Tetrahedra with corners of their own, each named by its place in the tree.
TetTree tree_of(const std::vector<Matrix4d>& all) {
    std::vector<Vector4d> points;
    std::vector<TetTree::Tetrahedron> tetrahedra;
    for (const Matrix4d& corners : all) {
        const auto first = static_cast<std::uint32_t>(points.size());
        for (int i = 0; i < 4; ++i) {
            points.emplace_back(corners.col(i));
        }
        tetrahedra.push_back({first, first + 1, first + 2, first + 3});
    }
    return {points, tetrahedra};
}

std::vector<Matrix4d> scattered(int count, std::mt19937& random) {
    std::vector<Matrix4d> all;
    for (int i = 0; i < count; ++i) {
        const Vector4d middle = random_point(random, 2);
        all.push_back((0.3 * random_simplex(i % 20 == 0 ? 1 : 0, random)).colwise() + middle);
    }
    return all;
}

TEST(TetTree, KeepsEveryTetrahedron) {
    std::mt19937 random(5);
    const std::vector<Matrix4d> all = scattered(100, random);
    const TetTree tree = tree_of(all);
    ASSERT_EQ(tree.count(), 100U);
    for (std::uint32_t t = 0; t < tree.count(); ++t) {
        EXPECT_EQ(std::count(all.begin(), all.end(), tree.corners(t)), 1);
        const Matrix4d own = tree.corners(t);
        const bool is_flat = facet_normal<4>(own).norm() < 1e-9;
        for (int i = 1; i < 4 && !is_flat; ++i) {
            EXPECT_NEAR(tree.normal(t).dot(own.col(i) - own.col(0)), 0, 1e-14);
        }
    }
}

// Boxes and balls are rounded, to 1e-5 m of what is a kilometer away, but outward alone: a point
// that lies on a tetrahedron is found, however near to it one is asked for.
TEST(TetTree, FindsWhatAPointLiesOnOrJustBeside) {
    std::mt19937 random(8);
    std::vector<Matrix4d> all = scattered(200, random);
    for (Matrix4d& corners : all) {
        corners.colwise() += Vector4d(1000.0 / 3, -2000.0 / 3, 1000.0 / 7, 500.0 / 9);
    }
    const TetTree tree = tree_of(all);
    constexpr double kNear = 1e-9;  // much less than that, and much more than doubles are rounded
    for (std::uint32_t t = 0; t < tree.count(); ++t) {
        const Matrix4d own = tree.corners(t);
        for (int corner = 0; corner < 4; ++corner) {
            for (const Vector4d& p : {Vector4d(own.col(corner)), Vector4d(own.rowwise().mean()),
                                      Vector4d((own.col(corner) + own.col(0)) / 2)}) {
                EXPECT_LT(tree.nearest(p, TetTree::kAnyPatch, kNear).distance_squared,
                          kNear * kNear);
                bool is_within = false;
                tree.visit_within(p, kNear, [&](std::uint32_t one) { is_within |= one == t; });
                EXPECT_TRUE(is_within);
            }
        }
        // Beside it by less than boxes are rounded.
        for (int axis = 0; axis < 4; ++axis) {
            Eigen::Index corner = 0;
            own.row(axis).maxCoeff(&corner);
            const Vector4d beside = own.col(corner) + 1e-6 * Vector4d::Unit(axis);
            EXPECT_LT(tree.nearest(beside, TetTree::kAnyPatch, 2e-6).distance_squared, 1.001e-12);
            bool is_within = false;
            tree.visit_within(beside, 2e-6, [&](std::uint32_t one) { is_within |= one == t; });
            EXPECT_TRUE(is_within);
        }
    }
}

TEST(TetTree, FindsWhatALookAtEveryTetrahedronFinds) {
    std::mt19937 random(2);
    TetTree tree = tree_of(scattered(300, random));
    std::vector<int> patches;
    for (std::uint32_t t = 0; t < tree.count(); ++t) {
        // By place, as patches are, but for some in no patch.
        const double x = tree.corners(t)(0, 0);
        patches.push_back(t % 7 == 0 ? TetTree::kNoPatch : x < -0.5 ? 2 : x < 0.5 ? 0 : 1);
    }
    tree.set_patches(patches);
    for (int i = 0; i < 200; ++i) {
        const Vector4d p = random_point(random, 3);
        const int asked = i % 4 - 1;
        double least = 1e9;
        std::set<std::uint32_t> near;
        for (std::uint32_t t = 0; t < tree.count(); ++t) {
            const double distance = (nearest_point(tree.corners(t), p) - p).norm();
            if (patches[t] == asked || (asked == TetTree::kAnyPatch && patches[t] >= 0)) {
                least = std::min(least, distance);
            }
            if (distance <= 1 && patches[t] != TetTree::kNoPatch) {
                near.insert(t);
            }
        }
        const NearestPoint found = tree.nearest(p, asked);
        EXPECT_DOUBLE_EQ(found.distance_squared, least * least);
        EXPECT_EQ((nearest_point(tree.corners(found.tetrahedron), p) - found.place).norm(), 0);
        EXPECT_TRUE(asked == TetTree::kAnyPatch || tree.patch(found.tetrahedron) == asked);
        std::set<std::uint32_t> within;
        tree.visit_within(p, 1, [&](std::uint32_t t) { within.insert(t); });
        EXPECT_EQ(within, near);
        std::set<std::uint32_t> on_ray;
        tree.visit_ray(p, [&](std::uint32_t t) { on_ray.insert(t); });
        for (std::uint32_t t = 0; t < tree.count(); ++t) {
            const Matrix4d own = tree.corners(t);
            if (crossing_sign(own, p) != 0) {
                EXPECT_TRUE(on_ray.contains(t));
            }
        }
    }
}

// Patches by number, more than nodes can tell apart, around which all is smooth or flat: what discs
// are made for.
TEST(TetTree, FindsTheNearestOfEveryPatchOfASmoothSurface) {
    std::mt19937 random(3);
    for (const bool is_flat : {false, true}) {
        const SimplexMesh<4> body = is_flat ? box<4>({1, 1, 1, 1}, {3, 3, 3, 3}, CubeCut::Paths)
                                            : stuff(ball_solid(1), 0.5).mesh;
        const exchange::TetSurface surface = exchange::boundary_of(body);
        std::vector<Vector4d> points;
        for (const auto& point : surface.points.colwise()) {
            points.emplace_back(point);
        }
        std::vector<TetTree::Tetrahedron> tetrahedra;
        for (const auto& own : surface.tetrahedra.colwise()) {
            tetrahedra.push_back({own[0], own[1], own[2], own[3]});
        }
        TetTree tree(points, tetrahedra);
        std::vector<int> patches;
        for (std::uint32_t t = 0; t < tree.count(); ++t) {
            patches.push_back(t < 70 ? static_cast<int>(t) : 70 + (tree.normal(t)[0] > 0 ? 1 : 0));
        }
        tree.set_patches(patches);
        for (int i = 0; i < 400; ++i) {
            const int asked = i % 4 == 0
                                  ? TetTree::kAnyPatch
                                  : patches[static_cast<std::size_t>(i) * 31 % patches.size()];
            // Some of them on the surface.
            const std::uint32_t own = static_cast<std::uint32_t>(i) % tree.count();
            const Vector4d p = i % 3 == 0 ? Vector4d(tree.corners(own).rowwise().mean())
                                          : random_point(random, 1.3);
            double least = 1e9;
            for (std::uint32_t t = 0; t < tree.count(); ++t) {
                if (patches[t] == asked || asked == TetTree::kAnyPatch) {
                    least = std::min(least, (nearest_point(tree.corners(t), p) - p).norm());
                }
            }
            EXPECT_NEAR(std::sqrt(tree.nearest(p, asked).distance_squared), least, 1e-14) << i;
        }
    }
}

TEST(TetTree, MeetsEveryTetrahedronOnASegmentUpToWhatIsAsked) {
    std::mt19937 random(4);
    const TetTree tree = tree_of(scattered(200, random));
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < 400; ++i) {
        // Through a point of a tetrahedron, for a fourth of them along an axis.
        const auto target = static_cast<std::uint32_t>(i) % tree.count();
        const Vector4d weights = random_point(random).cwiseAbs();
        const Vector4d through = tree.corners(target) * (weights / weights.sum());
        const Vector4d way =
            i % 4 == 0 ? Vector4d(Vector4d::Unit(i / 4 % 4)) : random_point(random, 2);
        const double part = uniform(random);
        const Vector4d from = through - part * way;
        const auto met = [&](double asked) {
            std::set<std::uint32_t> all;
            tree.visit_segment(from, way, [&](std::uint32_t t) {
                all.insert(t);
                return asked;
            });
            return all;
        };
        EXPECT_TRUE(met(1).contains(target)) << i;
        EXPECT_TRUE(met(part).contains(target)) << i;
        EXPECT_LE(met(0).size(), met(1).size()) << i;
    }
}

// The 16-cell with corners at 2 on each axis, cut at whole numbers: rays run through corners, along
// edges and within faces of it.
TEST(CrossingSign, CountsEveryRayOnceInAndOnceOutAlsoAlongFaces) {
    for (int code = 0; code < 625 * 5; ++code) {
        const double last = code % 5 - 2.25;  // off the boundary itself
        const Vector4d p(code / 5 % 5 - 2, code / 25 % 5 - 2, code / 125 % 5 - 2, last);
        int sum = 0;
        for (unsigned signs = 0; signs < 16; ++signs) {
            Matrix4d corners = Matrix4d::Zero();
            bool is_outward = true;
            for (unsigned axis = 0; axis < 4; ++axis) {
                const bool is_negative = (signs >> axis & 1U) != 0;
                corners(axis, axis) = is_negative ? -2 : 2;
                is_outward = is_outward != is_negative;
            }
            if (!is_outward) {
                corners.col(0).swap(corners.col(1));
            }
            sum += crossing_sign(corners, p);
        }
        // As det[axes] > 0, the shadow of the upper side of a corner's cell is turned over.
        EXPECT_EQ(std::abs(sum), p.lpNorm<1>() < 2 ? 1 : 0) << p.transpose();
    }
}

TEST(CrossingSign, IsExactWhereRoundingWouldDecide) {
    Matrix4d corners;
    corners << 0, 1, 0, 0,  //
        0, 0, 1, 0,         //
        0, 0, 0, 1,         //
        0, 0.1, 0.2, 0.3;
    // The height over (1/4, 1/4, 1/4) is that of 0.1/4 + 0.2/4 + 0.3/4 as they are in binary.
    const double height = (0.1 + 0.2 + 0.3) / 4;
    int changes = 0;
    int last = 0;
    for (int ulps = -8; ulps <= 8; ++ulps) {
        const Vector4d p(0.25, 0.25, 0.25, height * (1 + ulps * 0x1p-52));
        const int sign = std::abs(crossing_sign(corners, p));
        changes += ulps > -8 && sign != last ? 1 : 0;
        EXPECT_TRUE(ulps == -8 || sign <= last) << "further up nothing is above again";
        last = sign;
    }
    EXPECT_EQ(changes, 1);
}

}  // namespace
}  // namespace pent::mesher
