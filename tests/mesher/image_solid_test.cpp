#include "images.h"
#include "shapes/image_level.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/facets.h>
#include <pent/mesher/image_solid.h>
#include <pent/mesher/links.h>
#include <pent/mesher/make_body.h>
#include <pent/mesher/primitives.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/read_solid.h>
#include <pent/mesher/stuff.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>

namespace pent::mesher {
namespace {

using Eigen::Vector4d;
using Eigen::Vector4i;

constexpr double kBall = std::numbers::pi * std::numbers::pi / 2;  // of radius 1, m^4
const Vector4d kMiddle(1.25, 1.3, 1.2, 1.25);

// A ball of radius 1 in a box of 2.5, by its signed distance, in samples this far apart.
Image ball_image(const Vector4d& spacing) {
    const Vector4i size = (2.5 / spacing.array()).round().cast<int>() + 1;
    return test::sampled(size, spacing, [](const Vector4d& p) { return 1 - (p - kMiddle).norm(); });
}

double ball_hypervolume(const Vector4d& spacing, double edge_length) {
    const auto image = std::make_shared<const Image>(ball_image(spacing));
    const StuffedSolid stuffed = stuff(image_solid(image, 0), edge_length);
    EXPECT_EQ(describe_faults(prove(stuffed.mesh), 4), "");
    EXPECT_EQ(check_links(stuffed.mesh).faulty, 0);
    return total_volume(stuffed.mesh);
}

TEST(ImageSolid, HasTheHypervolumeOfABallToSecondOrderInSamplesAndEdges) {
    // Samples of different spacing along each axis, as scans have them.
    const Vector4d spacing(0.3, 0.3, 0.35, 0.4);
    const double coarse = 1 - ball_hypervolume(spacing, 0.45) / kBall;
    const double fine = 1 - ball_hypervolume(spacing / 1.5, 0.3) / kBall;
    EXPECT_GT(fine, 0);
    EXPECT_NEAR(coarse / fine, 2.25, 0.6);
    // Chords of edges of 0.3 take 4%, chords of the distance between samples about as much.
    EXPECT_LT(fine, 0.12);
}

TEST(ImageSolid, IsTheLevelOfWhatIsMultilinearExactly) {
    // x + 2 y - z + 3 w + x y w is multilinear itself.
    const auto function = [](const Vector4d& p) {
        return p[0] + 2 * p[1] - p[2] + 3 * p[3] + p[0] * p[1] * p[3];
    };
    const auto image =
        std::make_shared<const Image>(test::sampled({3, 4, 5, 3}, {0.5, 0.25, 0.5, 1}, function));
    const Solid solid = image_solid(image, 2.5);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    const ImageLevel level(image, 2.5);
    for (int i = 0; i < 500; ++i) {
        const Vector4d p(uniform(random), 0.75 * uniform(random), 2 * uniform(random),
                         2 * uniform(random));
        // Samples are floats, of 3e-7 of 10.
        EXPECT_EQ(level.value(p) < 0, function(p) > 2.5) << p.transpose();
        if (std::abs(function(p) - 2.5) > 1e-5) {
            EXPECT_EQ(solid.value(p) < 0, function(p) > 2.5) << p.transpose();
        }
        const double radius = 0.3 * uniform(random);
        const ValueRange range = level.range(p, radius);
        const Vector4d to(uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5,
                          uniform(random) - 0.5);
        const double near = level.value(p + radius * to.normalized());
        EXPECT_LE(range.low, near);
        EXPECT_GE(range.high, near);
    }
    EXPECT_GT(solid.value({1.1, 0.5, 1, 1}), 0) << "beyond the image is outside";
}

TEST(ImageSolid, KnowsItsSlope) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-0.2, 1);
    const auto image = std::make_shared<const Image>(
        test::sampled({4, 3, 5, 3}, {0.3, 0.4, 0.2, 0.45}, [&](auto&) { return uniform(random); }));
    const ImageLevel level(image, 0.4);
    for (int i = 0; i < 500; ++i) {
        const Vector4d p(uniform(random), uniform(random), uniform(random), uniform(random));
        const ValueSlope found = level.value_slope(p);
        EXPECT_NEAR(found.value, level.value(p), 1e-14);
        for (int axis = 0; axis < 4; ++axis) {
            const Vector4d step = 1e-6 * Vector4d::Unit(axis);
            const double before = (level.value(p) - level.value(p - step)) / 1e-6;
            const double after = (level.value(p + step) - level.value(p)) / 1e-6;
            // Along each axis it is linear, but where cells meet.
            if (std::abs(after - before) < 1e-6) {
                EXPECT_NEAR(found.slope[axis], after, 1e-7);
            }
        }
    }
}

