#include "facing_pairs.h"

#include "gather.h"
#include "scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace pent::contact {
namespace {

constexpr double kDistance = 0.9;  // cells are 1 m

// A crumpled box: its normals turn far within a cell in some places and little in others.
template <int Dim>
struct Crumpled {
    test::Scene<Dim> scene;
    Positions<Dim> normals;

    Crumpled() {
        scene.add(test::cube<Dim>(Dim == 3 ? 4 : 3), Vector<Dim>::Zero());
        test::shake<Dim>(scene.positions, 0.05, 7);
        const Positions<Dim> of_surface = vertex_normals<Dim>(surface(), scene.positions);
        normals = Positions<Dim>::Zero(Dim, scene.positions.cols());
        for (Eigen::Index i = 0; i < of_surface.cols(); ++i) {
            normals.col(surface().vertices(0, i)) = of_surface.col(i);
        }
    }
    [[nodiscard]] const Surface<Dim>& surface() const { return scene.surfaces[0]; }
};

template <int Count, int Dim>
Vector<Dim> normal_within(const Crumpled<Dim>& body,
                          const Simplices<Count>& simplices,
                          std::uint32_t which,
                          std::mt19937& random) {
    Eigen::Matrix<double, Count, 1> weights;
    std::exponential_distribution<double> part(1);
    for (double& weight : weights) {
        weight = part(random);
    }
    return (gather<Dim, Count>(simplices, which, body.normals) * weights).normalized();
}

// What facing_pairs() leaves out of near_pairs() has normals that are near each other all over.
template <int Dim, int K, int L>
void expect_only_pairs_of_one_view_are_missing(const Crumpled<Dim>& body,
                                               const Simplices<K>& first,
                                               const Simplices<L>& second) {
    const auto boxes_first = boxes_around<Dim, K>(first, body.scene.positions, kDistance / 2);
    const auto boxes_second = boxes_around<Dim, L>(second, body.scene.positions, kDistance / 2);
    const auto normals_first = normal_boxes<Dim, K>(first, body.normals);
    const auto normals_second = normal_boxes<Dim, L>(second, body.normals);
    const BoxTree tree_first(boxes_first);
    const BoxTree tree_second(boxes_second);
    BoxTree normal_tree_first = tree_first;
    normal_tree_first.refit(normals_first);
    BoxTree normal_tree_second = tree_second;
    normal_tree_second.refit(normals_second);
    const NearPairs near =
        near_pairs<Dim, K, L>({first, tree_first}, {second, tree_second}, body.scene.positions,
                              kDistance, Closest::Anywhere);
    const NearPairs facing =
        facing_pairs<Dim, K, L>({first, tree_first, normals_first, normal_tree_first, {}},
                                {second, tree_second, normals_second, normal_tree_second, {}},
                                body.scene.positions, kDistance, 0, Closest::Anywhere);
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const NearPair& pair : facing.pairs) {
        found.insert({pair.first, pair.second});
    }
    EXPECT_EQ(found.size(), facing.pairs.size());
    std::mt19937 random(5);
    std::size_t missing = 0;
    for (const NearPair& pair : near.pairs) {
        if (found.erase({pair.first, pair.second}) == 1) {
            continue;
        }
        ++missing;
        for (int sample = 0; sample < 8; ++sample) {
            const Vector<Dim> a = normal_within<K, Dim>(body, first, pair.first, random);
            const Vector<Dim> b = normal_within<L, Dim>(body, second, pair.second, random);
            EXPECT_LT((b - a).norm(), 2 * kLeastView);
        }
    }
    EXPECT_TRUE(found.empty());  // nothing but near pairs
    EXPECT_GT(facing.pairs.size(), 0U);
    EXPECT_GT(missing, 0U);
}

TEST(FacingPairs, LeaveOutOnlyPairsWhoseNormalsAgree) {
    const Crumpled<3> small;
    expect_only_pairs_of_one_view_are_missing<3, 1, 3>(small, small.surface().vertices,
                                                       small.surface().facets);
    const Crumpled<4> body;
    expect_only_pairs_of_one_view_are_missing<4, 1, 4>(body, body.surface().vertices,
                                                       body.surface().facets);
    expect_only_pairs_of_one_view_are_missing<4, 2, 3>(body, body.surface().edges,
                                                       body.surface().ridges);
}

}  // namespace
}  // namespace pent::contact
