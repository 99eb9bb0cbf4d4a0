#include "shapes.h"
#include "support/kuhn_box.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/error.h>
#include <pent/mesher/edge_order.h>
#include <pent/mesher/quality.h>
#include <pent/mesher/straight_layers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace pent::mesher {
namespace {

// A ring of triangles between an inner and an outer n-gon; vertex i is inner, n + i outer.
SimplexMesh<2> ring(int n) {
    SimplexMesh<2> mesh;
    mesh.positions.resize(2, 2 * n);
    mesh.cells.resize(3, 2 * n);
    for (int i = 0; i < n; ++i) {
        const double angle = 6.283185307179586 * i / n;
        mesh.positions.col(i) << std::cos(angle), std::sin(angle);
        mesh.positions.col(n + i) = 2 * mesh.positions.col(i);
        const int next = (i + 1) % n;
        mesh.cells.col(2 * i) << i, n + i, n + next;
        mesh.cells.col(2 * i + 1) << i, n + next, next;
    }
    validate(mesh, "ring");
    return mesh;
}

TEST(EdgesOf, GivesEveryEdgeOnce) {
    EXPECT_EQ(
        edges_of<3>((Simplices<4>(4, 2) << 0, 1, 1, 2, 2, 3, 3, 4).finished()),
        (DirectedEdges(2, 9) << 0, 0, 0, 1, 1, 1, 2, 2, 3, 1, 2, 3, 2, 3, 4, 3, 4, 4).finished());
}

TEST(OrderCells, FollowsAnyRanking) {
    const SimplexMesh<3> mesh = test::kuhn_box<3>({2, 2, 2}, {1, 1, 1});
    std::mt19937 random(3);
    std::vector<std::uint32_t> ranks(mesh.vertex_count());
    std::iota(ranks.begin(), ranks.end(), 0U);
    for (int round = 0; round < 20; ++round) {
        std::shuffle(ranks.begin(), ranks.end(), random);
        const OrderedCells<3> ordered = order_cells<3>(mesh, direct_edges<3>(mesh, ranks));
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            const auto corners = ordered.cells.col(cell);
            for (int i = 0; i < 3; ++i) {
                EXPECT_LT(ranks[corners[i]], ranks[corners[i + 1]]);
            }
            // The sign of the reordered cell tells the parity by another way.
            const double volume = cell_volume<3>(mesh.positions, ordered.cells, cell);
            EXPECT_EQ(volume < 0, ordered.is_odd[cell] != 0);
        }
    }
}

TEST(OrderCells, AcceptsACycleAroundAHoleIfNoTriangleIsOne) {
    constexpr int kSides = 7;
    const SimplexMesh<2> mesh = ring(kSides);
    // Both polygons run around and around; all other edges go outward.
    DirectedEdges edges = edges_of<2>(mesh.cells);
    for (auto edge : edges.colwise()) {
        if (edge[0] / kSides == edge[1] / kSides && edge[1] - edge[0] != 1) {
            std::swap(edge[0], edge[1]);
        }
    }
    const OrderedCells<2> ordered = order_cells<2>(mesh, edges);
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        EXPECT_EQ(cell_volume<2>(mesh.positions, ordered.cells, cell) < 0,
                  ordered.is_odd[cell] != 0);
    }
    // The last triangles of the ring run from 6 to 0 and from 13 to 7, against the numbers.
    const Eigen::Vector<std::uint32_t, 3> last(6, 0, 7);
    EXPECT_EQ(ordered.cells.col(2 * kSides - 1), last);
}

TEST(OrderCells, ListsTrianglesThatAreCycles) {
    const SimplexMesh<2> mesh = ring(7);
    DirectedEdges edges = edges_of<2>(mesh.cells);
    for (auto edge : edges.colwise()) {
        if (edge[0] == 0 && edge[1] == 8) {  // 0 -> 7 -> 8 -> 0
            std::swap(edge[0], edge[1]);
        }
    }
    test::expect_contains(test::error_of([&] { static_cast<void>(order_cells<2>(mesh, edges)); }),
                          {"2 triangles are directed cycles: 0 -> 1 -> 8, 0 -> 7 -> 8"});
}

