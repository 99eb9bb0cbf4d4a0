#include "near_pairs.h"

#include "boxes_around.h"
#include "closest_points_oracle.h"
#include "scenes.h"
#include "support/host_tasks.h"
#include "winding_number.h"

#include <gtest/gtest.h>

#include <vector>

namespace pent::contact {
namespace {

template <int Dim, int K, int L>
std::vector<Candidate> brute_force(const Simplices<K>& first,
                                   const Simplices<L>& second,
                                   const Positions<Dim>& positions,
                                   double distance,
                                   Closest closest,
                                   bool is_same_list) {
    std::vector<Candidate> pairs;
    for (std::uint32_t i = 0; i < first.cols(); ++i) {
        for (std::uint32_t j = is_same_list ? i + 1 : 0; j < second.cols(); ++j) {
            bool is_shared = false;
            for (const std::uint32_t a : first.col(i)) {
                for (const std::uint32_t b : second.col(j)) {
                    is_shared = is_shared || a == b;
                }
            }
            const auto points = test::closest_points<Dim, K, L>(
                gather<Dim, K>(first, i, positions), gather<Dim, L>(second, j, positions));
            const bool is_interior =
                points.first_face == (1U << K) - 1 && points.second_face == (1U << L) - 1;
            if (!is_shared && points.distance_squared < distance * distance
                && (closest == Closest::Anywhere || is_interior)) {
                pairs.push_back({i, j, static_cast<float>(std::sqrt(points.distance_squared))});
            }
        }
    }
    return pairs;
}

void expect_equal(const std::vector<Candidate>& found, const std::vector<Candidate>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(found[k].first, expected[k].first);
        EXPECT_EQ(found[k].second, expected[k].second);
        EXPECT_LE(found[k].distance, expected[k].distance);  // rounded down
        EXPECT_NEAR(found[k].distance, expected[k].distance, 1e-6F);
    }
}

// Two shaken boxes, the second tilted, which overlap by part of a cell.
template <typename T>
class NearPairsTest : public testing::Test {
protected:
    void SetUp() override {
        const SimplexMesh<T::value> mesh = test::cube<T::value>(T::value == 3 ? 3 : 1);
        SimplexMesh<T::value> tilted = mesh;
        tilted.positions = test::tilt<T::value>() * mesh.positions;
        scene_.add(mesh, Vector<T::value>::Zero());
        scene_.add(tilted, Vector<T::value>::Constant(T::value == 3 ? 2.1 : 0.6));
        test::shake<T::value>(scene_.positions, 0.1, 2);
    }

    template <int K, int L>
    void compare(const Simplices<K>& first, const Simplices<L>& second, bool is_same_list) {
        constexpr int kDim = T::value;
        for (const double distance : {0.05, 0.3}) {
            const BoxTree a(boxes_around<kDim, K>(first, scene_.positions, distance / 2));
            const BoxTree b(boxes_around<kDim, L>(second, scene_.positions, distance / 2));
            const SearchSet<K> from{first, a};
            const SearchSet<L> to{second, is_same_list ? a : b};
            for (const Closest closest : {Closest::Anywhere, Closest::Interior}) {
                const std::vector<Candidate> expected = brute_force<kDim, K, L>(
                    first, second, scene_.positions, distance, closest, is_same_list);
                const CandidateList found =
                    near_pairs<kDim, K, L>(from, to, scene_.positions, distance, closest);
                expect_equal(found.pairs, expected);
                EXPECT_EQ(found.known_count, found.pairs.size());
                EXPECT_GE(found.overlaps, static_cast<std::int64_t>(expected.size()));
            }
        }
    }

