// Contacts within one body against all pairs of it, one by one.

#include "penalty_contacts.h"

#include "closest_points_oracle.h"
#include "gather.h"
#include "normals.h"
#include "pair_contact.h"
#include "scenes.h"
#include "support/host_tasks.h"
#include "valley.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace pent::contact {
namespace {

constexpr double kEps = 0.2;  // cells are 1 m

template <int Count, int Other>
bool have_common_vertex(const Simplices<Count>& a,
                        Eigen::Index i,
                        const Simplices<Other>& b,
                        Eigen::Index j) {
    for (const std::uint32_t v : a.col(i)) {
        if ((b.col(j).array() == v).any()) {
            return true;
        }
    }
    return false;
}

template <typename T>
class SelfContactsTest : public testing::Test {
protected:
    static constexpr int kD = T::value;

    // A bar along the first axis, thin enough across for pairs that are nearly in contact at rest.
    static test::Scene<kD> bar() {
        std::array<int, kD> count{};
        std::array<double, kD> size{};
        count.fill(1);
        size.fill(1);
        count[0] = kD == 3 ? 16 : 8;
        size[0] = count[0];
        count[1] = kD == 3 ? 2 : 1;
        size[1] = count[1];
        size[kD - 1] = 0.3;
        test::Scene<kD> scene;
        scene.add(pent::test::kuhn_box<kD>(count, size), Vector<kD>::Zero());
        test::shake<kD>(scene.positions, 0.04, 5);
        return scene;
    }

    // Rolled up until the ends overlap beside each other by a little less than the distance of
    // contact.
    static Positions<kD> ring(const Positions<kD>& rest) {
        Positions<kD> positions = rest;
        const double radius = rest.row(0).maxCoeff() / 6.5;
        for (auto x : positions.colwise()) {
            const double angle = x[0] / radius;
            const double r = radius + 0.07 * angle - x[kD - 1];
            x[kD - 1] = r * std::sin(angle);
            x[0] = r * std::cos(angle);
        }
        return positions;
    }

    static std::vector<Positions<kD>> deformed(const Positions<kD>& rest) {
        std::vector<Positions<kD>> all{rest, test::tilt<kD>() * rest, ring(rest)};
        for (const double size : {0.05, 0.15, 0.5}) {
            all.push_back(rest);
            test::shake<kD>(all.back(), size, 23);
        }
        all.push_back(ring(rest));
        test::shake<kD>(all.back(), 0.05, 29);
        return all;
    }

