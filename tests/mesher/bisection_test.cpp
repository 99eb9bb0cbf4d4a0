#include "spacetime/bisection.h"

#include "moving_shapes.h"

#include <pent/facets.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/space_time.h>

#include <Eigen/QR>
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

// Everything at once: the ball is cut for bisection, grows, and is written as slabs. Where a piece
// came from shows in where it is.
TEST(BarycentricCut, HandsDownRegionsLabelsAndQuantities) {
    const SimplexMesh<3> base = ball(1);
    const auto grow = [](const Eigen::Vector3d& x, double t) -> Eigen::Vector3d {
        return (1 + t) * x;
    };
    MovingMesh moving = test::moving(base, {0, 1, 2}, grow);
    for (Eigen::Index cell = 0; cell < base.cell_count(); ++cell) {
        moving.base.regions.push_back(static_cast<std::uint16_t>(cell % 5));
    }
    moving.triangles = match_facets<3>(base.cells, base.vertex_count()).boundary;
    for (Eigen::Index t = 0; t < moving.triangles.cols(); ++t) {
        moving.triangle_labels.push_back(static_cast<std::uint16_t>(10 + t));
    }
    moving.vertex_fields = {{"place", {}}};
    moving.cell_fields = {{"fiber", {}}, {"number", {}}};
    for (std::size_t frame = 0; frame < 3; ++frame) {
        moving.vertex_fields[0].values.emplace_back(moving.positions[frame]);
        Eigen::MatrixXd fibers(3, base.cell_count());
        for (Eigen::Index cell = 0; cell < base.cell_count(); ++cell) {
            fibers.col(cell) << static_cast<double>(cell), 1, 2;
        }
        moving.cell_fields[0].values.push_back(fibers);
        moving.cell_fields[1].values.emplace_back(fibers.row(0));
    }
    const SpaceTimeBody body =
        make_space_time(moving, {.refine_time = 2, .is_bisection_ready = true});
    ASSERT_EQ(body.mesh.cell_count(), 20 * 24 * 4 * 4);
    const auto at_start = [&](std::uint32_t v) -> Eigen::Vector3d {
        return body.mesh.positions.col(v).head<3>() / (1 + body.mesh.positions(3, v));
    };
    const auto weights_in = [&](const auto& corners, const Eigen::Vector3d& p) {
        Eigen::MatrixXd places(4, corners.size());
        for (Eigen::Index i = 0; i < corners.size(); ++i) {
            places.col(i) << base.positions.col(corners[i]), 1;
        }
        const Eigen::Vector4d one(p[0], p[1], p[2], 1);
        const Eigen::VectorXd weights = places.colPivHouseholderQr().solve(one);
        EXPECT_LT((places * weights - one).norm(), 1e-14);
        return weights;
    };
    for (Eigen::Index v = 0; v < body.mesh.vertex_count(); ++v) {
        EXPECT_LT((body.extras.vertex_fields[0].values.col(v).head<3>()
                   - body.mesh.positions.col(v).head<3>())
                      .norm(),
                  1e-15);
    }
    for (Eigen::Index cell = 0; cell < body.mesh.cell_count(); ++cell) {
        const auto tet = static_cast<Eigen::Index>(body.extras.cell_fields[0].values(0, cell));
        EXPECT_EQ(body.mesh.fibers.col(cell), Eigen::Vector4d(static_cast<double>(tet), 1, 2, 0));
        EXPECT_EQ(body.mesh.regions[cell], tet % 5);
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const std::uint32_t corner : body.mesh.cells.col(cell)) {
            middle += at_start(corner) / 5;
        }
        EXPECT_GT(weights_in(base.cells.col(tet), middle).minCoeff(), 0.01);
    }
    std::map<int, int> sides;
    for (Eigen::Index f = 0; f < body.extras.boundary.cols(); ++f) {
        if (body.extras.labels[f] == static_cast<std::uint16_t>(BoundaryLabel::Lateral)) {
            const int label = body.extras.base_labels[f];
            ASSERT_GE(label, 10);
            ++sides[label];
            Eigen::Vector3d middle = Eigen::Vector3d::Zero();
            for (const std::uint32_t corner : body.extras.boundary.col(f)) {
                middle += at_start(corner) / 4;
            }
            EXPECT_GT(weights_in(moving.triangles.col(label - 10), middle).minCoeff(), 0.01);
        }
    }
    EXPECT_EQ(sides.size(), 20U);
    for (const auto& [label, count] : sides) {
        EXPECT_EQ(count, 6 * 3 * 4) << label;
    }
    for (std::size_t slab = 0; slab < 2; ++slab) {
        std::vector<std::uint8_t> tags;
        for (Eigen::Index cell = 0; cell < body.mesh.cell_count(); ++cell) {
            std::uint32_t layer = 4;
            for (const std::uint32_t corner : body.mesh.cells.col(cell)) {
                layer = std::min(layer, body.mesh.layers[corner]);
            }
            if (layer / 2 == slab) {
                tags.push_back(body.extras.bisection_tags[cell]);
            }
        }
        EXPECT_EQ(slab_of(body, slab).extras.bisection_tags, tags);
    }
}

}  // namespace
}  // namespace pent::mesher
