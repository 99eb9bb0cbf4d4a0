#include "cut_cells.h"

#include "support/messages.h"

#include <pent/mesher/prove.h>
#include <pent/simplex_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace pent::mesher {
namespace {

using Corners = std::vector<std::uint32_t>;

struct Cell {
    CellKind kind;
    Corners corners;
};

// The corners of the unit cube, as a hexahedron has them.
const std::vector<Eigen::Vector3d> kCube = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                            {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
const Cell kHexahedron = {CellKind::Hexahedron, {0, 1, 2, 3, 4, 5, 6, 7}};

std::vector<Eigen::Vector3d> with(std::vector<Eigen::Vector3d> points,
                                  const std::vector<Eigen::Vector3d>& more) {
    points.insert(points.end(), more.begin(), more.end());
    return points;
}

// The cells with point i called names[i].
CellSoup renamed(const std::vector<Eigen::Vector3d>& points,
                 const std::vector<Cell>& cells,
                 const Corners& names) {
    CellSoup soup;
    soup.points.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        soup.points[names[i]] = points[i];
    }
    for (const Cell& cell : cells) {
        Corners corners;
        for (const std::uint32_t corner : cell.corners) {
            corners.push_back(names[corner]);
        }
        soup.add(cell.kind, corners);
    }
    return soup;
}

Corners in_order(std::size_t count) {
    Corners names(count);
    std::iota(names.begin(), names.end(), 0U);
    return names;
}

SimplexMesh<3> mesh_of(const CellSoup& soup) {
    const CutCells cut = cut_cells(soup, "test");
    SimplexMesh<3> mesh;
    mesh.positions.resize(3, static_cast<Eigen::Index>(soup.points.size()));
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        mesh.positions.col(static_cast<Eigen::Index>(i)) = soup.points[i];
    }
    mesh.cells.resize(4, static_cast<Eigen::Index>(cut.tets.size()));
    for (std::size_t t = 0; t < cut.tets.size(); ++t) {
        for (int i = 0; i < 4; ++i) {
            mesh.cells(i, static_cast<Eigen::Index>(t)) = cut.tets[t][i];
        }
    }
    return mesh;
}

struct Expected {
    double volume = 0;
    std::int64_t boundary_facets = 0;  // one more would be a crack between cells
    std::int64_t cells = 0;
};

void expect_cut(const CellSoup& soup, const Expected& expected) {
    const SimplexMesh<3> mesh = mesh_of(soup);
    ASSERT_NO_THROW(validate(mesh, "test"));
    const Proof proof = prove<3>(mesh, expected.volume);
    ASSERT_TRUE(proof.holds()) << describe_faults(proof, 3);
    ASSERT_EQ(proof.boundary_facets, expected.boundary_facets);
    ASSERT_EQ(proof.cells, expected.cells);
}

void expect_cut_in_every_order(const std::vector<Eigen::Vector3d>& points,
                               const std::vector<Cell>& cells,
                               const Expected& expected) {
    Corners names = in_order(points.size());
    do {
        expect_cut(renamed(points, cells, names), expected);
        if (testing::Test::HasFatalFailure()) {
            return;
        }
    } while (std::next_permutation(names.begin(), names.end()));
}

void expect_cut_in_random_orders(const std::vector<Eigen::Vector3d>& points,
                                 const std::vector<Cell>& cells,
                                 const Expected& expected) {
    std::mt19937 random(5);  // NOLINT(cert-msc51-cpp): the same orders every time
    Corners names = in_order(points.size());
    for (int i = 0; i < 3000 && !testing::Test::HasFatalFailure(); ++i) {
        std::shuffle(names.begin(), names.end(), random);
        expect_cut(renamed(points, cells, names), expected);
    }
}

