#include "model/part_bodies.h"

#include "contact_scenes.h"
#include "cut_meshes.h"
#include "model/held_vertices.h"
#include "model/near_cells.h"
#include "model/nearest_in_body.h"
#include "model/part_selection.h"
#include "scenes.h"
#include "support/messages.h"
#include "thread_ranks.h"

#include <pent/facets.h>
#include <pent/simulator/mesh_parts.h>
#include <pent/simulator/placed_mesh.h>
#include <pent/simulator/simulation.h>

#include <gtest/gtest.h>

#include <initializer_list>
#include <numeric>
#include <string>
#include <utility>

namespace pent::simulator {
namespace {

using pent::test::error_of;
using pent::test::expect_contains;

// Two bars one beside the other, of which one is turned.
Scene two_bars() {
    Scene scene = test::box_scene<4>();
    Body second = scene.bodies[0];
    second.name = "second";
    second.place.translate = Eigen::Vector4d(0, 3, 0, 0);
    second.place.rotate = {{.plane = {0, 2}, .degrees = 30}};
    scene.bodies.push_back(second);
    scene.constraints = {test::hold(
        HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6}, test::still(4))};
    return scene;
}

// With labels, two to a cube.
std::vector<SimplexMesh<4>> bars() {
    SimplexMesh<4> bar = test::bar();
    for (Eigen::Index cell = 0; cell < bar.cell_count(); ++cell) {
        bar.regions.push_back(static_cast<std::uint16_t>(cell / 24 + cell % 2));
    }
    return {bar, bar};
}

// The same cells as the children of quadratic ones.
std::vector<SimplexMesh<4>> quadratic_bars() {
    SimplexMesh<4> bar = pent::test::quadratic_kuhn_box<4>({3, 1, 1, 1}, {1.5, 0.5, 0.5, 0.5});
    const SimplexMesh<4> layered = test::bar();
    bar.layers = layered.layers;
    bar.columns = layered.columns;
    for (const std::uint32_t parent : bar.parents) {
        bar.regions.push_back(static_cast<std::uint16_t>(parent % 7));
    }
    return {bar, bar};
}

// The same with regions by all that selects, and with what takes hold of cells with a label.
Scene bars_of_regions(ElementKind kind = ElementKind::Linear) {
    Scene scene = two_bars();
    scene.solver.elements = kind;
    const auto region = [&](const std::string& name, const Selection& select, double density) {
        Region made{.name = name, .select = {select}, .material = scene.bodies[0].material};
        made.material.density = density;
        return made;
    };
    scene.bodies[0].regions = {
        region("ball", BallSelection{.center = Eigen::Vector4d(0.4, 0.2, 0.2, 0.2), .radius = 0.3},
               500),
        region("label", RegionSelection{.region = 5}, 700)};
    scene.bodies[1].regions = {
        region("layers",
               LayerSelection{.first = 0, .last = kind == ElementKind::Quadratic ? 2U : 1U}, 300)};
    scene.constraints.push_back(test::hold(RegionSelection{.region = 5}, test::still(4)));
    scene.constraints.back().body = "second";
    scene.loads = {{.body = "box",
                    .select = {RegionSelection{.region = 5}, RegionSelection{.region = 2}},
                    .force = Eigen::Vector4d(0, 0, 3, 0)}};
    return scene;
}

// What is made of parts is what is made of whole meshes, but for the cells of the meshes.
void expect_those_of_whole_meshes(const Scene& scene,
                                  const std::vector<SimplexMesh<4>>& meshes = bars()) {
    const Bodies<4> all = make_bodies<4>(scene, meshes);
    ASSERT_FALSE(is_of_parts(all));
    for (const int count : {1, 2, 3, 5}) {
        SCOPED_TRACE(count);
        test::on_ranks(count, [&](const std::shared_ptr<const Ranks>& ranks) {
            const Bodies<4> own =
                make_part_bodies<4>(scene, test::cut_meshes<4>(scene, meshes, *ranks), ranks);
            EXPECT_TRUE(is_of_parts(own));
            EXPECT_EQ(own.rest(), all.rest());
            EXPECT_EQ(own.masses, all.masses);
            EXPECT_NEAR(own.large_energy, all.large_energy, 1e-12 * all.large_energy);
            EXPECT_EQ(own.cell_count, all.cell_count);
            EXPECT_EQ(own.first_vertex, all.first_vertex);
            EXPECT_EQ(HeldVertices<4>(scene, own).now(), HeldVertices<4>(scene, all).now());
            Bodies<4> near = all;
            near.sharing = own.sharing;
            keep_near_cells(scene.solver.elements, near);
            EXPECT_EQ(own.cells(), near.cells());
            EXPECT_EQ(own.mesh_cells, near.mesh_cells);
            ASSERT_EQ(own.ranges.size(), near.ranges.size());
            for (std::size_t range = 0; range < near.ranges.size(); ++range) {
                EXPECT_EQ(own.ranges[range].begin, near.ranges[range].begin);
                EXPECT_EQ(own.ranges[range].end, near.ranges[range].end);
                EXPECT_EQ(own.ranges[range].body, near.ranges[range].body);
                EXPECT_EQ(own.ranges[range].region, near.ranges[range].region);
                EXPECT_EQ(own.ranges[range].material.density, near.ranges[range].material.density);
            }
            for (const Load& load : scene.loads) {
                EXPECT_EQ(select_vertices(own, 0, load.select, ""),
                          select_vertices(all.meshes[0], load.select, ""));
            }
            EXPECT_EQ(own.quadratic.nodes, near.quadratic.nodes);
            EXPECT_EQ(own.quadratic.parents, near.quadratic.parents);
            EXPECT_EQ(number_columns(own.meshes).columns, number_columns(all.meshes).columns);
            EXPECT_EQ(own.meshes[1].positions, all.meshes[1].positions);
            EXPECT_EQ(own.meshes[1].cell_count(), 0);
            for (std::size_t body = 0; body < 2; ++body) {
                EXPECT_EQ(boundary_of(own, body),
                          match_facets<4>(all.meshes[body].cells, all.meshes[body].vertex_count())
                              .boundary);
            }
        });
    }
}

TEST(PartBodies, AreThoseOfWholeMeshes) {
    expect_those_of_whole_meshes(two_bars());
}

TEST(PartBodies, HaveTheRegionsOfWholeMeshesAndWhatLabelsSelect) {
    const Scene scene = bars_of_regions();
    EXPECT_TRUE(are_labels_asked_for(scene, scene.bodies[0]));
    EXPECT_TRUE(are_labels_asked_for(scene, scene.bodies[1]));
    EXPECT_FALSE(are_labels_asked_for(two_bars(), two_bars().bodies[0]));
    expect_those_of_whole_meshes(scene);
}

TEST(PartBodies, HaveTheCellsAroundTheirEdgesWhereElementsAreSmoothed) {
    expect_those_of_whole_meshes(bars_of_regions(ElementKind::Smoothed));
}

TEST(PartBodies, HaveTheQuadraticCellsOfWholeMeshesWithTheirRegions) {
    const Scene scene = bars_of_regions(ElementKind::Quadratic);
    expect_those_of_whole_meshes(scene, quadratic_bars());
}

// Vertices of one bar within another, at corners that many cells of several ranks share, and beyond
// it: to the bit those of whole meshes.
TEST(PartBodies, FindThePointsThatAreNearestToVertices) {
    Scene scene = bars_of_regions();
    scene.bodies[1].place.translate = Eigen::Vector4d(0.5, 0.25, 0, 0);
    scene.bodies[1].place.rotate.clear();
    const Bodies<4> all = make_bodies<4>(scene, bars());
    const Workers workers(1);
    std::vector<std::uint32_t> vertices(static_cast<std::size_t>(all.vertices(1).size));
    std::iota(vertices.begin(), vertices.end(), static_cast<std::uint32_t>(all.vertices(1).begin));
    const auto expected = nearest_in_body(workers, all, 0, vertices);
    std::size_t inside = 0;
    for (const MaterialPoint<4>& point : expected) {
        inside += point.distance == 0 ? 1 : 0;
    }
    EXPECT_GT(inside, 10U);
    EXPECT_LT(inside + 10, vertices.size());
    for (const int count : {1, 2, 3, 4}) {
        test::on_ranks(count, [&](const std::shared_ptr<const Ranks>& ranks) {
            const Bodies<4> own =
                make_part_bodies<4>(scene, test::cut_meshes<4>(scene, bars(), *ranks), ranks);
            const auto found = nearest_in_body(workers, own, 0, vertices);
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                EXPECT_EQ(found[i].vertices, expected[i].vertices) << i;
                EXPECT_EQ(found[i].weights, expected[i].weights) << i;
                EXPECT_EQ(found[i].distance, expected[i].distance) << i;
            }
        });
    }
}

