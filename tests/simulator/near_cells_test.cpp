#include "model/near_cells.h"

#include "model/body_dofs.h"
#include "model/quadratic_cells.h"
#include "scenes.h"
#include "step/rank_agreement.h"
#include "support/kuhn_box.h"
#include "thread_ranks.h"

#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace pent::simulator {
namespace {

// Two bars one beside the other, the right half of the first and the left one of the other of
// another material.
Scene two_bars() {
    Scene scene = test::box_scene<4>();
    Body second = scene.bodies[0];
    second.name = "second";
    second.place.translate = Eigen::Vector4d(0, 1, 0, 0);
    scene.bodies.push_back(second);
    for (const double side : {-1.0, 1.0}) {
        Material stiff = scene.bodies[0].material;
        stiff.lame = lame_from_young(4, side > 0 ? 1e7 : 1e6, 0.3);
        stiff.density = 500;
        const HalfSpaceSelection half{.normal = Eigen::Vector4d(side, 0, 0, 0),
                                      .offset = 0.75 * side};
        scene.bodies[side > 0 ? 1 : 0].regions = {
            {.name = "stiff", .select = {half}, .material = stiff}};
    }
    return scene;
}

std::vector<SimplexMesh<4>> meshes() {
    return {test::bar(), test::bar()};
}

// All cells that touch a vertex of a rank, and no others, in the order in which all are, each with
// its body, its material and its number in the mesh.
TEST(NearCells, AreThoseThatTouchAVertexOfTheRank) {
    const Scene scene = two_bars();
    const Bodies<4> all = make_bodies<4>(scene, meshes());
    for (const int count : {1, 2, 3, 4}) {
        SCOPED_TRACE(count);
        test::on_ranks(count, [&](const std::shared_ptr<const Ranks>& ranks) {
            const Bodies<4> near = share(scene, make_bodies<4>(scene, meshes()), ranks);
            EXPECT_EQ(near.cell_count, all.cells().cols());
            ASSERT_EQ(near.ranges.size(), all.ranges.size());
            Eigen::Index next = 0;
            for (std::size_t i = 0; i < all.ranges.size(); ++i) {
                const CellRange& range = all.ranges[i];
                EXPECT_EQ(near.ranges[i].begin, next);
                for (Eigen::Index cell = range.begin; cell < range.end; ++cell) {
                    const auto corners = all.cells().col(cell);
                    if (std::any_of(corners.begin(), corners.end(), [&](std::uint32_t vertex) {
                            return near.sharing.owns(vertex);
                        })) {
                        ASSERT_LT(next, near.cells().cols());
                        EXPECT_EQ(near.cells().col(next), corners);
                        EXPECT_EQ(near.mesh_cell(range.body, next),
                                  all.mesh_cell(range.body, cell));
                        ++next;
                    }
                }
                EXPECT_EQ(near.ranges[i].end, next);
                EXPECT_EQ(near.ranges[i].material.density, range.material.density);
            }
            EXPECT_EQ(near.cells().cols(), next);
            for (std::size_t body = 0; body < all.count(); ++body) {
                EXPECT_EQ(near.cells_of(body).begin, near.ranges[2 * body].begin);
                EXPECT_EQ(near.first_cell[body + 1], near.ranges[2 * body + 1].end);
            }
        });
    }
}

// Of quadratic cells all that have a node of the rank, with all of their children, by parents and
// where these follow one another.
TEST(NearCells, AreAllChildrenOfQuadraticCellsOfTheRank) {
    const SimplexMesh<4> with_parents =
        pent::test::quadratic_kuhn_box<4>({3, 1, 1, 1}, {1.5, 0.5, 0.5, 0.5});
    SimplexMesh<4> in_order = with_parents;
    const std::vector<Eigen::Index> children = child_cells<4>(with_parents, "");
    in_order.cells = with_parents.cells(Eigen::all, children);
    in_order.parents.clear();
    for (const SimplexMesh<4>& mesh : {with_parents, in_order}) {
        Scene scene = two_bars();
        scene.solver.elements = ElementKind::Quadratic;
        const Bodies<4> all = make_bodies<4>(scene, {mesh, mesh});
        test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
            const Bodies<4> near = share(scene, make_bodies<4>(scene, {mesh, mesh}), ranks);
            std::vector<Eigen::Index> simplices;
            for (Eigen::Index i = 0; i < all.quadratic.nodes.cols(); ++i) {
                const auto nodes = all.quadratic.nodes.col(i);
                if (std::any_of(nodes.begin(), nodes.end(),
                                [&](std::uint32_t vertex) { return near.sharing.owns(vertex); })) {
                    simplices.push_back(i);
                }
            }
            EXPECT_LT(simplices.size(), static_cast<std::size_t>(all.quadratic.nodes.cols()));
            EXPECT_EQ(near.quadratic.nodes, all.quadratic.nodes(Eigen::all, simplices));
            std::vector<Eigen::Index> cells;
            std::vector<std::uint32_t> parents;
            for (Eigen::Index cell = 0; cell < all.cells().cols(); ++cell) {
                const std::uint32_t parent = all.quadratic.parents[static_cast<std::size_t>(cell)];
                const auto place = std::lower_bound(simplices.begin(), simplices.end(), parent);
                if (place != simplices.end() && *place == parent) {
                    cells.push_back(cell);
                    parents.push_back(static_cast<std::uint32_t>(place - simplices.begin()));
                }
            }
            EXPECT_EQ(near.cells(), all.cells()(Eigen::all, cells));
            EXPECT_EQ(near.quadratic.parents, parents);
            for (std::size_t i = 0; i < all.ranges.size(); ++i) {
                const auto before = [&](Eigen::Index end) {
                    return std::lower_bound(simplices.begin(), simplices.end(), end)
                           - simplices.begin();
                };
                EXPECT_EQ(near.quadratic.ranges[i].begin, before(all.quadratic.ranges[i].begin));
                EXPECT_EQ(near.quadratic.ranges[i].end, before(all.quadratic.ranges[i].end));
            }
        });
    }
}

