#include "support/kuhn_box.h"

#include <pent/facets.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace pent {
namespace {

// Facets by their sorted corners, with the number of cells that have them: brute force.
template <int Dim>
std::map<std::vector<std::uint32_t>, int> count_facets(const Simplices<Dim + 1>& cells) {
    std::map<std::vector<std::uint32_t>, int> count;
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        for (int k = 0; k <= Dim; ++k) {
            std::vector<std::uint32_t> facet;
            for (int i = 0; i <= Dim; ++i) {
                if (i != k) {
                    facet.push_back(cells(i, cell));
                }
            }
            std::sort(facet.begin(), facet.end());
            ++count[facet];
        }
    }
    return count;
}

template <int Dim>
void expect_outward(const SimplexMesh<Dim>& mesh) {
    const FacetMatch<Dim> match = match_facets<Dim>(mesh.cells, mesh.vertex_count());
    for (Eigen::Index i = 0; i < match.boundary.cols(); ++i) {
        Eigen::Matrix<double, Dim, 1> inside = Eigen::Matrix<double, Dim, 1>::Zero();
        for (int k = 0; k <= Dim; ++k) {
            inside += mesh.positions.col(mesh.cells(k, match.boundary_cells[i])) / (Dim + 1);
        }
        Eigen::Matrix<double, Dim, Dim> frame;
        frame.col(0) = mesh.positions.col(match.boundary(0, i)) - inside;  // out of the cell
        for (int k = 1; k < Dim; ++k) {
            frame.col(k) =
                mesh.positions.col(match.boundary(k, i)) - mesh.positions.col(match.boundary(0, i));
        }
        EXPECT_GT(frame.determinant(), 0) << "facet " << i;
    }
}

TEST(MatchFacets, FindsTheBoundaryOfABoxOfTesseracts) {
    const SimplexMesh<4> mesh = test::kuhn_box<4>({3, 2, 1, 2}, {3, 2, 1, 2});
    const FacetMatch<4> match = match_facets<4>(mesh.cells, mesh.vertex_count());
    EXPECT_TRUE(match.is_conforming());
    EXPECT_EQ(match.first_fault, -1);
    // Each cube on the surface of the box is cut into 6 tetrahedra.
    const int cubes = 2 * (3 * 2 * 1 + 3 * 2 * 2 + 3 * 1 * 2 + 2 * 1 * 2);
    EXPECT_EQ(match.boundary.cols(), 6 * cubes);
    EXPECT_EQ(2 * match.interior + match.boundary.cols(), 5 * mesh.cell_count());
}

// Cells of few vertices, so that many share a facet.
template <int Dim>
Simplices<Dim + 1> random_cells(std::mt19937& random, std::uint32_t vertices) {
    Simplices<Dim + 1> cells(Dim + 1, 30);
    for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
        std::set<std::uint32_t> corners;
        while (corners.size() < Dim + 1) {
            corners.insert(static_cast<std::uint32_t>(random() % vertices));
        }
        std::copy(corners.begin(), corners.end(), cells.col(cell).data());
        std::shuffle(cells.col(cell).data(), cells.col(cell).data() + Dim + 1, random);
    }
    return cells;
}

// Of the cells that touch some vertices, and of facets of which the lowest corner is one of these.
template <int Dim>
void expect_counted_as_by_brute_force(std::mt19937& random) {
    constexpr std::uint32_t kVertices = Dim + 4;
    const Simplices<Dim + 1> cells = random_cells<Dim>(random, kVertices);
    const FacetMatch<Dim> all = match_facets<Dim>(cells, kVertices);
    std::vector<std::uint32_t> owner;
    for (std::uint32_t vertex = 0; vertex < kVertices; ++vertex) {
        owner.push_back(static_cast<std::uint32_t>(random() % 3));
    }
    FacetMatch<Dim> sum;
    std::size_t boundary = 0;
    for (const std::uint32_t part : {0U, 1U, 2U}) {
        std::vector<Eigen::Index> numbers;
        for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
            const auto corners = cells.col(cell);
            if (std::any_of(corners.begin(), corners.end(),
                            [&](std::uint32_t vertex) { return owner[vertex] == part; })) {
                numbers.push_back(cell);
            }
        }
        const FacetMatch<Dim> own =
            match_facets<Dim>(cells(Eigen::all, numbers), kVertices,
                              [&](std::uint32_t vertex) { return owner[vertex] == part; });
        std::int64_t single = 0;
        std::int64_t pairs = 0;
        std::int64_t more = 0;
        for (const auto& [facet, count] : count_facets<Dim>(cells)) {
            if (owner[facet[0]] == part) {
                single += count == 1 ? 1 : 0;
                pairs += count == 2 ? 1 : 0;
                more += count > 2 ? 1 : 0;
            }
        }
        EXPECT_EQ(own.boundary.cols(), single);
        EXPECT_EQ(own.interior + own.one_sided, pairs);
        EXPECT_EQ(own.overfull, more);
        EXPECT_EQ(own.is_conforming(), own.first_fault < 0);
        sum.interior += own.interior;
        sum.one_sided += own.one_sided;
        boundary += own.boundary_cells.size();
        if (own.first_fault >= 0) {
            const std::int64_t first = numbers[static_cast<std::size_t>(own.first_fault)];
            sum.first_fault = sum.first_fault < 0 ? first : std::min(first, sum.first_fault);
        }
    }
    EXPECT_EQ(sum.interior, all.interior);
    EXPECT_EQ(sum.one_sided, all.one_sided);
    EXPECT_EQ(sum.first_fault, all.first_fault);
    EXPECT_EQ(boundary, all.boundary_cells.size());
}

