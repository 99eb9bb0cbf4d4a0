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

TEST(MatchFacets, EqualsBruteForceOnRandomCells) {
    std::mt19937 random(7);
    for (int trial = 0; trial < 50; ++trial) {
        Simplices<5> cells(5, 30);
        for (Eigen::Index cell = 0; cell < cells.cols(); ++cell) {
            std::set<std::uint32_t> corners;
            while (corners.size() < 5) {
                corners.insert(static_cast<std::uint32_t>(random() % 7));
            }
            std::copy(corners.begin(), corners.end(), cells.col(cell).data());
            std::shuffle(cells.col(cell).data(), cells.col(cell).data() + 5, random);
        }
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