    test::Scene<T::value> scene_;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(NearPairsTest, Dimensions);

TYPED_TEST(NearPairsTest, AreThoseOfBruteForceBetweenBodies) {
    constexpr int kDim = TypeParam::value;
    const auto& a = this->scene_.surfaces[0];
    const auto& b = this->scene_.surfaces[1];
    this->template compare<1, kDim>(a.vertices, b.facets, false);
    this->template compare<1, kDim>(b.vertices, a.facets, false);
    this->template compare<2, kDim - 1>(a.edges, b.ridges, false);
    this->template compare<2, kDim - 1>(b.edges, a.ridges, false);
}

TYPED_TEST(NearPairsTest, AreThoseOfBruteForceWithinABody) {
    constexpr int kDim = TypeParam::value;
    const auto& a = this->scene_.surfaces[0];
    this->template compare<1, kDim>(a.vertices, a.facets, false);
    this->template compare<2, kDim - 1>(a.edges, a.ridges, kDim == 3);
}

TYPED_TEST(NearPairsTest, AreTheSameForAnyNumberOfThreads) {
    constexpr int kDim = TypeParam::value;
    const auto& a = this->scene_.surfaces[0];
    const auto& b = this->scene_.surfaces[1];
    std::vector<Candidate> expected;
    for (const int threads : {1, 2, 3, 8}) {
        Workers(pent::test::host_tasks(threads)).run([&] {
            const BoxTree edges(boxes_around<kDim, 2>(a.edges, this->scene_.positions, 0.1));
            const BoxTree ridges(
                boxes_around<kDim, kDim - 1>(b.ridges, this->scene_.positions, 0.1));
            const CandidateList found = near_pairs<kDim, 2, kDim - 1>(
                {a.edges, edges}, {b.ridges, ridges}, this->scene_.positions, 0.2);
            if (threads == 1) {
                expected = found.pairs;
            }
            ASSERT_EQ(found.pairs.size(), expected.size());
            for (std::size_t k = 0; k < expected.size(); ++k) {
                EXPECT_EQ(found.pairs[k].first, expected[k].first);
                EXPECT_EQ(found.pairs[k].second, expected[k].second);
                EXPECT_EQ(found.pairs[k].distance, expected[k].distance);
            }
        });
    }
    EXPECT_FALSE(expected.empty());
}

TYPED_TEST(NearPairsTest, VerticesInsideAreThoseTheOtherSurfaceGoesRound) {
    constexpr int kDim = TypeParam::value;
    const SimplexMesh<kDim> fine = test::cube<kDim>(kDim == 3 ? 8 : 4);
    test::Scene<kDim> scene;
    scene.add(fine, Vector<kDim>::Zero());
    SimplexMesh<kDim> big = test::cube<kDim>(1);
    big.positions = (kDim == 3 ? 6 : 3) * test::tilt<kDim>() * big.positions;
    scene.add(big, Vector<kDim>::Constant(0.7));
    const Surface<kDim>& a = scene.surfaces[0];
    const Surface<kDim>& b = scene.surfaces[1];
    const BoxTree vertices(boxes_around<kDim, 1>(a.vertices, scene.positions, 0.01));
    const BoxTree facets(boxes_around<kDim, kDim>(b.facets, scene.positions, 0.01));
    const std::vector<std::uint8_t> found =
        vertices_inside<kDim>(a, vertices, b, facets, scene.positions);
    int inside = 0;
    for (Eigen::Index i = 0; i < a.vertices.cols(); ++i) {
        const Vector<kDim> point = scene.positions.col(a.vertices(0, i));
        EXPECT_EQ(found[i], winding_number<kDim>(b, facets, scene.positions, point));
        inside += found[i];
    }
    EXPECT_GT(inside, 10);
    EXPECT_LT(inside, a.vertices.cols() - 10);
}

TYPED_TEST(NearPairsTest, NearestFacetIsThatOfBruteForce) {
    constexpr int kDim = TypeParam::value;
    const Surface<kDim>& surface = this->scene_.surfaces[0];
    const BoxTree facets(boxes_around<kDim, kDim>(surface.facets, this->scene_.positions, 0.01));
    for (Eigen::Index v = 0; v < this->scene_.positions.cols(); ++v) {
        const Vector<kDim> point = this->scene_.positions.col(v) + Vector<kDim>::Constant(0.13);
        double expected = std::numeric_limits<double>::infinity();
        for (Eigen::Index f = 0; f < surface.facets.cols(); ++f) {
            const Corners<kDim, kDim> corners =
                gather<kDim, kDim>(surface.facets, f, this->scene_.positions);
            expected =
                std::min(expected, test::brute_force_distance<kDim, 1, kDim>(point, corners));
        }
        const std::uint32_t nearest =
            nearest_facet<kDim>(surface, facets, this->scene_.positions, point);
        const auto points = test::closest_points<kDim, 1, kDim>(
            point, gather<kDim, kDim>(surface.facets, nearest, this->scene_.positions));
        EXPECT_NEAR(std::sqrt(points.distance_squared), expected, 1e-13);
    }
}

}  // namespace
}  // namespace pent::contact
