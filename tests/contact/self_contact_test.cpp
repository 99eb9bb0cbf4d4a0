#include "bodies.h"
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
    return test::carved<Dim>(pent::test::kuhn_box<Dim>(count, size),
                             [](const Vector<Dim>& x) { return x[0] > 1 && x[1] > 1 && x[1] < 2; });
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

// A convex body with its cells at hand is not searched, so has no patches for it, while it is bent
// a little. Bent further it has all contacts with itself, as one without them.
TYPED_TEST(SelfContact, IsTheSameWhetherCellsAreAtHandOrNot) {
    constexpr int kDim = TypeParam::value;
    constexpr int kLength = 8;
    const SimplexMesh<kDim> bar = test::bar<kDim>(kLength);
    const auto bent = [&](double amount) {
        Positions<kDim> x = bar.positions;
        test::bend<kDim>(x, kLength, amount);
        test::shake<kDim>(x, 0.01, 7);
        return Positions<kDim>(test::tilt<kDim>() * x);
    };
    test::Scene<kDim> scene;
    scene.add(bar, Vector<kDim>::Zero());
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        const ContactOptions options{.model = model, .distance = 0.25, .self = true};
        ContactScene<kDim> with_cells = test::contact_scene<kDim>(scene, options);
        with_cells.bodies[0].cells = {bar.cells.data(), static_cast<std::size_t>(bar.cells.size())};
        ContactFinder<kDim> with(with_cells);
        ContactFinder<kDim> without(test::contact_scene<kDim>(scene, options));
        Positions<kDim> before = bent(0.04);
        std::size_t contacts = 0;
        for (const double amount : {0.05, 0.1, 0.2, 0.5, 0.9, 1.0, 1.02, 0.9, 0.1}) {
            const Positions<kDim> x = bent(amount);
            EXPECT_EQ(with.limit_step(before, x).fraction, without.limit_step(before, x).fraction);
            const Contacts<kDim> found = with.find(x, 1000);
            const Contacts<kDim> wanted = without.find(x, 1000);
            ASSERT_EQ(found.list.size(), wanted.list.size());
            for (std::size_t i = 0; i < found.list.size(); ++i) {
                EXPECT_EQ(found.list[i].vertices, wanted.list[i].vertices);
                EXPECT_EQ(found.list[i].energy, wanted.list[i].energy);
            }
            if (amount <= 0.1 && contacts == 0) {
                EXPECT_LT(with.bytes(), without.bytes());
            }
            contacts += found.list.size();
            before = x;
        }
        EXPECT_GT(contacts, 20U);
    }
}

}  // namespace
}  // namespace pent::contact