// All ranks say what one with whole meshes says, whatever cells they have.
TEST(PartBodies, RefuseSelectionsOfNothingInTheWordsOfWholeMeshes) {
    const auto refuses = [](const auto& change, std::initializer_list<std::string> words) {
        for (const ElementKind kind : {ElementKind::Linear, ElementKind::Quadratic}) {
            Scene scene = bars_of_regions(kind);
            const std::vector<SimplexMesh<4>> meshes =
                kind == ElementKind::Linear ? bars() : quadratic_bars();
            change(scene);
            const std::string alone = error_of([&] { Simulation<4>(scene, meshes); });
            expect_contains(alone, words);
            test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
                EXPECT_EQ(error_of([&] {
                              Simulation<4>(scene, test::cut_meshes<4>(scene, meshes, *ranks),
                                            {.ranks = ranks});
                          }),
                          alone);
            });
        }
    };
    const auto region_of = [&](const Selection& select) {
        return [=](Scene& scene) { scene.bodies[0].regions[1].select = {select}; };
    };
    refuses(region_of(RegionSelection{.region = 99}),
            {"region \"label\" selects no cell", "the mesh has the regions 0 to",
             "the body as placed reaches from"});
    refuses(region_of(BallSelection{.center = Eigen::Vector4d(1.7, 0.3, 0.2, 0.1), .radius = 0.01}),
            {"region \"label\" selects no cell", "the nearest cell is", "m away"});
    refuses(region_of(BoxSelection{.low = Eigen::Vector4d(-3, -3, -3, -3),
                                   .high = Eigen::Vector4d(-1, -1, -1, -1)}),
            {"region \"label\" selects no cell", "the nearest cell is", "m away"});
    refuses(region_of(HalfSpaceSelection{.normal = Eigen::Vector4d(0, 0, 1, 0), .offset = -3}),
            {"region \"label\" selects no cell", "the nearest cell is", "m away"});
    refuses(
        [](Scene& scene) {
            scene.activations = {
                {.body = "second",
                 .select = {BallSelection{.center = Eigen::Vector4d(9, 9, 9, 9), .radius = 1}},
                 .stretch = 1.1}};
        },
        {"activation of \"second\" selects no cell", "the nearest cell is"});
    refuses(
        [](Scene& scene) {
            scene.activations = {{.body = "second",
                                  .select = {EverythingSelection{}},
                                  .stretch = 1.1,
                                  .fibers = Fibers::Mesh}};
        },
        {"activation of \"second\"", "the mesh has none"});
    const auto by_distance = [](const Selection& from) {
        return [=](Scene& scene) {
            scene.activations = {{.body = "box",
                                  .select = {EverythingSelection{}},
                                  .stretch = 1.1,
                                  .fibers = Fibers::Distance,
                                  .away_from = {from}}};
        };
    };
    refuses(
        by_distance(RegionSelection{.region = 99}),
        {"activation of \"box\" (away_from) selects no vertex", "the mesh has the regions 0 to"});
    refuses(by_distance(BallSelection{.center = Eigen::Vector4d(9, 9, 9, 9), .radius = 1}),
            {"activation of \"box\" (away_from) selects no vertex", "the nearest vertex is"});
    refuses([](Scene& scene) { scene.loads[0].select = {RegionSelection{.region = 99}}; },
            {"load on \"box\" selects no vertex", "the mesh has the regions 0 to"});
    refuses(
        [](Scene& scene) {
            scene.bodies[1].regions[0].select = {LayerSelection{.first = 7, .last = 9}};
        },
        {"region \"layers\" selects no cell", "the mesh has the layers 0 to 2"});
}