TEST(MatchFacets, CountsTheFacetsOfSomeLowestCornersAsBruteForceDoes) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 50; ++trial) {
        expect_counted_as_by_brute_force<3>(random);
        expect_counted_as_by_brute_force<4>(random);
    }
}

TEST(MatchFacets, EqualsBruteForceOnRandomCells) {
    std::mt19937 random(7);
    for (int trial = 0; trial < 50; ++trial) {
        const Simplices<5> cells = random_cells<4>(random, 7);
        const FacetMatch<4> match = match_facets<4>(cells, 7);
        std::int64_t single = 0;
        std::int64_t pairs = 0;
        std::int64_t more = 0;
        for (const auto& [facet, count] : count_facets<4>(cells)) {
            single += count == 1 ? 1 : 0;
            pairs += count == 2 ? 1 : 0;
            more += count > 2 ? 1 : 0;
        }
        EXPECT_EQ(match.boundary.cols(), single);
        EXPECT_EQ(match.interior + match.one_sided, pairs);
        EXPECT_EQ(match.overfull, more);
        EXPECT_EQ(match.is_conforming(), match.first_fault < 0);
    }
}

TEST(MatchFacets, SeesWhenNeighborsLieOnTheSameSide) {
    SimplexMesh<3> mesh = test::kuhn_box<3>({1, 1, 1}, {1, 1, 1});
    std::swap(mesh.cells(0, 2), mesh.cells(1, 2));
    const FacetMatch<3> match = match_facets<3>(mesh.cells, mesh.vertex_count());
    EXPECT_FALSE(match.is_conforming());
    EXPECT_EQ(match.one_sided, 2);  // a tetrahedron of a Kuhn cube has two neighbors within it
    EXPECT_EQ(match.overfull, 0);
    EXPECT_GE(match.first_fault, 0);
}

TEST(MatchFacets, SeesACellThatIsThereTwice) {
    SimplexMesh<4> mesh = test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1});
    mesh.cells.conservativeResize(5, mesh.cell_count() + 1);
    mesh.cells.col(mesh.cell_count() - 1) = mesh.cells.col(0);
    EXPECT_GT((match_facets<4>(mesh.cells, mesh.vertex_count()).overfull), 0);
}

TEST(MatchFacets, GivesBoundaryFacetsOutwardInEveryDimension) {
    expect_outward<2>(test::kuhn_box<2>({2, 2}, {1, 1}));
    expect_outward<3>(test::kuhn_box<3>({2, 2, 2}, {1, 1, 1}));
    expect_outward<4>(test::kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1}));
}

TEST(MatchFacets, BoundaryIsOrderedByCell) {
    const SimplexMesh<4> mesh = test::kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1});
    const FacetMatch<4> match = match_facets<4>(mesh.cells, mesh.vertex_count());
    EXPECT_TRUE(std::is_sorted(match.boundary_cells.begin(), match.boundary_cells.end()));
}

TEST(MatchFacets, OfNoCellsIsEmpty) {
    const FacetMatch<4> match = match_facets<4>(Simplices<5>(5, 0), 0);
    EXPECT_EQ(match.boundary.cols(), 0);
    EXPECT_TRUE(match.is_conforming());
}

}  // namespace
}  // namespace pent
