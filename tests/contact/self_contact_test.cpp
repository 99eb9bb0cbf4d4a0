#include "penalty_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace pent::contact {
namespace {

using test::contacts_of;
using test::forces_of;
using test::kEps;
using test::kOptions;
using test::kStiffness;

template <typename T>
class SelfContact : public testing::Test {};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(SelfContact, Dimensions);

TYPED_TEST(SelfContact, IsNoneUnlessAskedFor) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(test::cube<kDim>(2), Vector<kDim>::Zero());
    const Contacts<kDim> contacts = contacts_of(scene);
    EXPECT_TRUE(contacts.list.empty());
    EXPECT_EQ(contacts.report.candidates, 0);  // nothing was even looked for
}

// A box of 3 cells along y with the middle one taken out but for a column: a mouth.
template <int Dim>
SimplexMesh<Dim> mouth() {
    std::array<int, Dim> count{};
    std::array<double, Dim> size{};
    count.fill(1);
    size.fill(1);
    count[0] = 3;
    count[1] = 3;
    size[0] = 3;
    size[1] = 3;
    SimplexMesh<Dim> box = pent::test::kuhn_box<Dim>(count, size);
    Simplices<Dim + 1> kept(Dim + 1, box.cell_count());
    Eigen::Index cells = 0;
    for (Eigen::Index c = 0; c < box.cell_count(); ++c) {
        Vector<Dim> center = Vector<Dim>::Zero();
        for (const std::uint32_t v : box.cells.col(c)) {
            center += box.positions.col(v) / (Dim + 1);
        }
        if (center[0] < 1 || center[1] < 1 || center[1] > 2) {
            kept.col(cells++) = box.cells.col(c);
        }
    }
    box.cells = kept.leftCols(cells);
    return box;
}

TYPED_TEST(SelfContact, BeginsWhereThePartsOfABodyMeet) {
    constexpr int kDim = TypeParam::value;
    test::Scene<kDim> scene;
    scene.add(mouth<kDim>(), Vector<kDim>::Zero());
    const Positions<kDim> rest = scene.positions;
    ContactOptions options = kOptions;
    options.self = true;
    ContactFinder<kDim> finder(test::contact_scene<kDim>(scene, options));
    EXPECT_TRUE(finder.find(rest, kStiffness).list.empty());
    // The upper lip comes down, and goes a little into the lower one.
    for (const double gap : {0.5, 0.15, 0.01, -0.05}) {
        Positions<kDim> closed = rest;
        for (Eigen::Index v = 0; v < rest.cols(); ++v) {
            if (rest(0, v) > 0.5 && rest(1, v) > 1.5) {
                closed(1, v) -= (1 - gap) * std::min(rest(0, v) - 0.5, 1.5) / 1.5;
                closed(0, v) += 0.1 * (rest(0, v) - 1);  // not vertex upon vertex
            }
        }
        const Contacts<kDim> contacts = finder.find(closed, kStiffness);
        EXPECT_EQ(contacts.list.empty(), gap > kEps) << gap;
        EXPECT_EQ(contacts.report.self, static_cast<std::int64_t>(contacts.list.size()));
        if (gap < kEps) {
            const Positions<kDim> forces = forces_of(contacts, rest.cols());
            double on_upper = 0;
            for (Eigen::Index v = 0; v < rest.cols(); ++v) {
                on_upper += rest(1, v) > 1.5 ? forces(1, v) : 0;
            }
            EXPECT_GT(on_upper, 0) << gap;
            EXPECT_LT(forces.rowwise().sum().norm(), 1e-13 * forces.norm());
        }
    }
}

TYPED_TEST(SelfContact, IsNoneAtRestNorInSomethingThinThatIsSqueezed) {
    constexpr int kDim = TypeParam::value;
    ContactOptions options = kOptions;
    options.self = true;
    for (const double thickness : {0.5, 1.5, 2.5}) {  // of the distance of contact
        test::Scene<kDim> scene;
        SimplexMesh<kDim> sheet = test::cube<kDim>(2);
        sheet.positions.row(1) *= thickness * kEps / 2;
        scene.add(sheet, Vector<kDim>::Zero());
        ContactFinder<kDim> finder(test::contact_scene<kDim>(scene, options));
        EXPECT_TRUE(finder.find(scene.positions, kStiffness).list.empty());
        const Positions<kDim> squeezed =
            Vector<kDim>(Vector<kDim>::Ones() - 0.7 * Vector<kDim>::UnitY()).asDiagonal()
            * scene.positions;
        EXPECT_TRUE(finder.find(squeezed, kStiffness).list.empty()) << thickness;
    }
}

}  // namespace
}  // namespace pent::contact
