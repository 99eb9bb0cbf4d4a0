#include "model/falling_values.h"

#include "cut_meshes.h"
#include "scenes.h"
#include "support/kuhn_box.h"
#include "thread_ranks.h"

#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

// Every rank knows its own vertices: from then on it knows all that are at its cells, but for those
// that it has found to be less.
TEST(FallingValues, ComeFromTheRanksOfTheirVertices) {
    const Scene scene = test::box_scene<3>();
    const SimplexMesh<3> mesh = pent::test::kuhn_box<3>({4, 2, 1}, {4, 2, 1});
    const std::vector<std::uint32_t> owners = share_vertices<3>(scene, {mesh}, 3);
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        const MeshPart<3> part = test::cut_meshes<3>(scene, {mesh}, *ranks)[0];
        const MeshShare<3> share{part.mesh, owners, ranks.get()};
        Eigen::VectorXd values = Eigen::VectorXd::Constant(mesh.vertex_count(), 1000);
        for (std::uint32_t v = 0; v < owners.size(); ++v) {
            values[v] = share.owns(v) ? v : values[v];
        }
        FallingValues others(share);
        std::vector<std::uint32_t> expected;
        for (std::uint32_t v = 0; v < owners.size(); ++v) {
            if (!share.owns(v) && (part.mesh.cells.array() == v).any()) {
                expected.push_back(v);
            }
        }
        ASSERT_FALSE(expected.empty());
        EXPECT_EQ(others.take_over(values), expected);
        for (const std::uint32_t v : expected) {
            EXPECT_EQ(values[v], v);
        }
        values[expected[0]] = -1;
        EXPECT_TRUE(others.take_over(values).empty());
        EXPECT_EQ(values[expected[0]], -1);
        EXPECT_TRUE(others.any(ranks->rank() == 2));
        EXPECT_FALSE(others.any(false));
    });
}

TEST(FallingValues, OfAWholeMeshHaveNoOthers) {
    const SimplexMesh<3> mesh = pent::test::kuhn_box<3>({1, 1, 1}, {1, 1, 1});
    FallingValues none(MeshShare<3>{mesh});
    Eigen::VectorXd values = Eigen::VectorXd::Zero(mesh.vertex_count());
    EXPECT_TRUE(none.take_over(values).empty());
    EXPECT_TRUE(none.any(true));
    EXPECT_FALSE(none.any(false));
}

}  // namespace
}  // namespace pent::simulator
