#include "moving_shapes.h"

#include <pent/facets.h>
#include <pent/mesher/space_time.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace pent::mesher {
namespace {

using test::moving;

// A box with regions, a labeled side and fields that are linear in space and time.
MovingMesh labeled_box() {
    const auto grow = [](const Eigen::Vector3d& x, double t) -> Eigen::Vector3d {
        return (1 + t) * x;
    };
    MovingMesh mesh = moving(test::centered_box(2, 1), {0, 1, 2}, grow);
    for (Eigen::Index cell = 0; cell < mesh.base.cell_count(); ++cell) {
        mesh.base.regions.push_back(static_cast<std::uint16_t>(cell % 5));
    }
    const FacetMatch<3> match = match_facets<3>(mesh.base.cells, mesh.base.vertex_count());
    mesh.triangles = match.boundary;
    for (const auto& triangle : match.boundary.colwise()) {
        const double z = (mesh.base.positions(2, triangle[0]) + mesh.base.positions(2, triangle[1])
                          + mesh.base.positions(2, triangle[2]))
                         / 3;
        mesh.triangle_labels.push_back(z == 0.5 ? 7 : 8);
    }
    mesh.vertex_fields = {{"place", {}}, {"age", {}}};
    mesh.cell_fields = {{"fiber", {}}, {"strength", {}}};
    for (std::size_t frame = 0; frame < 3; ++frame) {
        mesh.vertex_fields[0].values.emplace_back(mesh.positions[frame]);
        mesh.vertex_fields[1].values.emplace_back(
            Eigen::RowVectorXd::Constant(mesh.base.vertex_count(), static_cast<double>(frame)));
        mesh.cell_fields[0].values.emplace_back(
            Eigen::Vector3d(1, 2, static_cast<double>(frame)).replicate(1, mesh.base.cell_count()));
        mesh.cell_fields[1].values.emplace_back(Eigen::RowVectorXd::LinSpaced(
            mesh.base.cell_count(), 0, static_cast<double>(mesh.base.cell_count() - 1)));
    }
    return mesh;
}

TEST(SpaceTime, CarriesRegionsAndFields) {
    const MovingMesh mesh = labeled_box();
    const SpaceTimeBody body = make_space_time(mesh, {.time_scale = 5, .refine_time = 2});
    ASSERT_EQ(body.extras.vertex_fields.size(), 2U);
    EXPECT_EQ(body.extras.vertex_fields[0].name, "place");
    for (Eigen::Index v = 0; v < body.mesh.vertex_count(); ++v) {
        EXPECT_EQ(body.extras.vertex_fields[0].values.col(v).head<3>(),
                  body.mesh.positions.col(v).head<3>());
        EXPECT_EQ(body.extras.vertex_fields[0].values(3, v), 0);
        EXPECT_EQ(body.extras.vertex_fields[1].values(0, v), body.mesh.positions(3, v) / 5);
    }
    ASSERT_EQ(body.extras.cell_fields.size(), 1U);
    for (Eigen::Index cell = 0; cell < body.mesh.cell_count(); ++cell) {
        // Which tetrahedron a pentachoron stands on, by its own columns.
        std::set<std::uint32_t> columns;
        double w = 0;
        std::set<double> heights;
        for (int k = 0; k < 5; ++k) {
            columns.insert(body.mesh.columns[body.mesh.cells(k, cell)]);
            heights.insert(body.mesh.positions(3, body.mesh.cells(k, cell)));
        }
        w = (*heights.begin() + *heights.rbegin()) / 2;
        const auto tet = static_cast<Eigen::Index>(body.extras.cell_fields[0].values(0, cell));
        const auto& corners = mesh.base.cells.col(tet);
        EXPECT_EQ(columns, std::set<std::uint32_t>(corners.begin(), corners.end()));
        EXPECT_EQ(body.mesh.regions[cell], tet % 5);
        EXPECT_EQ(body.mesh.fibers.col(cell), Eigen::Vector4d(1, 2, w / 5, 0));
    }
}

TEST(SpaceTime, TakesFibersFromEitherEndInEveryFrame) {
    const MovingMesh mesh = labeled_box();
    MovingMesh turned = mesh;
    for (std::size_t frame = 0; frame < 3; ++frame) {
        for (Eigen::Index cell = 0; cell < mesh.base.cell_count(); ++cell) {
            if ((cell + cell / 3 * static_cast<Eigen::Index>(frame)) % 2 == 1) {
                turned.cell_fields[0].values[frame].col(cell) *= -1;
            }
        }
    }
    const SpaceTimeOptions options{.refine_time = 2};
    const Positions<4> fibers = make_space_time(mesh, options).mesh.fibers;
    const Positions<4> of_turned = make_space_time(turned, options).mesh.fibers;
    ASSERT_EQ(of_turned.cols(), fibers.cols());
    for (Eigen::Index cell = 0; cell < fibers.cols(); ++cell) {
        EXPECT_EQ(of_turned.col(cell) * (of_turned(0, cell) < 0 ? -1 : 1), fibers.col(cell));
    }
}

TEST(SpaceTime, LabelsEveryFacetOfItsBoundary) {
    const MovingMesh mesh = labeled_box();
    const SpaceTimeBody body = make_space_time(mesh, {.time_scale = 5});
    const auto& extras = body.extras;
    EXPECT_EQ(extras.boundary.cols(), body.proof.boundary_facets);
    std::map<std::uint16_t, int> counts;
    for (Eigen::Index f = 0; f < extras.boundary.cols(); ++f) {
        double low = 1e300;
        double high = -1e300;
        double z = 0;
        for (int k = 0; k < 4; ++k) {
            const auto x = body.mesh.positions.col(extras.boundary(k, f));
            low = std::min(low, x[3]);
            high = std::max(high, x[3]);
            z += x[2] / (1 + x[3] / 5) / 4;  // as it was before it grew
        }
        const std::uint16_t label = extras.labels[f];
        ++counts[label];
        const int expected = low < high ? 2 : low == 0 ? 1 : 3;
        EXPECT_EQ(label, expected);
        if (expected == 2) {
            EXPECT_EQ(extras.base_labels[f], std::abs(z - 0.5) < 1e-12 ? 7 : 8);
        } else {
            EXPECT_LT(extras.base_labels[f], 5);
        }
    }
    EXPECT_EQ(counts[1], mesh.base.cell_count());
    EXPECT_EQ(counts[2], mesh.triangles.cols() * 3 * 2);
    EXPECT_EQ(counts[3], mesh.base.cell_count());
}

TEST(SlabOf, PutsTheWholeTogetherAgain) {
    const SpaceTimeBody body =
        make_space_time(labeled_box(), {.refine_time = 2, .is_bisection_ready = true});
    double volume = 0;
    Eigen::Index cells = 0;
    MeshFile<4> before;
    for (std::size_t slab = 0; slab < 2; ++slab) {
        const MeshFile<4> file = slab_of(body, slab);
        validate(file.mesh, "slab");
        EXPECT_TRUE(prove<4>(file.mesh).holds());
        volume += total_volume(file.mesh);
        cells += file.mesh.cell_count();
        EXPECT_EQ(file.extras.bisection_tags.size(), file.mesh.regions.size());
        EXPECT_EQ(file.extras.vertex_fields[0].values.topRows(3), file.mesh.positions.topRows(3));
        const std::set<std::uint16_t> labels(file.extras.labels.begin(), file.extras.labels.end());
        EXPECT_EQ(labels, slab == 0 ? (std::set<std::uint16_t>{1, 2, 5})
                                    : (std::set<std::uint16_t>{2, 3, 4}));
        for (std::size_t f = 0; f < file.extras.labels.size(); ++f) {
            EXPECT_EQ(file.extras.base_labels[f] >= 7, file.extras.labels[f] == 2);
        }
        if (slab == 1) {
            // Its first layer is the last one of the slab before, vertex by vertex.
            for (Eigen::Index v = 0; v < file.mesh.vertex_count(); v += 3) {
                EXPECT_EQ(file.mesh.positions.col(v), before.mesh.positions.col(v + 2));
                EXPECT_EQ(file.mesh.layers[v], before.mesh.layers[v + 2]);
                EXPECT_EQ(file.mesh.columns[v], before.mesh.columns[v + 2]);
            }
        }
        before = file;
    }
    EXPECT_EQ(cells, body.mesh.cell_count());
    EXPECT_NEAR(volume, body.proof.volume, 1e-13 * volume);
}

}  // namespace
}  // namespace pent::mesher