TEST(ImageSolid, CutsOffWhatReachesTheSides) {
    const auto image = std::make_shared<const Image>(test::sampled(
        {6, 6, 6, 6}, Vector4d::Constant(0.2), [](const Vector4d& p) { return p[0]; }));
    const StuffedSolid half = stuff(image_solid(image, 0.5), 0.25);
    EXPECT_EQ(check_links(half.mesh).faulty, 0);
    EXPECT_NEAR(total_volume(half.mesh), 0.5, 0.01);
}

// An image that is near its level far away is as good as on it there: a body that blends with it
// grows by `smooth` itself.
std::shared_ptr<const Image> faint_image() {
    return std::make_shared<const Image>(test::sampled(
        {5, 5, 5, 5}, Vector4d::Ones(),
        [](const Vector4d& p) { return (p - Vector4d::Constant(2)).norm() < 1 ? 1000 : 9.99; }));
}

TEST(ImageSolid, LeavesRoomForWhatABlendAdds) {
    const Solid faint = image_solid(faint_image(), 10);
    const Solid box =
        place(box_solid(Vector4d::Ones()), 1, Eigen::Matrix4d::Identity(), {2, 2, 2, 4});
    const Vector4d top(2, 2, 2, 6.48);
    for (const Solid& solid : {unite(faint, box, 2), unite(box, faint, 2)}) {
        EXPECT_LT(solid.value(top), 0);
        EXPECT_GE(solid.bounds().high[3], top[3]);
    }
    const StuffedSolid stuffed = stuff(unite(faint, box, 2), 0.9);
    EXPECT_EQ(describe_faults(prove(stuffed.mesh), 4), "");
    EXPECT_EQ(check_links(stuffed.mesh).faulty, 0);
    EXPECT_NEAR(stuffed.mesh.positions.row(3).maxCoeff(), 6.5, 0.02);
}

TEST(ImageSolid, SaysWhereABlendHasNoEnd) {
    const Solid faint = image_solid(faint_image(), 10);
    const Solid other = place(faint, 1, Eigen::Matrix4d::Identity(), {0.5, 0, 0, 0});
    test::expect_contains(
        test::error_of([&] { static_cast<void>(stuff(unite(faint, other, 2), 0.9)); }),
        {"the shape reaches beyond its bounds, at (", "\"smooth\""});
}

TEST(ImageSolid, SaysWhichLevelsThereAre) {
    const auto image = std::make_shared<const Image>(ball_image(Vector4d::Constant(0.5)));
    test::expect_contains(test::error_of([&] { static_cast<void>(image_solid(image, 7)); }),
                          {"image: no surface at level 7", "between"});
    Image labels = *image;
    test::expect_contains(test::error_of([&] { static_cast<void>(label_solid(labels)); }),
                          {"no label", "--level"});
}

TEST(ImageSolid, IsAPrimitiveOfShapeFiles) {
    const test::TempFolder folder;
    std::ofstream(folder / "ball.nii", std::ios::binary)
        << test::nifti(ball_image(Vector4d::Constant(0.25)));
    std::ofstream(folder / "shape.toml")
        << "[[shape]]\nimage = { file = \"ball.nii\", level = 0 }\ntranslate = [-1.25, -1.3, -1.2, "
           "-1.25]\n[[shape]]\nop = \"difference\"\nball = { radius = 0.5 }\n";
    const Solid solid = read_solid(folder / "shape.toml");
    EXPECT_NEAR(solid.value({0, 0, 0, 0}), 0.5, 0.02);
    EXPECT_LT(solid.value({0.75, 0, 0, 0}), 0);
    EXPECT_GT(solid.value({0, 0, -1.05, 0}), 0);
}

// Two halves of a ball with the labels 3 and 7.
std::string label_file() {
    return test::nifti(
        test::sampled({14, 14, 14, 14}, Vector4d::Constant(0.2), [](const Vector4d& p) {
            const Vector4d from = p - Vector4d::Constant(1.3);
            return from.norm() > 1 ? 0 : from[0] < 0 ? 3 : 7;
        }));
}

