#include "winding_number.h"

#include "boxes_around.h"
#include "scenes.h"

#include <pent/geometry.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

namespace pent::contact {
namespace {

template <typename T>
class WindingNumberTest : public testing::Test {
protected:
    static BoxTree facet_tree(const Surface<T::value>& surface,
                              const Positions<T::value>& positions) {
        return BoxTree(boxes_around<T::value, T::value>(surface.facets, positions, 0));
    }
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(WindingNumberTest, Dimensions);

TYPED_TEST(WindingNumberTest, GoesRoundEveryPointInsideOnce) {
    constexpr int kDim = TypeParam::value;
    for (const bool is_tilted : {false, true}) {
        SimplexMesh<kDim> mesh = test::cube<kDim>(2);
        // On the lattice every ray from a lattice point runs along edges of the surface.
        const Eigen::Matrix<double, kDim, kDim> rotation =
            is_tilted ? test::tilt<kDim>() : Eigen::Matrix<double, kDim, kDim>::Identity();
        mesh.positions = rotation * mesh.positions;
        const Surface<kDim> surface = make_surface<kDim>(mesh.cells, mesh.vertex_count());
        const BoxTree tree = TestFixture::facet_tree(surface, mesh.positions);
        const int steps = 9;  // -0.5, -0.125, .. through 0, 1, 2 and between
        int count = 1;
        for (int axis = 0; axis < kDim; ++axis) {
            count *= steps;
        }
        int compared = 0;
        for (int k = 0; k < count; ++k) {
            Vector<kDim> local;
            bool is_on_surface = false;
            bool is_inside = true;
            for (int axis = 0, rest = k; axis < kDim; ++axis, rest /= steps) {
                local[axis] = -1 + 0.5 * (rest % steps);
                is_inside = is_inside && local[axis] > 0 && local[axis] < 2;
                is_on_surface = is_on_surface || local[axis] == 0 || local[axis] == 2;
            }
            const bool is_outside_anyway = local.minCoeff() < 0 || local.maxCoeff() > 2;
            if (is_on_surface && !is_outside_anyway) {
                continue;
            }
            ++compared;
            EXPECT_EQ(winding_number<kDim>(surface, tree, mesh.positions, rotation * local),
                      is_inside ? 1 : 0)
                << local.transpose();
        }
        EXPECT_GT(compared, count / 2);
    }
}

// Rays through corners pass by all facets there, within rounding: whatever the order in which these
// have the corners that they share, one of them is met, or both sides of a corner outside.
TYPED_TEST(WindingNumberTest, IsRightBehindEveryCornerInAnyOrderOfVertices) {
    constexpr int kDim = TypeParam::value;
    std::mt19937 random(3);
    const Eigen::Matrix<double, kDim, kDim> rotation = test::tilt<kDim>();
    const SimplexMesh<kDim> mesh = test::cube<kDim>(2);
    for (int trial = 0; trial < 6; ++trial) {
        std::vector<std::uint32_t> name(static_cast<std::size_t>(mesh.vertex_count()));
        std::iota(name.begin(), name.end(), 0U);
        std::shuffle(name.begin(), name.end(), random);
        Positions<kDim> positions(kDim, mesh.vertex_count());
        for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
            positions.col(name[static_cast<std::size_t>(v)]) = rotation * mesh.positions.col(v);
        }
        Simplices<kDim + 1> cells = mesh.cells;
        for (auto cell : cells.colwise()) {
            for (std::uint32_t& corner : cell) {
                corner = name[corner];
            }
            for (int i = 0; i < 4; ++i) {  // two exchanges each: the orientation stays
                const auto turned = static_cast<Eigen::Index>(random() % (kDim - 1));
                const std::uint32_t first = cell[turned];
                cell[turned] = cell[turned + 1];
                cell[turned + 1] = cell[turned + 2];
                cell[turned + 2] = first;
            }
        }
        const Surface<kDim> surface = make_surface<kDim>(cells, mesh.vertex_count());
        const BoxTree tree = TestFixture::facet_tree(surface, positions);
        int inside = 0;
        for (Eigen::Index k = 0; k < 4 * kDim * positions.cols(); ++k) {
            Vector<kDim> point = positions.col(k / (4 * kDim));
            point[k / 4 % kDim] += (k % 2 == 0 ? 1 : -1) * (k % 4 < 2 ? 0.3 : 0.7);
            const Vector<kDim> local = rotation.transpose() * point;
            if ((local.array().abs().min((local.array() - 2).abs()) < 1e-6).any()) {
                continue;  // on the surface, or beside it
            }
            const bool is_inside = local.minCoeff() > 0 && local.maxCoeff() < 2;
            inside += is_inside ? 1 : 0;
            EXPECT_EQ(winding_number<kDim>(surface, tree, positions, point), is_inside ? 1 : 0)
                << local.transpose();
        }
        EXPECT_GT(inside, 50);
    }
}

// A lattice body with notches and holes, turned by quarters of a turn, whose sines and cosines are
// rounded, and shaken by less than that: corners, edges and walls are in line with points of the
// lattice along every axis, but for rounding. Points inside and outside are half a cube from the
// surface, or farther.
TYPED_TEST(WindingNumberTest, IsRightWhereCornersAreInLineButForRounding) {
    constexpr int kDim = TypeParam::value;
    constexpr int kCubes = 3;  // along each axis
    const SimplexMesh<kDim> mesh = test::cube<kDim>(kCubes);
    std::mt19937 random(5);
    int inside = 0;
    int outside = 0;
    for (int trial = 0; trial < (kDim == 3 ? 400 : 60); ++trial) {
        std::vector<bool> is_there(static_cast<std::size_t>(std::pow(kCubes, kDim)));
        for (std::size_t i = 0; i < is_there.size(); ++i) {
            is_there[i] = random() % 3 != 0;
        }
        const auto is_in = [&](const Vector<kDim>& point) {
            std::size_t cube = 0;
            for (int axis = 0; axis < kDim; ++axis) {
                if (point[axis] < 0 || point[axis] > kCubes) {
                    return false;
                }
                cube = kCubes * cube + static_cast<std::size_t>(point[axis]);
            }
            return static_cast<bool>(is_there[cube]);
        };
        std::vector<Eigen::Index> kept;
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            Vector<kDim> middle = Vector<kDim>::Zero();
            for (const std::uint32_t vertex : mesh.cells.col(cell)) {
                middle += mesh.positions.col(vertex) / (kDim + 1);
            }
            if (is_in(middle)) {
                kept.push_back(cell);
            }
        }
        Eigen::Matrix<double, kDim, kDim> rotation = Eigen::Matrix<double, kDim, kDim>::Identity();
        for (int turn = 0; turn < 3; ++turn) {
            const auto from = static_cast<int>(random() % kDim);
            const auto to = static_cast<int>((from + 1 + random() % (kDim - 1)) % kDim);
            const double angle = static_cast<double>(random() % 4) * std::numbers::pi / 2;
            rotation = (pent::plane_rotation<kDim>(from, to, angle) * rotation).eval();
        }
        std::uniform_real_distribution<double> shake(-3e-16, 3e-16);
        const auto shaken = [&](const auto& points) {
            return (rotation * points)
                .unaryExpr([&](double x) { return x + shake(random); })
                .eval();
        };
        const Positions<kDim> positions = shaken(mesh.positions);
        const Surface<kDim> surface =
            make_surface<kDim>(mesh.cells(Eigen::all, kept), mesh.vertex_count());
        const BoxTree tree = TestFixture::facet_tree(surface, positions);
        for (int k = 0; k < 200; ++k) {
            const Vector<kDim> local = Vector<kDim>::NullaryExpr(
                [&] { return 0.5 * static_cast<double>(random() % (2 * kCubes + 1)); });
            int around = 0;  // cubes at the point that are there, of all
            for (int corner = 0; corner < (1 << kDim); ++corner) {
                const Vector<kDim> beside = Vector<kDim>::NullaryExpr([&](Eigen::Index axis) {
                    return local[axis] + ((corner >> axis & 1) != 0 ? 0.1 : -0.1);
                });
                around += is_in(beside) ? 1 : 0;
            }
            if (around != 0 && around != (1 << kDim)) {
                continue;  // on the surface
            }
            ++(around != 0 ? inside : outside);
            EXPECT_EQ(winding_number<kDim>(surface, tree, positions, shaken(local)),
                      around != 0 ? 1 : 0)
                << local.transpose();
        }
    }
    EXPECT_GT(inside, 200);
    EXPECT_GT(outside, 200);
}

TYPED_TEST(WindingNumberTest, CountsOverlapsAndInsideOut) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> mesh = test::cube<kDim>(2);
    Simplices<kDim + 1> cells(kDim + 1, 2 * mesh.cell_count());
    cells << mesh.cells, (mesh.cells.array() + mesh.vertex_count()).matrix();
    Positions<kDim> positions(kDim, 2 * mesh.vertex_count());
    positions << mesh.positions, (mesh.positions.array() + 0.75).matrix();
    const Surface<kDim> twice = make_surface<kDim>(cells, positions.cols());
    const BoxTree tree = TestFixture::facet_tree(twice, positions);
    EXPECT_EQ(winding_number<kDim>(twice, tree, positions, Vector<kDim>::Constant(1.5)), 2);
    EXPECT_EQ(winding_number<kDim>(twice, tree, positions, Vector<kDim>::Constant(0.5)), 1);
    Positions<kDim> inside_out = mesh.positions;
    inside_out.row(0) *= -1;
    const Surface<kDim> surface = make_surface<kDim>(mesh.cells, mesh.vertex_count());
    const BoxTree inverted = TestFixture::facet_tree(surface, inside_out);
    Vector<kDim> point = Vector<kDim>::Constant(0.6);
    point[0] = -0.7;
    EXPECT_EQ(winding_number<kDim>(surface, inverted, inside_out, point), -1);
}

}  // namespace
}  // namespace pent::contact
