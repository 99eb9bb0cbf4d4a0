#include "shapes/tet_tree.h"

#include "shapes/exact_signs.h"

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
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

TEST(TetTree, FindsWhatALookAtEveryTetrahedronFinds) {
    std::mt19937 random(2);
    std::vector<Matrix4d> corners;
    for (int i = 0; i < 300; ++i) {
        const Vector4d middle = random_point(random, 2);
        corners.push_back((0.3 * random_corners(random)).colwise() + middle);
    }
    std::vector<std::uint32_t> names(corners.size());
    std::iota(names.begin(), names.end(), 1000U);
    const TetTree tree(corners, names);
    for (int i = 0; i < 200; ++i) {
        const Vector4d p = random_point(random, 3);
        double least = 1e9;
        std::set<std::uint32_t> near;
        for (std::size_t t = 0; t < corners.size(); ++t) {
            const double distance = (nearest_point(corners[t], p) - p).norm();
            least = std::min(least, distance);
            if (distance <= 1) {
                near.insert(names[t]);
            }
        }
        const NearestPoint found = tree.nearest(p);
        EXPECT_DOUBLE_EQ(found.distance_squared, least * least);
        EXPECT_EQ((nearest_point(corners[found.tetrahedron - 1000], p) - found.place).norm(), 0);
        std::set<std::uint32_t> within;
        tree.visit_within(p, 1, [&](std::uint32_t name) { within.insert(name); });
        EXPECT_EQ(within, near);
        std::set<std::uint32_t> on_ray;
        tree.visit_ray(p,
                       [&](std::uint32_t name, const Matrix4d& /*own*/) { on_ray.insert(name); });
        for (std::size_t t = 0; t < corners.size(); ++t) {
            if (crossing_sign(corners[t], p) != 0) {
                EXPECT_TRUE(on_ray.contains(names[t]));
            }
        }
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