TEST(OrderCells, RefusesEdgesThatAreNotThoseOfTheMesh) {
    const SimplexMesh<2> mesh = ring(5);
    const DirectedEdges edges = edges_of<2>(mesh.cells);
    const auto message = [&](const DirectedEdges& wrong) {
        return test::error_of([&] { static_cast<void>(order_cells<2>(mesh, wrong)); });
    };
    test::expect_contains(message(edges.rightCols(edges.cols() - 1)), {"0 1 of the mesh has none"});
    test::expect_contains(message(edges.leftCols(edges.cols() - 1)), {"8 9 of the mesh has none"});
    DirectedEdges more(2, edges.cols() + 1);
    more << edges, Eigen::Vector<std::uint32_t, 2>(1, 0);
    test::expect_contains(message(more), {"edge 0 1 is there twice"});
    more.col(edges.cols()) << 2, 9;
    test::expect_contains(message(more), {"2 9 is not an edge of the mesh"});
    more.col(edges.cols()) << 9, 9;
    test::expect_contains(message(more), {"9 9 is not an edge of the mesh"});
}

TEST(RankVertices, SweepsAlongTheLongestSide) {
    const SimplexMesh<3> mesh = test::kuhn_box<3>({1, 3, 1}, {1, 5, 2});
    const std::vector<std::uint32_t> ranks = rank_vertices(mesh, VertexOrder::Sweep);
    for (Eigen::Index a = 0; a < mesh.vertex_count(); ++a) {
        for (Eigen::Index b = 0; b < mesh.vertex_count(); ++b) {
            if (mesh.positions(1, a) < mesh.positions(1, b)) {
                EXPECT_LT(ranks[a], ranks[b]);
            }
        }
    }
}

TEST(ImproveRanks, MakesTheWorstSimplicesBetter) {
    SimplexMesh<3> base = test::kuhn_box<3>({3, 3, 3}, {1, 1, 1});
    std::mt19937 random(4);
    std::uniform_real_distribution<double> jitter(-0.06, 0.06);
    base.positions = base.positions.unaryExpr([&](double x) { return x + jitter(random); }).eval();
    validate(base, "base");
    std::vector<std::uint32_t> ranks(base.vertex_count());
    std::iota(ranks.begin(), ranks.end(), 0U);
    std::shuffle(ranks.begin(), ranks.end(), random);
    const Eigen::Vector4d slab(0, 0, 0, 0.3);
    const auto worst = [&](const std::vector<std::uint32_t>& order) {
        const auto ordered = order_cells<3>(base, direct_edges<3>(base, order));
        const auto mesh = extrude<4>(base, ordered, straight_layers<4>(slab, 1));
        return measure_quality(mesh).mean_ratio.min;
    };
    const std::vector<std::uint32_t> improved = improve_ranks<3>(base, ranks, slab);
    EXPECT_GT(worst(improved), worst(ranks));
    std::vector<std::uint32_t> sorted = improved;
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> all(sorted.size());
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_EQ(sorted, all);
}

TEST(ReadDirectedEdges, ReadsPairsAndNamesTheLineOfWhatIsWrong) {
    const test::TempFolder folder;
    const auto path = folder / "edges.txt";
    test::write_file(path, "# directions\n0 1\n\n3 2 # down\n");
    EXPECT_EQ(read_directed_edges(path, 4), (DirectedEdges(2, 2) << 0, 3, 1, 2).finished());
    const auto message = [&](const std::string& text) {
        test::write_file(path, text);
        return test::error_of([&] { static_cast<void>(read_directed_edges(path, 4)); });
    };
    test::expect_contains(message("0 1\n0 4\n"), {"edges.txt: line 2: vertex 4 of 4"});
    test::expect_contains(message("0 -1\n"), {"vertex -1"});
    test::expect_contains(message("0\n"), {"line 1"});
    test::expect_contains(message("0 1 2\n"), {"more than two"});
    test::expect_contains(message("0 x\n"), {"\"x\""});
}

}  // namespace
}  // namespace pent::mesher
