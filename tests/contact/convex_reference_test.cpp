#include "convex_reference.h"

#include "bodies.h"
#include "gather.h"

#include <pent/geometry.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace pent::contact {
namespace {

template <int Dim>
std::optional<Positions<Dim>> reference_of(const SimplexMesh<Dim>& mesh) {
    return convex_reference<Dim>(make_surface<Dim>(mesh.cells, mesh.vertex_count()), mesh.cells,
                                 mesh.positions);
}

// How far the farthest vertex is before the plane of a facet, of all facets, m; by looking at all.
template <int Dim>
double deepest_dent(const SimplexMesh<Dim>& mesh, const Positions<Dim>& x) {
    const Surface<Dim> surface = make_surface<Dim>(mesh.cells, mesh.vertex_count());
    const Vector<Dim> inside = x.rowwise().mean();
    double deepest = -1;
    for (Eigen::Index f = 0; f < surface.facets.cols(); ++f) {
        const Corners<Dim, Dim> corners = gather<Dim, Dim>(surface.facets, f, x);
        // n . corner = 1, for the mean of all as the origin: n . x <= 1 behind the plane.
        const Block<Dim> from_inside = (corners.colwise() - inside).transpose();
        const Vector<Dim> n = from_inside.inverse() * Vector<Dim>::Ones();
        const auto before = (n.transpose() * (x.colwise() - inside)).array() - 1;
        deepest = std::max(deepest, before.maxCoeff() / n.norm());
    }
    return deepest;
}

template <int Dim>
double least_volume(const SimplexMesh<Dim>& mesh, const Positions<Dim>& x) {
    double least = 1;
    for (int cell = 0; cell < static_cast<int>(mesh.cell_count()); ++cell) {
        least = std::min(least, cell_volume<Dim>(x, mesh.cells, cell));
    }
    return least;
}

template <typename T>
class ConvexReference : public testing::Test {};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(ConvexReference, Dimensions);

TYPED_TEST(ConvexReference, OfWhatIsConvexIsItself) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> mesh = test::cube<kDim>(3);
    EXPECT_EQ(*reference_of<kDim>(mesh), mesh.positions);
    // A single cell has no dents either.
    SimplexMesh<kDim> cell;
    cell.positions.setZero(kDim, kDim + 1);
    cell.cells.resize(kDim + 1, 1);
    for (int k = 0; k <= kDim; ++k) {
        cell.cells(k, 0) = static_cast<std::uint32_t>(k);
    }
    cell.positions.template rightCols<kDim>().setIdentity();
    EXPECT_EQ(*reference_of<kDim>(cell), cell.positions);
    // Sides that are flat but for the rounding of their coordinates to float.
    mesh.positions =
        (test::tilt<kDim>() * mesh.positions).template cast<float>().template cast<double>();
    EXPECT_EQ(*reference_of<kDim>(mesh), mesh.positions);
}

TYPED_TEST(ConvexReference, HasSmallDentsBentOut) {
    constexpr int kDim = TypeParam::value;
    SimplexMesh<kDim> dented = test::cube<kDim>(2);
    for (auto x : dented.positions.colwise()) {  // the middle of one side, a tenth of an edge in
        if ((x.array() == Vector<kDim>::Ones().array()).count() == kDim - 1 && x[0] == 2) {
            x[0] = 1.9;
        }
    }
    for (const SimplexMesh<kDim>& mesh : {test::ball<kDim>(2), test::ball<kDim>(3), dented}) {
        const auto reference = reference_of<kDim>(mesh);
        ASSERT_TRUE(reference);
        EXPECT_GT(deepest_dent<kDim>(mesh, mesh.positions), 0.01);
        // What counts as flat, 1e-6 of an edge, may add up over the few facets of a side.
        EXPECT_LT(deepest_dent<kDim>(mesh, *reference), 1e-5);
        EXPECT_GT(least_volume<kDim>(mesh, *reference), 0);
        const double farthest = (*reference - mesh.positions).colwise().norm().maxCoeff();
        EXPECT_GT(farthest, 0.01);
        const Surface<kDim> surface = make_surface<kDim>(mesh.cells, mesh.vertex_count());
        EXPECT_LE(farthest, 0.25 * mean_edge_length<kDim>(surface, mesh.positions));
    }
}

TYPED_TEST(ConvexReference, IsNotOfWhatIsFarFromConvex) {
    constexpr int kDim = TypeParam::value;
    const auto middle = [](const Vector<kDim>& x) {
        return ((x.array() - 1.5).abs() < 0.5).eval();
    };
    EXPECT_FALSE(reference_of<kDim>(test::carved<kDim>(  // a notch
        test::cube<kDim>(2), [](const Vector<kDim>& x) { return x.minCoeff() > 1; })));
    EXPECT_FALSE(reference_of<kDim>(test::carved<kDim>(  // a hollow
        test::cube<kDim>(3), [&](const Vector<kDim>& x) { return middle(x).all(); })));
    EXPECT_FALSE(reference_of<kDim>(test::carved<kDim>(  // a hole
        test::cube<kDim>(3),
        [&](const Vector<kDim>& x) { return middle(x).template head<2>().all(); })));
    // Two boxes, each convex.
    EXPECT_FALSE(reference_of<kDim>(test::carved<kDim>(
        test::cube<kDim>(3), [&](const Vector<kDim>& x) { return middle(x)[0]; })));
    SimplexMesh<kDim> dented = test::cube<kDim>(2);
    for (auto x : dented.positions.colwise()) {  // deep dents
        x *= (x.array() == 1).count() == kDim - 1 && x.maxCoeff() == 2 ? 0.75 : 1;
    }
    EXPECT_FALSE(reference_of<kDim>(dented));
}

}  // namespace
}  // namespace pent::contact
