#include "spacetime/bisection.h"

#include "moving_shapes.h"

#include <pent/facets.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/space_time.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace pent::mesher {
namespace {

struct Tagged {
    std::array<std::uint32_t, 5> corners;
    int type = 0;
};

// Bisects cells by the rule of the tags alone: new vertices get a name by their edge.
class Bisector {
public:
    explicit Bisector(std::uint32_t vertices) : next_(vertices) {}

    std::array<Tagged, 2> bisect(const Tagged& cell) {
        const auto& x = cell.corners;
        const std::uint32_t middle = middle_of(x[0], x[4]);
        Tagged first{{x[0], middle, x[1], x[2], x[3]}, (cell.type + 1) % 4};
        Tagged second{{x[4], middle, 0, 0, 0}, (cell.type + 1) % 4};
        int at = 2;
        for (int i = 1; i <= cell.type; ++i) {
            second.corners[at++] = x[i];
        }
        for (int i = 3; i > cell.type; --i) {
            second.corners[at++] = x[i];
        }
        return {first, second};
    }

    [[nodiscard]] std::uint32_t vertices() const { return next_; }

private:
    std::uint32_t middle_of(std::uint32_t a, std::uint32_t b) {
        const auto [found, is_new] = middles_.try_emplace(std::minmax(a, b), next_);
        next_ += is_new ? 1 : 0;
        return found->second;
    }

    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
    std::uint32_t next_;
};

// Facets of one cell, and those of more than two: no orientation, as tags know of none.
std::pair<int, int> open_and_overfull(const std::vector<Tagged>& cells) {
    std::map<std::array<std::uint32_t, 4>, int> facets;
    for (const Tagged& cell : cells) {
        for (int k = 0; k < 5; ++k) {
            std::array<std::uint32_t, 4> facet{};
            int at = 0;
            for (int i = 0; i < 5; ++i) {
                if (i != k) {
                    facet[at++] = cell.corners[i];
                }
            }
            std::sort(facet.begin(), facet.end());
            ++facets[facet];
        }
    }
    std::pair<int, int> counts{0, 0};
    for (const auto& [facet, count] : facets) {
        counts.first += count == 1 ? 1 : 0;
        counts.second += count > 2 ? 1 : 0;
    }
    return counts;
}

std::vector<Tagged> tagged_cells(const SpaceTimeBody& body) {
    std::vector<Tagged> cells;
    for (Eigen::Index cell = 0; cell < body.mesh.cell_count(); ++cell) {
        Tagged tagged;
        std::copy_n(body.mesh.cells.col(cell).data(), 5, tagged.corners.begin());
        const std::uint8_t tag = body.extras.bisection_tags[static_cast<std::size_t>(cell)];
        EXPECT_LT(tag, 2) << "type 0, with the last two corners exchanged or not";
        if (tag % 2 == 1) {
            std::swap(tagged.corners[3], tagged.corners[4]);
        }
        cells.push_back(tagged);
    }
    return cells;
}

// A boundary facet of a cell of type 0 is bisected in so many of the first rounds: all cells of a
// conforming refinement have matching facets, so open ones are those of the boundary alone. They
// double in each round if their edge is on the boundary.
void expect_conforming_refinements(const SpaceTimeBody& body) {
    std::vector<Tagged> cells = tagged_cells(body);
    Bisector bisector(static_cast<std::uint32_t>(body.mesh.vertex_count()));
    const int boundary = open_and_overfull(cells).first;
    EXPECT_EQ(boundary, body.extras.boundary.cols());
    // After four rounds every edge of a cell has been cut once: a facet is 8 of its kind.
    for (int round = 1; round <= 4; ++round) {
        std::vector<Tagged> finer;
        for (const Tagged& cell : cells) {
            for (const Tagged& half : bisector.bisect(cell)) {
                finer.push_back(half);
            }
        }
        cells = std::move(finer);
        EXPECT_EQ(open_and_overfull(cells).second, 0) << round;
    }
    EXPECT_EQ(open_and_overfull(cells).first, 8 * boundary)
        << "open facets within the body: neighbors were cut at different edges";
}

SpaceTimeBody ready(const SimplexMesh<3>& base, bool alternate) {
    SpaceTimeOptions options;
    options.is_bisection_ready = true;
    options.alternate = alternate;
    const auto still = [](const Eigen::Vector3d& x, double) { return x; };
    return make_space_time(test::moving(base, {0, 1, 2, 3}, still), options);
}

TEST(Bisection, KeepsCubesOfPathsConformingInTheirOwnOrder) {
    for (const bool alternate : {false, true}) {
        const SpaceTimeBody body = ready(test::centered_box(2, 2), alternate);
        EXPECT_EQ(body.way_of_bisection, "in the order of its vertices");
        EXPECT_EQ(body.mesh.cell_count(), 48 * 4 * 3);
        expect_conforming_refinements(body);
    }
}

TEST(Bisection, ColorsVerticesThatStandInNoGoodOrder) {
    SimplexMesh<3> shuffled = test::centered_box(2, 2);
    std::vector<std::uint32_t> names(static_cast<std::size_t>(shuffled.vertex_count()));
    std::iota(names.begin(), names.end(), 0U);
    std::shuffle(names.begin(), names.end(), std::mt19937(2));
    const Positions<3> positions = shuffled.positions;
    for (std::size_t v = 0; v < names.size(); ++v) {
        shuffled.positions.col(names[v]) = positions.col(static_cast<Eigen::Index>(v));
    }
    for (std::uint32_t& corner : shuffled.cells.reshaped()) {
        corner = names[corner];
    }
    const SpaceTimeBody body = ready(shuffled, true);
    EXPECT_EQ(body.way_of_bisection, "by four colors of its vertices");
    expect_conforming_refinements(body);
}

TEST(Bisection, KeepsAnyMeshConformingAfterItsBarycentricCut) {
    for (const bool alternate : {false, true}) {
        const SpaceTimeBody body = ready(ball(1), alternate);
        EXPECT_EQ(body.way_of_bisection, "after a barycentric cut, 24 tetrahedra of each");
        EXPECT_EQ(body.mesh.cell_count(), 20 * 24 * 4 * 3);
        EXPECT_TRUE(body.proof.holds());
        expect_conforming_refinements(body);
    }
}

TEST(BisectionFaults, AreFoundWhereRefinementsWouldNotConform) {
    // The same body in the order of a ball's vertices is not ready: bisection leaves hanging ones.
    SpaceTimeOptions options;
    const auto still = [](const Eigen::Vector3d& x, double) { return x; };
    const SpaceTimeBody body = make_space_time(test::moving(ball(1), {0, 1}, still), options);
    EXPECT_GT(bisection_faults(body.mesh.cells), 0);
}

TEST(ColorVertices, GivesEveryTetrahedronAllFourOrNothing) {
    const SimplexMesh<3> box = test::centered_box(3, 1);
    const auto colors = color_vertices(box);
    ASSERT_TRUE(colors.has_value());
    for (const auto& cell : box.cells.colwise()) {
        int seen = 0;
        for (const std::uint32_t corner : cell) {
            seen |= 1 << (*colors)[corner];
        }
        EXPECT_EQ(seen, 15);
    }
    // Around an inner edge of an icosahedron's cones lie five tetrahedra: an odd circle.
    EXPECT_FALSE(color_vertices(ball(1)).has_value());
}

TEST(BarycentricCut, FillsTheMeshAndMovesWithIt) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-0.1, 0.1);
    MovingMesh moving = test::moving(
        test::centered_box(2, 2), {0, 1}, [&](const Eigen::Vector3d& x, double) -> Eigen::Vector3d {
            return x + Eigen::Vector3d(shift(random), shift(random), shift(random));
        });
    moving.base.regions.assign(48, 3);
    moving.vertex_fields.push_back({"height", {}});
    for (const Positions<3>& positions : moving.positions) {
        moving.vertex_fields[0].values.emplace_back(positions.row(2));
    }
    const MovingMesh cut = barycentric_cut(moving);
    for (std::size_t frame = 0; frame < 2; ++frame) {
        SimplexMesh<3> before{moving.positions[frame], moving.base.cells, {}, {}, {}, {}, {}};
        SimplexMesh<3> after{cut.positions[frame], cut.base.cells, {}, {}, {}, {}, {}};
        EXPECT_EQ(after.cell_count(), 24 * before.cell_count());
        validate(after, "barycentric cut");
        EXPECT_TRUE(prove(after, total_volume(before)).holds());
        // A linear function has its means at barycenters.
        const Eigen::MatrixXd heights = cut.positions[frame].row(2);
        EXPECT_LT((cut.vertex_fields[0].values[frame] - heights).cwiseAbs().maxCoeff(), 1e-15);
    }
    EXPECT_EQ(cut.base.regions, std::vector<std::uint16_t>(48 * 24, 3));
}

}  // namespace
}  // namespace pent::mesher
