#include "cut_meshes.h"
#include "scenes.h"
#include "support/kuhn_box.h"
#include "support/messages.h"
#include "thread_ranks.h"

#include <pent/simulator/mesh_share.h>
#include <pent/simulator/placed_mesh.h>

#include <gtest/gtest.h>

namespace pent::simulator {
namespace {

using pent::test::kuhn_box;

TEST(MeshDepth, HasTwiceTheEdgesFromTheMiddleToTheBoundary) {
    const auto across = [](const auto& mesh) { return depth_of<4>({mesh}).cells_across; };
    const auto across_3d = [](const auto& mesh) { return depth_of<3>({mesh}).cells_across; };
    EXPECT_EQ(across(kuhn_box<4>({3, 1, 1, 1}, {3, 1, 1, 1})), 1);
    EXPECT_EQ(across(kuhn_box<4>({3, 2, 2, 2}, {3, 1, 1, 1})), 2);
    EXPECT_EQ(across_3d(kuhn_box<3>({4, 4, 4}, {1, 1, 1})), 4);
    EXPECT_EQ(across_3d(kuhn_box<3>({8, 6, 6}, {1, 1, 1})), 6);
}

// Of a grid all vertices but those of the grid within.
TEST(MeshDepth, CountsVerticesOfTheBoundary) {
    EXPECT_EQ(depth_of<3>({kuhn_box<3>({4, 4, 4}, {1, 1, 1})}).boundary_vertices, 125 - 27);
    EXPECT_EQ(depth_of<4>({kuhn_box<4>({3, 2, 2, 2}, {3, 1, 1, 1})}).boundary_vertices, 108 - 2);
    EXPECT_EQ(depth_of<4>({kuhn_box<4>({3, 1, 1, 1}, {3, 1, 1, 1})}).boundary_vertices, 32);
}

// Labels in stripes that a rank may have none of.
SimplexMesh<3> striped_box() {
    SimplexMesh<3> mesh = kuhn_box<3>({8, 6, 6}, {8, 6, 6});
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        mesh.regions.push_back(static_cast<std::uint16_t>(cell / 200));
    }
    return mesh;
}

TEST(MeshShare, IsAskedByRanksTogetherAsAWholeMeshIs) {
    const SimplexMesh<3> mesh = striped_box();
    const std::vector<Selection> selections[] = {
        {RegionSelection{.region = 3}},
        {HalfSpaceSelection{.normal = Eigen::Vector3d(1, 0, 0), .offset = 1.5}},
        {RegionSelection{.region = 0},
         BallSelection{.center = Eigen::Vector3d(8, 6, 6), .radius = 2}},
        {EverythingSelection{}}};
    for (const ElementKind kind : {ElementKind::Linear, ElementKind::Smoothed}) {
        Scene scene = test::box_scene<3>();
        scene.solver.elements = kind;
        for (const int count : {1, 2, 3, 5}) {
            const std::vector<std::uint32_t> owners = share_vertices<3>(scene, {mesh}, count);
            test::on_ranks(count, [&](const std::shared_ptr<const Ranks>& ranks) {
                const MeshPart<3> part = test::cut_meshes<3>(scene, {mesh}, *ranks)[0];
                ASSERT_EQ(part.mesh.cell_count() < mesh.cell_count(), count > 1);
                const MeshShare<3> share{part.mesh, owners, ranks.get()};
                const MeshDepth depth = depth_of(share);
                EXPECT_EQ(depth.cells_across, 6);
                EXPECT_EQ(depth.boundary_vertices, 9 * 7 * 7 - 7 * 5 * 5);
                for (const std::vector<Selection>& select : selections) {
                    EXPECT_EQ(count_selected(share, select, "it"),
                              std::ssize(select_vertices(mesh, select, "it")));
                }
                EXPECT_EQ(count_selected(share, {RegionSelection{.region = 999}}, "it"), 0);
            });
        }
    }
}

TEST(MeshShare, SaysThatAMeshHasNoLayers) {
    const SimplexMesh<3> mesh = striped_box();
    pent::test::expect_contains(pent::test::error_of([&] {
                                    static_cast<void>(count_selected<3>(
                                        {mesh}, {LayerSelection{.first = 0, .last = 1}}, "it"));
                                }),
                                {"it selects layers"});
}

}  // namespace
}  // namespace pent::simulator