// A body in two pieces, of which no way leads from one to the other: all ranks name one vertex.
TEST(PartBodies, SayWhichVertexNoWayLeadsTo) {
    Scene scene = test::swinging_bar();
    const SimplexMesh<4> one = test::bar();
    const Eigen::Index count = one.vertex_count();
    SimplexMesh<4> mesh;
    mesh.positions.resize(4, 2 * count);
    mesh.positions << one.positions, (one.positions.colwise() + Eigen::Vector4d(9, 0, 0, 0));
    mesh.cells.resize(5, 2 * one.cell_count());
    mesh.cells << (one.cells.array() + static_cast<std::uint32_t>(count)).matrix(), one.cells;
    scene.activations = {{.body = "box",
                          .select = {EverythingSelection{}},
                          .stretch = 0.9,
                          .fibers = Fibers::Distance,
                          .away_from = {test::left_end()}}};
    const std::string alone = error_of([&] { Simulation<4>(scene, {mesh}); });
    expect_contains(alone, {"no way within the body leads from \"away_from\" to vertex "
                            + std::to_string(count) + "; select a vertex of each of its parts"});
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        EXPECT_EQ(error_of([&] {
                      Simulation<4>(scene, test::cut_meshes<4>(scene, {mesh}, *ranks),
                                    {.ranks = ranks});
                  }),
                  alone);
    });
}

