#include "moving_shapes.h"
#include "spacetime/time_layers.h"
#include "support/messages.h"

#include <pent/error.h>
#include <pent/facets.h>
#include <pent/mesher/extrude.h>
#include <pent/mesher/links.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/space_time.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

namespace pent::mesher {
namespace {

using test::moving;

std::vector<double> steps(int count, double end) {
    std::vector<double> times;
    for (int i = 0; i <= count; ++i) {
        times.push_back(end * i / count);
    }
    return times;
}

// Swells, and moves along a curve.
Eigen::Vector3d breathe(const Eigen::Vector3d& x, double t) {
    return (1 + 0.3 * std::sin(2 * t)) * x + Eigen::Vector3d(t, t * t, std::sin(t));
}

// Turns and twists as it swells.
Eigen::Vector3d twist(const Eigen::Vector3d& x, double t) {
    const Eigen::AngleAxisd turn(t * (0.5 + 0.4 * x.z()), Eigen::Vector3d::UnitZ());
    return (1 + 0.2 * std::sin(3 * t)) * (turn * x) + Eigen::Vector3d(0, 0, 0.1 * t * x.x());
}

TEST(SpaceTime, HasTheIntegralOfTheVolumeAsHypervolumeWhereTheSidesAreFlat) {
    // Scaled and moved, sides sweep flat facets: r is linear between frames, so that r^3 has an
    // exact integral by Simpson's rule.
    const SimplexMesh<3> base = ball(3);
    const MovingMesh mesh = moving(base, {0, 0.3, 0.7, 1.5}, breathe);
    const SpaceTimeBody body = make_space_time(mesh, {.time_scale = 2});
    double expected = 0;
    for (std::size_t i = 0; i + 1 < mesh.times.size(); ++i) {
        const double r0 = 1 + 0.3 * std::sin(2 * mesh.times[i]);
        const double r1 = 1 + 0.3 * std::sin(2 * mesh.times[i + 1]);
        const double middle = (r0 + r1) / 2;
        expected += 2 * (mesh.times[i + 1] - mesh.times[i]) * total_volume(base)
                    * (r0 * r0 * r0 + 4 * middle * middle * middle + r1 * r1 * r1) / 6;
    }
    EXPECT_TRUE(body.proof.holds());
    // Sums of 2160 pentachora, each to some 10 eps of the whole at worst.
    EXPECT_NEAR(body.proof.volume, expected, 1e-13 * expected);
    EXPECT_NEAR(body.integral, expected, 1e-13 * expected);
    EXPECT_EQ(body.mesh.cell_count(), base.cell_count() * 4 * 3);
}

TEST(SpaceTime, HasAConstantSectionForWhatOnlyMovesHoweverFarAndFast) {
    const SimplexMesh<3> base = test::centered_box(2, 2);
    const auto fly = [](const Eigen::Vector3d& x, double t) -> Eigen::Vector3d {
        return x + Eigen::Vector3d(1e3 * t, -50 * t * t, 0);
    };
    const SpaceTimeBody body = make_space_time(moving(base, steps(3, 1), fly));
    EXPECT_TRUE(body.proof.holds());
    EXPECT_NEAR(body.proof.volume, 8, 1e-10);  // coordinates to 1e3, rounded to 1e-13
}

TEST(SpaceTime, HasTheIntegralAsTheMeanOverAllOrdersOfTheVertices) {
    // Where triangles of the surface turn, the cut of the sides decides: of each triangle all six
    // orders come up equally often among those of all vertices.
    SimplexMesh<3> base;
    base.positions.resize(3, 5);
    base.positions << 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 1, 1;
    base.cells.resize(4, 2);
    base.cells << 0, 1, 1, 2, 2, 3, 3, 4;
    if (cell_volume<3>(base.positions, base.cells, 1) < 0) {
        std::swap(base.cells(2, 1), base.cells(3, 1));
    }
    std::mt19937 random(11);
    std::uniform_real_distribution<double> shift(-0.2, 0.2);
    const Positions<3> moved =
        base.positions + Positions<3>::NullaryExpr(3, 5, [&] { return shift(random); });
    std::array<std::uint32_t, 5> names{};
    std::iota(names.begin(), names.end(), 0U);
    double sum = 0;
    double integral = 0;
    double lowest = 1e300;
    double highest = 0;
    do {
        SimplexMesh<3> renamed = base;
        Positions<3> target = moved;
        for (std::uint32_t v = 0; v < 5; ++v) {
            renamed.positions.col(names[v]) = base.positions.col(v);
            target.col(names[v]) = moved.col(v);
        }
        for (std::uint32_t& corner : renamed.cells.reshaped()) {
            corner = names[corner];
        }
        MovingMesh mesh = moving(renamed, {0, 1}, [](const auto& x, double) { return x; });
        mesh.positions[1] = target;
        const SpaceTimeBody body = make_space_time(mesh, {.alternate = false});
        sum += body.proof.volume;
        integral = body.integral;
        lowest = std::min(lowest, body.proof.volume);
        highest = std::max(highest, body.proof.volume);
    } while (std::next_permutation(names.begin(), names.end()));
    EXPECT_NEAR(sum / 120, integral, 1e-15);
    EXPECT_GT(highest - lowest, 1e-3) << "the orders do differ";
}

TEST(SpaceTime, MeetsTheIntegralAtSecondOrderInTheSteps) {
    const auto difference = [](int count) {
        const SpaceTimeBody body =
            make_space_time(moving(test::centered_box(3, 1), steps(count, 0.8), twist));
        EXPECT_TRUE(body.proof.holds());
        return std::abs(body.proof.volume - body.integral);
    };
    // With alternating orders the first order cancels from layer to layer.
    EXPECT_GT(difference(8) / difference(16), 3.0);
    EXPECT_GT(difference(16) / difference(32), 3.0);
}

// The tetrahedra in which a body is cut at the w of one of its layers are those of the frame.
TEST(SpaceTime, IsTheMeshOfEachFrameInTheSliceAtItsTime) {
    const MovingMesh mesh = moving(ball(2), steps(4, 1), twist);
    const SpaceTimeBody body = make_space_time(mesh, {.time_scale = 3, .refine_time = 2});
    ASSERT_EQ(body.frame_layers, (std::vector<std::uint32_t>{0, 2, 4, 6, 8}));
    for (std::size_t frame = 0; frame < 5; ++frame) {
        const std::uint32_t layer = body.frame_layers[frame];
        // Facets with all vertices in the layer, by their columns.
        std::set<std::array<std::uint32_t, 4>> found;
        for (const auto& cell : body.mesh.cells.colwise()) {
            std::vector<std::uint32_t> in_layer;
            for (const std::uint32_t v : cell) {
                if (body.mesh.layers[v] == layer) {
                    EXPECT_EQ(body.mesh.positions(3, v), 3 * mesh.times[frame]);
                    EXPECT_EQ(body.mesh.positions.col(v).head<3>(),
                              mesh.positions[frame].col(body.mesh.columns[v]));
                    in_layer.push_back(body.mesh.columns[v]);
                }
            }
            if (in_layer.size() == 4) {
                std::sort(in_layer.begin(), in_layer.end());
                found.insert({in_layer[0], in_layer[1], in_layer[2], in_layer[3]});
            }
        }
        std::set<std::array<std::uint32_t, 4>> expected;
        for (const auto& tet : mesh.base.cells.colwise()) {
            std::array<std::uint32_t, 4> corners{tet[0], tet[1], tet[2], tet[3]};
            std::sort(corners.begin(), corners.end());
            expected.insert(corners);
        }
        EXPECT_EQ(found, expected) << frame;
    }
}

TEST(SpaceTime, IsAProvedBodyWithAManifoldBoundary) {
    const SpaceTimeBody body = make_space_time(moving(ball(2), steps(5, 1), twist));
    EXPECT_TRUE(body.proof.holds());
    EXPECT_EQ(check_links<4>(body.mesh).faulty, 0);
}

// By sampling: the smallest six-volume on the way, and where it is first not above 0.
double sampled_inversion(const Eigen::Matrix<double, 3, 4>& from,
                         const Eigen::Matrix<double, 3, 4>& to,
                         int samples,
                         double& smallest) {
    smallest = 1e300;
    for (int i = 0; i <= samples; ++i) {
        const double s = static_cast<double>(i) / samples;
        const Eigen::Matrix<double, 3, 4> x = (1 - s) * from + s * to;
        const double volume = (x.rightCols<3>().colwise() - x.col(0)).eval().determinant();
        smallest = std::min(smallest, volume);
        if (volume <= 0) {
            return s;
        }
    }
    return 2;
}

TEST(FirstInversion, IsWhereSamplesOfTheWayFindIt) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    int inverted = 0;
    int sound = 0;
    for (int trial = 0; trial < 400; ++trial) {
        Eigen::Matrix<double, 3, 4> from;
        Eigen::Matrix<double, 3, 4> to;
        const double reach = trial % 2 == 0 ? 0.5 : 1.5;
        for (int i = 0; i < 12; ++i) {
            from(i) = normal(random);
            to(i) = from(i) + reach * normal(random);
        }
        const VolumePolynomial volume = volume_on_the_way(from, to);
        double smallest = 0;
        constexpr int kSamples = 2000;
        const double sampled = sampled_inversion(from, to, kSamples, smallest);
        const std::optional<double> found = first_inversion(volume);
        if (sampled <= 1) {
            ASSERT_TRUE(found.has_value()) << trial;
            EXPECT_LE(*found, sampled + 1e-11);
            EXPECT_GE(*found, sampled - 1.0 / kSamples - 1e-11);
            ++inverted;
        } else if (smallest > 1e-3) {  // samples do not miss what is that far from 0
            EXPECT_FALSE(found.has_value()) << trial << ": at " << found.value_or(0);
            ++sound;
        }
    }
    EXPECT_GT(inverted, 50);
    EXPECT_GT(sound, 50);
}

// Every pentachoron of every order between two places of a mesh, by its determinant.
bool is_sound_by_brute_force(const MovingMesh& mesh) {
    const auto ranks = rank_vertices<3>(mesh.base, VertexOrder::Index);
    SimplexMesh<4> body =
        extrude<4>(mesh.base, order_cells<3>(mesh.base, direct_edges<3>(mesh.base, ranks)),
                   straight_layers<4>(Eigen::Vector4d::Unit(3), 1, Anchor::Start));
    for (Eigen::Index v = 0; v < body.vertex_count(); ++v) {
        body.positions.col(v).head<3>() = mesh.positions[v % 2].col(v / 2);
    }
    for (Eigen::Index cell = 0; cell < body.cell_count(); ++cell) {
        if (cell_volume<4>(body.positions, body.cells, cell) <= 0) {
            return false;
        }
    }
    return true;
}

template <typename Work>
std::string error_or_nothing(Work work) {
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(SpaceTime, TakesAStepExactlyIfEveryPentachoronIsPositive) {
    std::mt19937 random(5);
    int taken = 0;
    int refused = 0;
    int mended = 0;
    for (int trial = 0; trial < 120; ++trial) {
        std::uniform_real_distribution<double> shift(-0.05 - 0.005 * trial, 0.05 + 0.005 * trial);
        MovingMesh mesh =
            moving(test::centered_box(1, 1), {0, 1}, [](const auto& x, double) { return x; });
        for (double& value : mesh.positions[1].reshaped()) {
            value += shift(random);
        }
        if (trial % 2 == 1) {  // and turned, which halves can mend
            const Eigen::AngleAxisd turn(0.02 * trial, Eigen::Vector3d(1, 2, 3).normalized());
            mesh.positions[1] = turn.toRotationMatrix() * mesh.positions[1];
        }
        std::string error = error_or_nothing([&] { static_cast<void>(make_space_time(mesh)); });
        EXPECT_EQ(error.empty(), is_sound_by_brute_force(mesh)) << error;
        (error.empty() ? taken : refused) += 1;
        if (error.empty()) {
            continue;
        }
        // Halves help exactly if every tetrahedron stays positive on its way.
        bool stays = true;
        for (const auto& cell : mesh.base.cells.colwise()) {
            Eigen::Matrix<double, 3, 4> from;
            Eigen::Matrix<double, 3, 4> to;
            for (int i = 0; i < 4; ++i) {
                from.col(i) = mesh.positions[0].col(cell[i]);
                to.col(i) = mesh.positions[1].col(cell[i]);
            }
            double smallest = 0;
            stays = stays && sampled_inversion(from, to, 3000, smallest) > 1;
        }
        error = error_or_nothing([&] {
            const SpaceTimeBody body = make_space_time(mesh, {.refine_time = 0});
            EXPECT_TRUE(body.proof.holds());
            EXPECT_GT(body.frame_layers[1], 1U);
            ++mended;
        });
        EXPECT_EQ(error.empty(), stays) << error;
    }
    EXPECT_GT(taken, 20);
    EXPECT_GT(refused, 20);
    EXPECT_GT(mended, 5);
}

TEST(SpaceTime, CutsATurnThatIsTooFarForOneLayer) {
    const auto turn = [](const Eigen::Vector3d& x, double t) -> Eigen::Vector3d {
        return Eigen::AngleAxisd(t * 0.6 * std::numbers::pi, Eigen::Vector3d::UnitZ()) * x;
    };
    const MovingMesh mesh = moving(test::centered_box(2, 2), {0, 1}, turn);
    test::expect_contains(
        test::error_of([&] { static_cast<void>(make_space_time(mesh)); }),
        {"frame_0 to frame_1: cell ", "changes its shape too much from t = 0 to 1 s for one layer",
         "--refine-time auto"});
    const SpaceTimeBody body = make_space_time(mesh, {.refine_time = 0});
    EXPECT_TRUE(body.proof.holds());
    EXPECT_GT(body.frame_layers.back(), 1U);
    // Halfway through a turn by 180 degrees on straight ways all is one point wide.
    const auto half_turn = [](const Eigen::Vector3d& x, double t) -> Eigen::Vector3d {
        return Eigen::AngleAxisd(t * std::numbers::pi, Eigen::Vector3d::UnitZ()) * x;
    };
    test::expect_contains(
        test::error_of([&] {
            static_cast<void>(make_space_time(moving(test::centered_box(2, 2), {0, 1}, half_turn),
                                              {.refine_time = 0}));
        }),
        {"frame_0 to frame_1: cell ", " turns inside out at t = 0.5 s", "save more frames"});
}

TEST(SpaceTime, SaysWhichCellIsInvertedInWhichFrame) {
    MovingMesh mesh =
        moving(test::centered_box(1, 1), steps(3, 0.3), [](const auto& x, double) { return x; });
    mesh.positions[2].col(7) = -mesh.positions[2].col(7) * 3;
    test::expect_contains(
        test::error_of([&] { static_cast<void>(make_space_time(mesh, {.refine_time = 0})); }),
        {"frame_2: cell ", " is inverted or flat at t = 0.2 s", "in every frame"});
    MovingMesh flat =
        moving(test::centered_box(1, 1), steps(3, 0.3), [](const auto& x, double) { return x; });
    flat.positions[2].row(2).setZero();
    test::expect_contains(
        test::error_of([&] { static_cast<void>(make_space_time(flat, {.refine_time = 0})); }),
        {"frame_2: cell 0 is inverted or flat at t = 0.2 s"});
}

TEST(SpaceTime, RefusesScalesAndStepsOutOfRange) {
    const MovingMesh mesh =
        moving(test::centered_box(1, 1), {0, 1}, [](const auto& x, double) { return x; });
    for (const double scale : {0.0, -1.0, std::nan("")}) {
        test::expect_contains(test::error_of([&] {
                                  static_cast<void>(make_space_time(mesh, {.time_scale = scale}));
                              }),
                              {"a time scale of"});
    }
    test::expect_contains(
        test::error_of([&] { static_cast<void>(make_space_time(mesh, {.refine_time = -1})); }),
        {"-1 layers"});
}

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