TEST(CutCells, FillACellInEveryOrderOfItsVertices) {
    const std::vector<Eigen::Vector3d> pyramid = {
        {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}};
    expect_cut_in_every_order(pyramid, {{CellKind::Pyramid, {0, 1, 2, 3, 4}}}, {1.0 / 3, 6, 2});
    const std::vector<Eigen::Vector3d> prism = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                                {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    expect_cut_in_every_order(prism, {{CellKind::Prism, {0, 1, 2, 3, 4, 5}}}, {0.5, 8, 3});
    expect_cut_in_every_order(kCube, {kHexahedron}, {1, 12, 6});
}

TEST(CutCells, AgreeWithTheirNeighborsInEveryOrderOfAllVertices) {
    const std::vector<Eigen::Vector3d> octahedron = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},
                                                     {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
    expect_cut_in_every_order(
        octahedron, {{CellKind::Pyramid, {0, 1, 2, 3, 4}}, {CellKind::Pyramid, {3, 2, 1, 0, 5}}},
        {2.0 / 3, 8, 4});
    // The cube as two prisms that share the rectangle 0 2 6 4.
    expect_cut_in_every_order(
        kCube, {{CellKind::Prism, {0, 1, 2, 4, 5, 6}}, {CellKind::Prism, {0, 2, 3, 4, 6, 7}}},
        {1, 12, 6});
}

TEST(CutCells, OfAllKindsAgree) {
    // A cube; a pyramid above it, a tetrahedron at the pyramid's side; a prism at x = 1; a cube at
    // x = -1.
    const std::vector<Eigen::Vector3d> points = with(kCube, {{0.5, 0.5, 2},
                                                             {2, 0.5, 2},
                                                             {2, 0, 0},
                                                             {2, 1, 0},
                                                             {-1, 0, 0},
                                                             {-1, 1, 0},
                                                             {-1, 0, 1},
                                                             {-1, 1, 1}});
    const std::vector<Cell> cells = {kHexahedron,
                                     {CellKind::Pyramid, {4, 5, 6, 7, 8}},
                                     {CellKind::Tetrahedron, {5, 6, 8, 9}},
                                     {CellKind::Prism, {1, 10, 5, 2, 11, 6}},
                                     {CellKind::Hexahedron, {12, 0, 3, 13, 14, 4, 7, 15}}};
    // Outside are 3 + 5 squares of the cubes, 3 triangles of the pyramid, 3 of the tetrahedron, and
    // two of each kind of the prism.
    expect_cut_in_random_orders(
        points, cells,
        {2 + 1.0 / 3 + 0.25 + 0.5, 2 * (3 + 5) + 3 + 3 + 2 + 2 * 2, 6 + 2 + 1 + 3 + 6});
}

TEST(CutCells, FitAGridOfHexahedraWithBentFaces) {
    std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same grid every time
    std::uniform_real_distribution<double> shift(-0.1, 0.1);
    constexpr int kSide = 4;
    const auto name = [](int x, int y, int z) {
        return static_cast<std::uint32_t>(x + (kSide + 1) * (y + (kSide + 1) * z));
    };
    std::vector<Eigen::Vector3d> points;
    std::vector<Cell> cells;
    for (int z = 0; z <= kSide; ++z) {
        for (int y = 0; y <= kSide; ++y) {
            for (int x = 0; x <= kSide; ++x) {
                points.emplace_back(x + shift(random), y + shift(random), z + shift(random));
                if (x < kSide && y < kSide && z < kSide) {
                    cells.push_back({CellKind::Hexahedron,
                                     {name(x, y, z), name(x + 1, y, z), name(x + 1, y + 1, z),
                                      name(x, y + 1, z), name(x, y, z + 1), name(x + 1, y, z + 1),
                                      name(x + 1, y + 1, z + 1), name(x, y + 1, z + 1)}});
                }
            }
        }
    }
    Corners names = in_order(points.size());
    for (int i = 0; i < 20; ++i) {
        std::shuffle(names.begin(), names.end(), random);
        // Bent faces belong to whatever their diagonals make of them: the volume is that of the
        // boundary.
        expect_cut(renamed(points, cells, names), {0, 6 * 2 * kSide * kSide, 6 * 64});
    }
}

// Tetrahedra over the face of the unit cube at x = 1, which cut it by one of its diagonals.
std::vector<Cell> tetrahedra_over(const Corners& face, bool is_other_diagonal, std::uint32_t tip) {
    const std::size_t a = is_other_diagonal ? 1 : 0;
    return {{CellKind::Tetrahedron, {face[a], face[a + 1], face[(a + 2) % 4], tip}},
            {CellKind::Tetrahedron, {face[a], face[(a + 2) % 4], face[(a + 3) % 4], tip}}};
}

TEST(CutCells, TakeTheDiagonalThatTrianglesOnTheOtherSideHave) {
    const std::vector<Eigen::Vector3d> points = with(kCube, {{2, 0.5, 0.5}});
    for (const bool is_other : {false, true}) {
        std::vector<Cell> cells = tetrahedra_over({1, 2, 6, 5}, is_other, 8);
        cells.push_back(kHexahedron);
        expect_cut_in_random_orders(points, cells, {1 + 1.0 / 3, 5 * 2 + 4, 6 + 2});
        // One triangle alone asks for its diagonal, too.
        cells.erase(cells.begin());
        expect_cut_in_random_orders(points, cells, {1 + 1.0 / 6, 5 * 2 + 1 + 3, 6 + 1});
    }
}

TEST(CutCells, MeetTheDiagonalsOfAllSidesWhereAnyOrderDoes) {
    // A tip in front of every side; by the parity of its corners each side has an even and an odd
    // diagonal.
    const std::vector<Eigen::Vector3d> points = with(
        kCube, {{-1, .5, .5}, {2, .5, .5}, {.5, -1, .5}, {.5, 2, .5}, {.5, .5, -1}, {.5, .5, 2}});
    const std::vector<Corners> sides = {{0, 4, 7, 3}, {2, 1, 5, 6}, {0, 1, 5, 4},
                                        {2, 3, 7, 6}, {0, 1, 2, 3}, {5, 4, 7, 6}};  // evens first
    int cut = 0;
    for (unsigned choice = 0; choice < 64; ++choice) {
        std::vector<Cell> cells = {kHexahedron};
        for (unsigned side = 0; side < 6; ++side) {
            for (const Cell& cell :
                 tetrahedra_over(sides[side], (choice >> side & 1U) != 0, 8 + side)) {
                cells.push_back(cell);
            }
        }
        const CellSoup soup = renamed(points, cells, in_order(points.size()));
        // Whether any order of the cube's vertices has the wanted diagonals, by trying all.
        bool has_order = false;
        Corners names = in_order(8);
        do {
            bool serves = true;
            for (unsigned side = 0; side < 6 && serves; ++side) {
                const Corners& around = sides[side];
                const auto first =
                    std::min_element(around.begin(), around.end(),
                                     [&](auto a, auto b) { return names[a] < names[b]; });
                serves = (first - around.begin()) % 2 == static_cast<int>(choice >> side & 1U);
            }
            has_order = serves;
        } while (!has_order && std::next_permutation(names.begin(), names.end()));
        if (has_order) {
            ++cut;
            expect_cut(soup, {1 + 6.0 / 3, 24, 18});
        } else {
            test::expect_contains(
                test::error_of([&] { static_cast<void>(cut_cells(soup, "test")); }),
                {"test: ", " quadrilateral faces lie against triangles", "write tetrahedra"});
        }
    }
    EXPECT_GT(cut, 0);
    EXPECT_LT(cut, 64);
}

TEST(CutCells, WithCoincidingCornersAreCutAsWhatTheyAre) {
    const std::vector<Eigen::Vector3d> prism = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                                {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    expect_cut_in_every_order(prism, {{CellKind::Hexahedron, {0, 1, 2, 2, 3, 4, 5, 5}}},
                              {0.5, 8, 3});
    const std::vector<Eigen::Vector3d> pyramid = {
        {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}};
    expect_cut_in_every_order(pyramid, {{CellKind::Hexahedron, {0, 1, 2, 3, 4, 4, 4, 4}}},
                              {1.0 / 3, 6, 2});
    expect_cut_in_every_order({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                              {{CellKind::Prism, {0, 1, 2, 3, 3, 3}}}, {1.0 / 6, 4, 1});
}

TEST(CutCells, AreTurnedOverAsAWhole) {
    const Cell mirrored = {CellKind::Hexahedron, {4, 5, 6, 7, 0, 1, 2, 3}};
    const CellSoup soup = renamed(kCube, {mirrored}, in_order(8));
    expect_cut(soup, {1, 12, 6});
    EXPECT_EQ(cut_cells(soup, "test").turned_cells, 1);
}

TEST(CutCells, KeepTetrahedraAndHandLabelsDown) {
    CellSoup soup;
    soup.points = with(kCube, {{0.5, 0.5, 2}});
    soup.has_labels = true;
    soup.add(CellKind::Tetrahedron, Corners{4, 5, 7, 8}, 3);
    soup.add(CellKind::Hexahedron, kHexahedron.corners, 9);
    const CutCells cut = cut_cells(soup, "test");
    EXPECT_EQ(cut.tets.front(), (std::array<std::uint32_t, 4>{4, 5, 7, 8}));
    EXPECT_EQ(cut.labels, (std::vector<std::int64_t>{3, 9, 9, 9, 9, 9, 9}));
    EXPECT_EQ(cut.cut, "1 hexahedron into 6 tetrahedra");
}

TEST(CutCells, RefuseWithTheirNumberWhatCannotBeCut) {
    const auto message = [](const CellSoup& soup) {
        return test::error_of([&] { static_cast<void>(cut_cells(soup, "a.msh")); });
    };
    CellSoup polyhedra = renamed(kCube, {kHexahedron}, in_order(8));
    polyhedra.add(CellKind::Polyhedron, {});
    polyhedra.add(CellKind::Polyhedron, {});
    polyhedra.add(CellKind::PentagonalPrism, {});
    test::expect_contains(message(polyhedra),
                          {"a.msh: 1 pentagonal prism, 2 polyhedra; expected tetrahedra"});
    // The second one is turned by half a turn between its ends; the third is flat.
    const CellSoup warped = renamed(kCube,
                                    {kHexahedron,
                                     {CellKind::Hexahedron, {0, 1, 2, 3, 6, 7, 4, 5}},
                                     {CellKind::Pyramid, {0, 1, 2, 3, 0}}},
                                    in_order(8));
    test::expect_contains(message(warped), {"a.msh: 1 pyramid, 1 hexahedron of 3 cells",
                                            "warped or flat", "first: cell 1, from 0"});
}

}  // namespace
}  // namespace pent::mesher
