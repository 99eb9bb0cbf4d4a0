#include "spacetime/time_layers.h"

#include "moving_shapes.h"
#include "support/messages.h"

#include <pent/error.h>
#include <pent/mesher/space_time.h>
#include <pent/mesher/straight_layers.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <random>
#include <string>

namespace pent::mesher {
namespace {

using test::moving;

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
        const double spread = trial % 2 == 0 ? 0.5 : 1.5;
        for (int i = 0; i < 12; ++i) {
            from(i) = normal(random);
            to(i) = from(i) + spread * normal(random);
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
    MovingMesh mesh = moving(test::centered_box(1, 1), {0, 0.1, 0.2, 0.3},
                             [](const auto& x, double) { return x; });
    mesh.positions[2].col(7) = -mesh.positions[2].col(7) * 3;
    test::expect_contains(
        test::error_of([&] { static_cast<void>(make_space_time(mesh, {.refine_time = 0})); }),
        {"frame_2: cell ", " is inverted or flat at t = 0.2 s", "in every frame"});
    MovingMesh flat = moving(test::centered_box(1, 1), {0, 0.1, 0.2, 0.3},
                             [](const auto& x, double) { return x; });
    flat.positions[2].row(2).setZero();
    test::expect_contains(
        test::error_of([&] { static_cast<void>(make_space_time(flat, {.refine_time = 0})); }),
        {"frame_2: cell 0 is inverted or flat at t = 0.2 s"});
}

}  // namespace
}  // namespace pent::mesher