// Those with an even sum of corners, say.
TEST(PartBodies, ListCellsOfAllRanksInTheirOrder) {
    const Scene scene = two_bars();
    const auto is_wanted = [](const Eigen::Matrix<std::uint32_t, 5, 1>& cell) {
        return cell.sum() % 2 == 0;
    };
    const CellList<4> expected = list_cells<4>(make_bodies<4>(scene, bars()), is_wanted);
    ASSERT_GT(expected.cells.size(), 10U);
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        const CellList<4> found = list_cells<4>(
            make_part_bodies<4>(scene, test::cut_meshes<4>(scene, bars(), *ranks), ranks),
            is_wanted);
        EXPECT_EQ(found.cells, expected.cells);
        EXPECT_EQ(found.bodies, expected.bodies);
    });
}

TEST(PartBodies, AreRefusedWithoutRanks) {
    const Scene scene = two_bars();
    test::on_ranks(2, [&](const std::shared_ptr<const Ranks>& ranks) {
        expect_contains(
            error_of([&] { Simulation<4>(scene, test::cut_meshes<4>(scene, bars(), *ranks), {}); }),
            {"without ranks"});
    });
}

// One rank finds it, all are told.
TEST(PartBodies, SayWhichCellOfTheWholeMeshIsWrong) {
    const Scene scene = two_bars();
    test::on_ranks(3, [&](const std::shared_ptr<const Ranks>& ranks) {
        std::vector<MeshPart<4>> parts = test::cut_meshes<4>(scene, bars(), *ranks);
        const auto last = static_cast<std::uint32_t>(parts[1].cell_count - 1);
        if (!parts[1].numbers.empty() && parts[1].numbers.back() == last) {
            auto cell = parts[1].mesh.cells.rightCols(1);
            std::swap(cell(0, 0), cell(1, 0));
        }
        expect_contains(
            error_of([&] { Simulation<4>(scene, std::move(parts), {.ranks = ranks}); }),
            {"as placed for body \"second\"", "pentachoron " + std::to_string(last), "inverted"});
    });
}

TEST(PartBodies, RefuseOtherVerticesAndChangesOfTheScene) {
    const Scene scene = two_bars();
    test::on_ranks(2, [&](const std::shared_ptr<const Ranks>& ranks) {
        std::vector<MeshPart<4>> parts = test::cut_meshes<4>(scene, bars(), *ranks);
        Simulation<4> simulation(scene, parts, {.ranks = ranks});
        expect_contains(error_of([&] { simulation.remove_body(0); }), {"whole meshes"});
        expect_contains(error_of([&] { simulation.add_body(scene.bodies[0], test::bar()); }),
                        {"whole meshes"});
        parts[0].mesh.positions(0, 0) -= 1e-3 * ranks->rank();
        expect_contains(error_of([&] { Simulation<4>(scene, parts, {.ranks = ranks}); }),
                        {"rank 1 has other meshes than rank 0"});
    });
}

}  // namespace
}  // namespace pent::simulator