    static std::vector<Contact<kD>> brute_force(const test::Scene<kD>& scene,
                                                const Positions<kD>& positions,
                                                const ContactOptions& options) {
        const Surface<kD>& surface = scene.surfaces[0];
        Positions<kD> normals = Positions<kD>::Zero(kD, positions.cols());
        const Positions<kD> of_surface = vertex_normals<kD>(surface, positions);
        for (Eigen::Index i = 0; i < of_surface.cols(); ++i) {
            normals.col(surface.vertices(0, i)) = of_surface.col(i);
        }
        const PositionsView<kD> view(positions);
        const PairSetting<kD> setting{view, scene.positions, normals, options.distance, {}, {}};
        std::vector<Contact<kD>> contacts;
        for (std::uint32_t i = 0; i < surface.vertices.cols(); ++i) {
            std::vector<Contact<kD>> of_vertex;
            std::size_t nearest = 0;
            for (std::uint32_t j = 0; j < surface.facets.cols(); ++j) {
                if (have_common_vertex<1, kD>(surface.vertices, i, surface.facets, j)) {
                    continue;
                }
                const auto contact =
                    local_contact<kD, 1, kD>(setting, surface.vertices, i, surface.facets, j);
                if (!contact) {
                    continue;
                }
                of_vertex.push_back(*contact);
                if (std::abs(contact->distance) < std::abs(of_vertex[nearest].distance)) {
                    nearest = of_vertex.size() - 1;
                }
            }
            if (of_vertex.empty()) {
                continue;
            }
            const bool is_in_front = of_vertex[nearest].distance >= 0;
            const std::size_t first = contacts.size();
            contacts.push_back(of_vertex[nearest]);
            for (std::size_t k = 0; is_in_front && k < of_vertex.size(); ++k) {
                if (k != nearest && of_vertex[k].distance >= 0) {
                    contacts.push_back(of_vertex[k]);
                }
            }
            share_contacts<kD>(contacts, first, options.distance, view);
        }
        for (std::uint32_t i = 0; i < surface.edges.cols(); ++i) {
            for (std::uint32_t j = kD == 3 ? i + 1 : 0; j < surface.ridges.cols(); ++j) {
                if (have_common_vertex<2, kD - 1>(surface.edges, i, surface.ridges, j)) {
                    continue;
                }
                if (const auto contact = local_contact<kD, 2, kD - 1>(setting, surface.edges, i,
                                                                      surface.ridges, j)) {
                    contacts.push_back(*contact);
                }
            }
        }
        return contacts;
    }
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(SelfContactsTest, Dimensions);

TYPED_TEST(SelfContactsTest, AreThoseOfBruteForceToTheBit) {
    constexpr int kDim = TypeParam::value;
    const test::Scene<kDim> scene = TestFixture::bar();
    for (const double distance :
         {kEps, 1.0}) {  // without pairs near at rest, too: cells are no larger
        const ContactOptions options{.distance = distance, .self = true};
        ContactFinder<kDim> finder(test::contact_scene<kDim>(scene, options));
        std::size_t all = 0;
        for (const Positions<kDim>& positions : TestFixture::deformed(scene.positions)) {
            const auto expected = TestFixture::brute_force(scene, positions, options);
            const auto found = finder.find(positions, 1000).list;
            ASSERT_EQ(found.size(), expected.size());
            for (std::size_t i = 0; i < found.size(); ++i) {
                EXPECT_EQ(found[i].vertices, expected[i].vertices);
                EXPECT_EQ(found[i].distance, expected[i].distance);
                EXPECT_EQ(found[i].direction, expected[i].direction);
                EXPECT_EQ(found[i].weights, expected[i].weights);
                EXPECT_EQ(found[i].share, expected[i].share);
            }
            all += found.size();
        }
        EXPECT_GT(all, 20U);
    }
}

// Pairs that are near each other at rest as well are not looked at again and again.
TYPED_TEST(SelfContactsTest, CostLittleInABodyThatIsBentALittle) {
    constexpr int kDim = TypeParam::value;
    const test::Scene<kDim> scene = TestFixture::bar();
    const ContactOptions options{.distance = kEps, .self = true};
    ContactFinder<kDim> finder(test::contact_scene<kDim>(scene, options));
    Positions<kDim> bent = scene.positions;
    bent.row(1) += 0.002 * scene.positions.row(0).cwiseAbs2();
    const std::int64_t at_first = finder.find(scene.positions, 1000).report.candidates;
    const std::int64_t of_bent = finder.find(bent, 1000).report.candidates;
    EXPECT_LT(of_bent, at_first / 2);  // patches of neighbors overlap, and are counted
    EXPECT_GT(finder.find(TestFixture::ring(scene.positions), 1000).report.candidates, of_bent);
}

TYPED_TEST(SelfContactsTest, AreTheSameForAnyNumberOfThreads) {
    constexpr int kDim = TypeParam::value;
    const test::Scene<kDim> scene = TestFixture::bar();
    const ContactOptions options{.distance = kEps, .self = true};
    const Positions<kDim> positions = TestFixture::ring(scene.positions);
    std::vector<Contact<kDim>> expected;
    for (const int threads : {1, 2, 3, 8}) {
        const auto found = Workers(pent::test::host_tasks(threads)).run([&] {
            return ContactFinder<kDim>(test::contact_scene<kDim>(scene, options))
                .find(positions, 1000)
                .list;
        });
        if (threads == 1) {
            expected = found;
        }
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_EQ(found[i].vertices, expected[i].vertices);
            EXPECT_EQ(found[i].slope, expected[i].slope);
            EXPECT_EQ(found[i].direction, expected[i].direction);
        }
    }
    EXPECT_GT(expected.size(), 0U);
}

}  // namespace
}  // namespace pent::contact
