#include "support/kuhn_box.h"
#include "support/messages.h"

#include <pent/simplex_mesh.h>

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <numeric>

namespace pent {
namespace {

using test::error_of;
using test::expect_contains;

SimplexMesh<4> one_pentachoron() {
    SimplexMesh<4> mesh;
    mesh.positions = Positions<4>::Zero(4, 5);
    mesh.positions.rightCols<4>().setIdentity();
    mesh.cells.resize(5, 1);
    mesh.cells << 0, 1, 2, 3, 4;
    return mesh;
}

TEST(SimplexVolume, OfTheStandardSimplexIsOneOverFactorial) {
    EXPECT_DOUBLE_EQ(simplex_volume<4>(one_pentachoron().positions), 1.0 / 24);
    EXPECT_DOUBLE_EQ((simplex_volume<3>((Eigen::Matrix<double, 3, 4>() << 0, 1, 0, 0,  //
                                         0, 0, 1, 0,                                   //
                                         0, 0, 0, 1)
                                            .finished())),
                     1.0 / 6);
}

TEST(SimplexVolume, ChangesSignWithEveryTransposition) {
    Eigen::Matrix<double, 4, 5> corners;
    corners << 0.1, 1.2, -0.3, 0.4, 0.7, 0.3, 0.2, 1.1, -0.5, 0.2, -0.4, 0.3, 0.2, 1.3, 0.1, 0.2,
        0.1, -0.1, 0.2, 1.4;
    std::array<int, 5> order{};
    std::iota(order.begin(), order.end(), 0);
    const double volume = simplex_volume<4>(corners);
    ASSERT_GT(std::abs(volume), 0.01);
    do {
        int inversions = 0;
        Eigen::Matrix<double, 4, 5> permuted;
        for (int i = 0; i < 5; ++i) {
            permuted.col(i) = corners.col(order[i]);
            for (int j = 0; j < i; ++j) {
                inversions += order[j] > order[i] ? 1 : 0;
            }
        }
        const double sign = inversions % 2 == 0 ? 1 : -1;
        // 120 different orders of the same sum: a few units of rounding apart.
        EXPECT_NEAR(simplex_volume<4>(permuted), sign * volume, 1e-15);
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(TotalVolume, OfAKuhnBoxIsThatOfTheBox) {
    const SimplexMesh<4> mesh = test::kuhn_box<4>({2, 1, 3, 2}, {2.0, 0.5, 1.5, 4.0});
    EXPECT_EQ(mesh.cell_count(), 12 * 24);
    EXPECT_NEAR(total_volume(mesh), 6.0, 6.0 * 1e-15 * 288);  // one rounding a cell
}

TEST(Validate, AcceptsAGoodMeshInEveryDimension) {
    EXPECT_NO_THROW((validate(test::kuhn_box<2>({2, 3}, {1, 1}), "box")));
    EXPECT_NO_THROW((validate(test::kuhn_box<3>({2, 3, 1}, {1, 1, 1}), "box")));
    EXPECT_NO_THROW((validate(test::kuhn_box<4>({2, 1, 1, 2}, {1, 1, 1, 1}), "box")));
}

TEST(Validate, DoesNotDependOnSizePlaceOrFlatness) {
    for (const double size : {1e-60, 1e-9, 1.0, 1e9, 1e60}) {
        const double small = 1e-4 * size;
        EXPECT_NO_THROW(
            (validate(test::kuhn_box<4>({1, 1, 1, 1}, {size, size, size, small}), "plate")));
        EXPECT_NO_THROW(
            (validate(test::kuhn_box<4>({1, 1, 1, 1}, {size, small, small, small}), "rod")));
    }
    SimplexMesh<4> far = one_pentachoron();
    far.positions.array() += 1e7;
    EXPECT_NO_THROW(validate(far, "far"));
}

TEST(Validate, NamesAnEmptyMesh) {
    SimplexMesh<4> mesh = one_pentachoron();
    mesh.cells.resize(5, 0);
    expect_contains(error_of([&] { validate(mesh, "m.pent"); }), {"m.pent", "no pentachora"});
}

TEST(Validate, NamesACoordinateThatIsNotFinite) {
    for (const double value :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        SimplexMesh<4> mesh = one_pentachoron();
        mesh.positions(3, 2) = value;
        expect_contains(error_of([&] { validate(mesh, "m.pent"); }),
                        {"m.pent", "vertex 2", "w is", "finite"});
    }
}

TEST(Validate, NamesAnIndexOutOfRange) {
    SimplexMesh<4> mesh = one_pentachoron();
    mesh.cells(4, 0) = 5;
    expect_contains(error_of([&] { validate(mesh, "m.pent"); }),
                    {"m.pent", "pentachoron 0", "vertex 5 of 5"});
}

TEST(Validate, NamesARepeatedIndex) {
    SimplexMesh<4> mesh = one_pentachoron();
    mesh.cells(4, 0) = 1;
    expect_contains(error_of([&] { validate(mesh, "m.pent"); }),
                    {"m.pent", "pentachoron 0", "vertex 1 appears twice"});
}

TEST(Validate, NamesAnInvertedCell) {
    SimplexMesh<4> mesh = one_pentachoron();
    std::swap(mesh.cells(0, 0), mesh.cells(1, 0));
    expect_contains(error_of([&] { validate(mesh, "m.pent"); }),
                    {"m.pent", "pentachoron 0", "inverted"});
    mesh.positions.bottomRows(3) *= 1e-4;  // a thin one has a volume, too
    expect_contains(error_of([&] { validate(mesh, "m.pent"); }),
                    {"m.pent", "pentachoron 0", "inverted"});
}

TEST(Validate, NamesAFlatCellAtAnySize) {
    for (const double size : {1e-80, 1.0, 1e80}) {
        SimplexMesh<4> mesh = one_pentachoron();
        mesh.positions.col(4) = (mesh.positions.col(1) + mesh.positions.col(2)) / 2;
        mesh.positions *= size;
        expect_contains(error_of([&] { validate(mesh, "m.pent"); }),
                        {"m.pent", "pentachoron 0", "degenerate"});
    }
}

TEST(Validate, NamesACellCollapsedToAPoint) {
    SimplexMesh<4> mesh = one_pentachoron();
    mesh.positions.setConstant(0.5);
    expect_contains(error_of([&] { validate(mesh, "m.pent"); }), {"pentachoron 0", "degenerate"});
}

TEST(Validate, NamesAnArrayOfWrongLength) {
    const auto message = [](const auto& damage) {
        SimplexMesh<4> mesh = one_pentachoron();
        damage(mesh);
        return error_of([&] { validate(mesh, "m.pent"); });
    };
    expect_contains(message([](auto& mesh) { mesh.columns = {0, 1}; }), {"2 columns", "none or 5"});
    expect_contains(message([](auto& mesh) { mesh.layers = {0, 1}; }), {"2 layers", "none or 5"});
    expect_contains(message([](auto& mesh) { mesh.regions = {0, 1}; }), {"2 regions", "none or 1"});
    expect_contains(message([](auto& mesh) { mesh.parents = {0, 1}; }), {"2 parents", "none or 1"});
    expect_contains(message([](auto& mesh) { mesh.fibers.setOnes(4, 2); }),
                    {"2 fibers", "none or 1"});
}

}  // namespace
}  // namespace pent