// Of smoothed elements those of every edge of which a cell touches a vertex of the rank, complete:
// all cells that share two vertices with such a cell are there.
TEST(NearCells, AreAllAroundTheEdgesOfSmoothedElementsOfTheRank) {
    Scene scene = two_bars();
    scene.solver.elements = ElementKind::Smoothed;
    const std::vector<SimplexMesh<4>> long_bars = {test::bar(12), test::bar(12)};
    const Bodies<4> all = make_bodies<4>(scene, long_bars);
    test::on_ranks(4, [&](const std::shared_ptr<const Ranks>& ranks) {
        const Bodies<4> near = share(scene, make_bodies<4>(scene, long_bars), ranks);
        std::set<std::pair<std::uint32_t, std::uint32_t>> edges;  // of cells that touch a vertex
        const auto for_each_edge = [&](Eigen::Index cell, const auto& visit) {
            for (const std::uint32_t a : all.cells().col(cell)) {
                for (const std::uint32_t b : all.cells().col(cell)) {
                    if (a < b) {
                        visit(std::pair(a, b));
                    }
                }
            }
        };
        for (Eigen::Index cell = 0; cell < all.cells().cols(); ++cell) {
            const auto corners = all.cells().col(cell);
            if (std::any_of(corners.begin(), corners.end(),
                            [&](std::uint32_t vertex) { return near.sharing.owns(vertex); })) {
                for_each_edge(cell, [&](const auto& edge) { edges.insert(edge); });
            }
        }
        std::set<std::vector<std::uint32_t>> kept;
        for (const auto cell : near.cells().colwise()) {
            kept.emplace(cell.begin(), cell.end());
        }
        EXPECT_LT(near.cells().cols(), all.cells().cols());
        for (Eigen::Index cell = 0; cell < all.cells().cols(); ++cell) {
            bool is_needed = false;
            for_each_edge(
                cell, [&](const auto& edge) { is_needed = is_needed || edges.count(edge) > 0; });
            const auto corners = all.cells().col(cell);
            EXPECT_LE(is_needed, kept.count({corners.begin(), corners.end()}) > 0) << cell;
        }
    });
}

TEST(NearCells, CoupleAnythingWhereATermDoes) {
    const Scene scene = two_bars();
    EXPECT_FALSE(do_terms_couple_anything(scene));
    Scene touching = scene;
    touching.contact.emplace();
    EXPECT_TRUE(do_terms_couple_anything(touching));
    Scene tied = scene;
    tied.attachments.resize(1);
    EXPECT_TRUE(do_terms_couple_anything(tied));
}

// Rows of a rank have columns of the vertices that share a cell with one of its own, and no others.
TEST(NearCells, HaveAllVerticesThatRowsCouple) {
    const Scene scene = two_bars();
    const Bodies<4> all = make_bodies<4>(scene, meshes());
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        const Bodies<4> near = share(scene, make_bodies<4>(scene, meshes()), ranks);
        std::vector<bool> is_coupled(static_cast<std::size_t>(all.vertex_count()), false);
        for (const auto cell : all.cells().colwise()) {
            const bool is_near = std::any_of(cell.begin(), cell.end(), [&](std::uint32_t vertex) {
                return near.sharing.owns(vertex);
            });
            for (const std::uint32_t vertex : cell) {
                is_coupled[vertex] = is_coupled[vertex] || is_near;
            }
        }
        const DofMap dofs = number_dofs(near, HeldVertices<4>(scene, near), {true, true});
        EXPECT_EQ(dofs.row_count(), near.sharing.own_count(all.vertex_count()));
        EXPECT_LT(dofs.count(), all.vertex_count());
        for (std::uint32_t vertex = 0; vertex < is_coupled.size(); ++vertex) {
            EXPECT_EQ(dofs.has_dof(vertex), is_coupled[vertex]) << vertex;
        }
    });
}

// What a cell is of is known where a rank does not have it, too.
TEST(NearCells, LeaveAGrabAsHardAsOnOneAlone) {
    Scene scene = two_bars();
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-10;
    const auto end = [&](const std::shared_ptr<const Ranks>& ranks, int body, std::int64_t cell) {
        Simulation<4> simulation(scene, meshes(), {.ranks = ranks});
        Grab<4> grab;
        grab.point = {.body = body, .cell = cell};
        grab.point.weights.setConstant(0.2);
        grab.anchor = Eigen::Vector4d(3, 3, 3, 3);
        simulation.add_grab(grab);
        EXPECT_TRUE(simulation.step().is_accepted);
        return simulation.save().positions;
    };
    const Simulation<4> start(scene, meshes());
    const std::int64_t last = start.mesh(0).cell_count() - 1;
    for (const int body : {0, 1}) {
        for (const std::int64_t cell : {std::int64_t{0}, last}) {
            const Positions<4> alone = end(nullptr, body, cell);
            const double motion = (alone - start.save().positions).norm();
            ASSERT_GT(motion, 0);
            test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
                EXPECT_LT((end(ranks, body, cell) - alone).norm(), 1e-7 * motion);
            });
        }
    }
}

}  // namespace
}  // namespace pent::simulator
