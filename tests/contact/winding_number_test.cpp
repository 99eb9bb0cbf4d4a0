#include "winding_number.h"

#include "boxes_around.h"
#include "scenes.h"

#include <gtest/gtest.h>

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