TEST(Labels, ThatTouchShareTheirInterface) {
    const test::TempFolder folder;
    std::ofstream(folder / "labels.nii", std::ios::binary) << label_file();
    BodyRequest request;
    request.input = folder / "labels.nii";
    request.image.is_labels = true;
    request.scale = 2;
    request.edge_length = 0.4;
    const Body<4> body = make_body(request);  // proved: every inner facet has two sides
    std::array<double, 2> parts{};
    for (Eigen::Index cell = 0; cell < body.mesh.cell_count(); ++cell) {
        const auto label = body.mesh.regions[static_cast<std::size_t>(cell)];
        ASSERT_TRUE(label == 3 || label == 7);
        parts[label == 3 ? 0 : 1] +=
            cell_volume<4>(body.mesh.positions, body.mesh.cells, cell) / 16;
    }
    // Sides of samples are steps of 0.2; the halves of a ball of 1 have 2.47 each.
    EXPECT_NEAR(parts[0] + parts[1], kBall, 0.3);
    // The plane of x = 0 is next to that in the middle between samples of both, at -0.1.
    EXPECT_NEAR(parts[0] - parts[1], 0, 0.9);
    // Facets between the two are in both, as the facets of one body alone: none are boundary.
    SimplexMesh<4> first = body.mesh;
    Eigen::Index kept = 0;
    for (Eigen::Index cell = 0; cell < body.mesh.cell_count(); ++cell) {
        if (body.mesh.regions[static_cast<std::size_t>(cell)] == 3) {
            first.cells.col(kept++) = body.mesh.cells.col(cell);
        }
    }
    first.cells.conservativeResize(Eigen::NoChange, kept);
    const auto whole = match_facets<4>(body.mesh.cells, body.mesh.vertex_count());
    const auto part = match_facets<4>(first.cells, body.mesh.vertex_count());
    EXPECT_TRUE(whole.is_conforming());
    EXPECT_TRUE(part.is_conforming());
    EXPECT_GT(part.boundary.cols(), 100);
}

// Cells that reach across a cavity have no labeled sample around their middles.
TEST(Labels, AreOfThePartWhereCellsReachAcrossACavity) {
    const test::TempFolder folder;
    std::ofstream(folder / "shell.nii", std::ios::binary)
        << test::nifti(test::sampled({24, 24, 24, 24}, Vector4d::Ones(), [](const Vector4d& p) {
               const double radius = (p - Vector4d::Constant(11.5)).norm();
               return radius < 10 && radius > 2.5 ? 5 : 0;
           }));
    BodyRequest request;
    request.input = folder / "shell.nii";
    request.image.is_labels = true;
    for (const double edge : {2.5, 4.0}) {
        request.edge_length = edge;
        const std::vector<std::uint16_t> regions = make_body(request).mesh.regions;
        EXPECT_EQ(std::count(regions.begin(), regions.end(), 5), std::ssize(regions)) << edge;
    }
}

// What is said in meters is, whatever the unit of the file.
TEST(Images, TakeTheirSpacingInMeters) {
    const test::TempFolder folder;
    std::ofstream(folder / "labels.nii", std::ios::binary) << label_file();
    BodyRequest request;
    request.input = folder / "labels.nii";
    request.image.level = 1;
    request.edge_length = 2;
    request.image.spacing = Vector4d(1, 1, 1, 0.5);
    const Body<4> body = make_body(request);
    EXPECT_GT(body.mesh.positions.row(0).maxCoeff(), 10);
    request.scale = 0.5;
    EXPECT_EQ(make_body(request).mesh.positions, body.mesh.positions);
}

TEST(Images, NeedALevelOrLabels) {
    const test::TempFolder folder;
    std::ofstream(folder / "labels.nii", std::ios::binary) << label_file();
    BodyRequest request;
    request.input = folder / "labels.nii";
    request.edge_length = 0.2;
    const auto refusal = [&] {
        return test::error_of([&] { static_cast<void>(make_body(request)); });
    };
    test::expect_contains(refusal(), {"labels.nii", "--level", "--labels"});
    request.image.level = 1;
    request.image.is_labels = true;
    test::expect_contains(refusal(), {"labels.nii", "--level", "--labels"});
    request.input = SphereShape{};
    test::expect_contains(refusal(), {"no image"});
}

}  // namespace
}  // namespace pent::mesher
