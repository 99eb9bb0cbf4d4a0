#include "shapes/tet_boundary.h"
#include "support/messages.h"
#include "support/temp_folder.h"

#include <pent/error.h>
#include <pent/exchange/exchange.h>
#include <pent/mesher/boundary_solid.h>
#include <pent/mesher/links.h>
#include <pent/mesher/make_body.h>
#include <pent/mesher/primitives.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/quality.h>
#include <pent/mesher/read_solid.h>
#include <pent/mesher/shapes.h>
#include <pent/mesher/stuff.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace pent::mesher {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;
using exchange::TetSurface;

TetSurface boundary_of_stuffed(const Solid& solid, double edge_length) {
    return exchange::boundary_of(stuff(solid, edge_length).mesh);
}

// Tesseracts cut into pentachora, around the origin.
TetSurface tesseract(double edge) {
    SimplexMesh<4> mesh = box<4>({1, 1, 1, 1}, {edge, edge, edge, edge}, CubeCut::Paths);
    mesh.positions.array() -= edge / 2;
    return exchange::boundary_of(mesh);
}

TetSurface joined(const TetSurface& a, const TetSurface& b) {
    TetSurface both{Positions<4>(4, a.points.cols() + b.points.cols()),
                    Simplices<4>(4, a.tetrahedra.cols() + b.tetrahedra.cols())};
    both.points << a.points, b.points;
    both.tetrahedra << a.tetrahedra,
        (b.tetrahedra.array() + static_cast<std::uint32_t>(a.points.cols())).matrix();
    return both;
}

TetSurface moved(TetSurface surface, const Vector4d& by) {
    surface.points.colwise() += by;
    return surface;
}

TetSurface turned(TetSurface surface) {
    surface.tetrahedra.row(2).swap(surface.tetrahedra.row(3));
    return surface;
}

// Only the tetrahedra with these numbers.
TetSurface some_of(const TetSurface& surface, const std::vector<Eigen::Index>& which) {
    return {surface.points, surface.tetrahedra(Eigen::all, which)};
}

TetSurface without(const TetSurface& surface, const std::vector<Eigen::Index>& left_out) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index t = 0; t < surface.tetrahedra.cols(); ++t) {
        if (std::find(left_out.begin(), left_out.end(), t) == left_out.end()) {
            kept.push_back(t);
        }
    }
    return some_of(surface, kept);
}

Vector4d random_point(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    return Vector4d(uniform(random), uniform(random), uniform(random), uniform(random));
}

bool is_in_mesh(const SimplexMesh<4>& mesh, const Vector4d& p) {
    for (const auto& cell : mesh.cells.colwise()) {
        Matrix4d edges;
        for (int i = 0; i < 4; ++i) {
            edges.col(i) = mesh.positions.col(cell[i + 1]) - mesh.positions.col(cell[0]);
        }
        const Vector4d parts = edges.inverse() * (p - mesh.positions.col(cell[0]));
        if (parts.minCoeff() >= 0 && parts.sum() <= 1) {
            return true;
        }
    }
    return false;
}

void expect_sound(const SimplexMesh<4>& mesh) {
    EXPECT_NO_THROW(validate(mesh, "mesh"));
    EXPECT_EQ(describe_faults(prove(mesh), 4), "");
    const LinkReport links = check_links(mesh);
    EXPECT_EQ(links.faulty, 0);
}

TEST(TetBoundary, WindsAroundWhatSomePentachoronHolds) {
    std::mt19937 random(3);
    for (const Solid& solid : {tiger_solid({0.8, 0.7}, 0.35), spheritorus_solid(0.7, 0.45)}) {
        const SimplexMesh<4> mesh = stuff(solid, 0.3).mesh;
        const TetBoundary boundary(exchange::boundary_of(mesh));
        int inside = 0;
        for (int i = 0; i < 400; ++i) {
            const Vector4d p = random_point(random, 0.9);
            const bool is_inside = is_in_mesh(mesh, p);
            EXPECT_EQ(boundary.winding_number(p), is_inside ? 1 : 0) << p.transpose();
            EXPECT_EQ(boundary.value(p) < 0, is_inside);
            inside += is_inside ? 1 : 0;
        }
        EXPECT_GT(inside, 10);
    }
}

// A body's boundary is within the sagitta of its surface: where the function of the shape is
// further from zero, both agree.
TEST(TetBoundary, AgreesWithTheShapeItWasMadeFrom) {
    std::mt19937 random(4);
    const Solid tiger = tiger_solid({0.8, 0.7}, 0.35);
    const TetBoundary boundary(boundary_of_stuffed(tiger, 0.2));
    for (int i = 0; i < 3000; ++i) {
        const Vector4d p = random_point(random, 1.2);
        // Edges of up to 0.3 sag by 0.3^2 / (8 * 0.35), tetrahedra by twice of that.
        constexpr double kSagitta = 0.07;
        EXPECT_NEAR(boundary.value(p), tiger.value(p), kSagitta);
        if (std::abs(tiger.value(p)) > kSagitta) {
            EXPECT_EQ(boundary.winding_number(p), tiger.value(p) < 0 ? 1 : 0);
        }
    }
}

TEST(TetBoundary, KnowsTheDistanceFromATesseract) {
    std::mt19937 random(5);
    const TetBoundary boundary(tesseract(2));
    EXPECT_EQ(boundary.patch_count(), 8);
    for (int i = 0; i < 2000; ++i) {
        const Vector4d p = random_point(random, 2);
        const Eigen::Array4d beyond = p.array().abs() - 1;
        const double expected =
            beyond.maxCoeff() < 0 ? beyond.maxCoeff() : beyond.max(0).matrix().norm();
        EXPECT_NEAR(boundary.value(p), expected, 1e-13);
        // Of a flat patch the height over its hyperplane, wherever the point is.
        double least = 10;
        for (int patch = 0; patch < 8; ++patch) {
            const double height = boundary.patch_value(patch, p);
            double nearest = 10;
            for (int axis = 0; axis < 4; ++axis) {
                nearest = std::min(
                    {nearest, std::abs(height - (p[axis] - 1)), std::abs(height - (-p[axis] - 1))});
            }
            EXPECT_LT(nearest, 1e-13);
            least = std::min(least, std::abs(height));
        }
        for (const int patch : boundary.patches_within(p, std::abs(expected) + 1e-9)) {
            EXPECT_LE(std::abs(boundary.patch_value(patch, p)), std::abs(expected) + 1e-9);
        }
    }
    EXPECT_EQ(boundary.patches_within({1, 0.2, 0.1, -0.3}, 1e-9).size(), 1U);
    EXPECT_EQ(boundary.patches_within({1, 1, 0.1, -0.3}, 1e-9).size(), 2U);
    EXPECT_EQ(boundary.patches_within({1, 1, -1, 1}, 1e-9).size(), 4U);
}

TEST(TetBoundary, KnowsItsSlope) {
    std::mt19937 random(6);
    for (const TetBoundary& boundary :
         {TetBoundary(tesseract(2)), TetBoundary(boundary_of_stuffed(ball_solid(1), 0.4))}) {
        for (int i = 0; i < 200; ++i) {
            const Vector4d p = random_point(random, 1.5);
            const ValueSlope found = boundary.value_slope(p);
            EXPECT_EQ(found.value, boundary.value(p));
            EXPECT_NEAR(found.slope.norm(), 1, 1e-12);
            // As far as the value says along it is the surface; no further point of a step is
            // nearer.
            EXPECT_NEAR(boundary.value(p - found.value * found.slope), 0, 1e-13);
        }
    }
    // Over a flat patch the height grows as the way along its normal, wherever the point is.
    const TetBoundary box(tesseract(2));
    for (int i = 0; i < 200; ++i) {
        const Vector4d p = random_point(random, 1.5);
        const ValueSlope over = box.patch_slope(i % 8, p);
        EXPECT_NEAR(over.slope.norm(), 1, 1e-14);
        EXPECT_NEAR(box.patch_value(i % 8, p + 0.3 * over.slope), over.value + 0.3, 1e-13);
    }
    // On the surface the slope is the normal.
    const Vector4d on_side(1, 0.2, 0.1, -0.3);
    const ValueSlope there = box.value_slope(on_side);
    EXPECT_NEAR(there.value, 0, 1e-15);
    EXPECT_NEAR(there.slope[0], 1, 1e-12);
}

TEST(BoundarySolid, KeepsTheHypervolumeToSecondOrder) {
    const TetSurface boundary = boundary_of_stuffed(ball_solid(1), 0.25);
    const double exact = exchange::enclosed_hypervolume(boundary);
    const BoundarySolid body = boundary_solid(boundary, "ball");
    EXPECT_FALSE(body.report.is_mended());
    EXPECT_EQ(body.report.patches, 1);
    std::vector<double> lost;
    for (const double edge_length : {0.48, 0.32}) {
        const StuffedSolid stuffed = stuff(body.solid, edge_length);
        expect_sound(stuffed.mesh);
        lost.push_back(1 - total_volume(stuffed.mesh) / exact);
    }
    // As of the shapes themselves, within the scatter of where the lattice lies.
    EXPECT_NEAR(lost[0] / lost[1], 2.25, 0.6);
    EXPECT_LT(lost[1], 0.06);
}

TEST(BoundarySolid, KeepsTheRidgesOfATesseractAndOfADuocylinder) {
    const StuffedSolid box = stuff(boundary_solid(tesseract(1.2), "tesseract").solid, 0.25);
    expect_sound(box.mesh);
    // Bevels of an edge along all ridges would leave out a tenth.
    EXPECT_NEAR(total_volume(box.mesh), std::pow(1.2, 4), 0.01 * std::pow(1.2, 4));
    EXPECT_GE(measure_quality(box.mesh).mean_ratio.min, 0.1);

    const TetSurface boundary = boundary_of_stuffed(duocylinder_solid({0.8, 0.7}), 0.3);
    const StuffedSolid duocylinder = stuff(boundary_solid(boundary, "duocylinder").solid, 0.3);
    expect_sound(duocylinder.mesh);
    EXPECT_NEAR(total_volume(duocylinder.mesh) / exchange::enclosed_hypervolume(boundary), 1, 0.03);
}

TEST(BoundarySolid, JoinsInOperations) {
    const Solid tesseracts = boundary_solid(tesseract(1.2), "tesseract").solid;
    const StuffedSolid holed = stuff(subtract(tesseracts, ball_solid(0.4)), 0.25);
    expect_sound(holed.mesh);
    const double expected = std::pow(1.2, 4) - std::pow(0.4, 4) * 4.9348;  // pi^2 / 2
    EXPECT_NEAR(total_volume(holed.mesh), expected, 0.02 * expected);
}

TEST(BoundarySolid, LeavesCavitiesEmpty) {
    const TetSurface hollow = joined(tesseract(2), turned(tesseract(1)));
    const BoundarySolid body = boundary_solid(hollow, "hollow", false);
    EXPECT_GT(body.solid.value({0, 0, 0, 0}), 0);
    EXPECT_LT(body.solid.value({0.75, 0, 0, 0}), 0);
    EXPECT_NEAR(body.solid.value({0.6, 0, 0, 0}), -0.1, 1e-14);
}

// What was mended has the same sides of all points as what was sound.
void expect_mended_as(const TetSurface& sound, const TetSurface& dirty, const char* what) {
    const Solid expected = boundary_solid(sound, "sound", false).solid;
    EXPECT_THROW(static_cast<void>(boundary_solid(dirty, "dirty", false)), Error) << what;
    const BoundarySolid mended = boundary_solid(dirty, "dirty");
    EXPECT_TRUE(mended.report.is_mended()) << what;
    EXPECT_EQ(describe(mended.report).find('\n'), std::string::npos);
    std::mt19937 random(6);
    for (int i = 0; i < 500; ++i) {
        const Vector4d p = random_point(random, 1.2);
        EXPECT_NEAR(mended.solid.value(p), expected.value(p), 1e-13) << what;
    }
}

TEST(BoundarySolid, MendsWhatIsMissingRepeatedOrTurned) {
    const TetSurface sound = boundary_of_stuffed(ball_solid(1), 0.5);
    const Eigen::Index count = sound.tetrahedra.cols();
    expect_mended_as(sound, without(sound, {7}), "a tetrahedron is missing");
    expect_mended_as(sound, joined(sound, sound), "all of it twice");
    expect_mended_as(sound, joined(sound, turned(sound)), "both sides of it");
    expect_mended_as(sound, joined(sound, some_of(sound, {3, 4, 5})), "some of it twice");
    TetSurface flipped = sound;
    for (const Eigen::Index t : {Eigen::Index(0), count / 2, count - 1}) {
        std::swap(flipped.tetrahedra(0, t), flipped.tetrahedra(1, t));
    }
    expect_mended_as(sound, flipped, "some are turned over");
    expect_mended_as(sound, without(flipped, {count / 3}), "turned over, and one is missing");
    EXPECT_EQ(boundary_solid(flipped, "flipped").report.turned, 3);
    TetSurface extra = joined(sound, some_of(sound, {3, 4, 5}));
    extra.tetrahedra(1, count) = extra.tetrahedra(0, count);
    const BoundaryReport report = boundary_solid(extra, "extra").report;
    EXPECT_EQ(report.repeated, 2);
    EXPECT_EQ(report.degenerate, 1);
}

TEST(BoundarySolid, TakesPointsAtOnePlaceForOne) {
    const TetSurface sound = tesseract(1);
    TetSurface soup{Positions<4>(4, 4 * sound.tetrahedra.cols()),
                    Simplices<4>(4, sound.tetrahedra.cols())};
    for (Eigen::Index i = 0; i < soup.points.cols(); ++i) {
        soup.points.col(i) = sound.points.col(sound.tetrahedra(i % 4, i / 4));
        soup.tetrahedra(i % 4, i / 4) = static_cast<std::uint32_t>(i);
    }
    const BoundarySolid body = boundary_solid(soup, "soup", false);
    EXPECT_EQ(body.report.merged_points, soup.points.cols() - 16);
    EXPECT_NEAR(body.solid.value({0, 0, 0, 0}), -0.5, 1e-15);
}

TEST(BoundarySolid, UnitesWhatCrossesItself) {
    const Vector4d by(0.6, 0.3, 0.2, 0.1);
    const TetSurface crossing = joined(tesseract(1), moved(tesseract(1), by));
    const BoundarySolid body = boundary_solid(crossing, "crossing");
    std::mt19937 random(7);
    const Solid one = box_solid({1, 1, 1, 1});
    const Solid both = unite(one, place(one, 1, Matrix4d::Identity(), by));
    for (int i = 0; i < 2000; ++i) {
        const Vector4d p = random_point(random, 1.5);
        EXPECT_EQ(body.solid.value(p) < 0, both.value(p) < 0) << p.transpose();
    }
    // Turned inside out, and open: parts are outward again, or what both have would be outside.
    const TetSurface second = moved(tesseract(1), by);
    const TetSurface open = without(joined(tesseract(1), turned(second)), {3, 60});
    const BoundarySolid closed = boundary_solid(open, "open");
    EXPECT_EQ(closed.report.holes, 2);
    EXPECT_EQ(closed.report.turned, second.tetrahedra.cols() - 1);
    for (int i = 0; i < 2000; ++i) {
        const Vector4d p = random_point(random, 1.5);
        EXPECT_EQ(closed.solid.value(p) < 0, both.value(p) < 0) << p.transpose();
    }
    const TetSurface nested = joined(tesseract(1.5), moved(tesseract(0.5), by / 8));
    const BoundarySolid outer = boundary_solid(nested, "nested");
    EXPECT_EQ(outer.report.inner, 48);
    EXPECT_NEAR(outer.solid.value({0, 0, 0, 0}), -0.75, 1e-14) << "walls within are no surface";
}

std::string refusal(const TetSurface& surface) {
    return test::error_of([&] { static_cast<void>(boundary_solid(surface, "x.4off")); });
}

TEST(BoundarySolid, SaysWhyAndWhereItEnclosesNothing) {
    const TetSurface sound = boundary_of_stuffed(ball_solid(1), 0.5);
    std::vector<Eigen::Index> half;
    for (Eigen::Index t = 0; t < sound.tetrahedra.cols(); ++t) {
        if (sound.points(0, sound.tetrahedra(0, t)) < 0) {
            half.push_back(t);
        }
    }
    test::expect_contains(refusal(some_of(sound, half)), {"x.4off: a hole around (", "m^3"});
    const TetSurface sheet = some_of(sound, {0});
    test::expect_contains(refusal(sheet), {"x.4off: "});
    TetSurface degenerate = sheet;
    degenerate.tetrahedra(1, 0) = degenerate.tetrahedra(0, 0);
    test::expect_contains(refusal(degenerate), {"no tetrahedron of four different points"});
}

// Hypervolumes of what is larger are no numbers, of what is smaller they are 0.
TEST(BoundarySolid, RefusesWhatIsTooLargeOrTooSmallToMeasure) {
    const TetSurface sound = boundary_of_stuffed(ball_solid(1), 0.6);
    for (const double scale : {1e68, 1e200, 1e-60}) {
        TetSurface scaled = sound;
        scaled.points *= scale;
        test::expect_contains(refusal(scaled), {"x.4off: the boundary is ", " m across",
                                                "1e-30 to 1e+30 m", "scale it first"});
    }
    const double depth = boundary_solid(sound, "").solid.value({0, 0, 0, 0});
    for (const int digits : {-83, 83}) {  // powers of two, so that nothing is rounded
        TetSurface scaled = sound;
        scaled.points *= std::ldexp(1, digits);
        const BoundarySolid body = boundary_solid(scaled, "x.4off");
        EXPECT_EQ(body.solid.value({0, 0, 0, 0}), std::ldexp(depth, digits));
    }
}

TEST(BoundarySolid, ReadsTheFilesThatHoldBoundaries) {
    const test::TempFolder folder;
    const SimplexMesh<4> mesh = stuff(ball_solid(1), 0.6).mesh;
    const double exact = total_volume(mesh);
    for (const char* name : {"a.pent", "a.4off", "a.off", "a.g4tf", "a.g4b", "a.4do", "a.obj"}) {
        const auto path = folder / name;
        exchange::write(path, exchange::Body{mesh}, {.in_double = true});
        EXPECT_TRUE(is_boundary_file(path)) << name;
        EXPECT_NEAR(exchange::enclosed_hypervolume(read_boundary(path)), exact, 1e-12) << name;
    }
    std::ofstream(folder / "plane.off") << "# of three dimensions\nOFF\n3 1 0\n";
    std::ofstream(folder / "plane.obj") << "v 0 0 0\nf 1 2 3\n";
    EXPECT_FALSE(is_boundary_file(folder / "plane.off"));
    EXPECT_FALSE(is_boundary_file(folder / "plane.obj"));
    EXPECT_FALSE(is_boundary_file(folder / "a.stl"));
    std::ofstream(folder / "marked.off") << "\xEF\xBB\xBF"
                                         << "4OFF\n";
    EXPECT_TRUE(is_boundary_file(folder / "marked.off"));
}

// What was wrong with a file is said and decided here.
TEST(BoundarySolid, CountsThePointsOfAFileThatItMakesOne) {
    const test::TempFolder folder;
    const TetSurface sound = tesseract(1);
    TetSurface soup{Positions<4>(4, sound.tetrahedra.size()),
                    Simplices<4>(4, sound.tetrahedra.cols())};
    for (Eigen::Index i = 0; i < soup.points.cols(); ++i) {
        soup.points.col(i) = sound.points.col(sound.tetrahedra(i % 4, i / 4));
        soup.tetrahedra(i % 4, i / 4) = static_cast<std::uint32_t>(i);
    }
    exchange::write(folder / "soup.4do", soup);
    EXPECT_EQ(boundary_solid(read_boundary(folder / "soup.4do"), "soup").report.merged_points,
              soup.points.cols() - 16);
}

TEST(BoundarySolid, ReportsHolesInMetersWhereTheBodyIs) {
    const test::TempFolder folder;
    exchange::write(folder / "open.4off", without(tesseract(1), {3}));
    BodyRequest request;
    request.input = folder / "open.4off";
    request.edge_length = 0.3;
    const BoundaryReport there = make_body(request).report.boundary;
    request.scale = 0.001;
    request.edge_length *= request.scale;
    request.translation = Eigen::Vector3d(1, 2, 3);
    const BoundaryReport moved = make_body(request).report.boundary;
    EXPECT_GT(there.largest_hole, 0);
    EXPECT_DOUBLE_EQ(moved.largest_hole, 1e-9 * there.largest_hole);
    EXPECT_LT((moved.hole_place - 0.001 * there.hole_place - Vector4d(1, 2, 3, 0)).norm(), 1e-15);
}

TEST(BoundarySolid, IsAPrimitiveOfShapeFiles) {
    const test::TempFolder folder;
    exchange::write(folder / "box.4off", tesseract(1));
    exchange::write(folder / "open.4off", without(tesseract(1), {3}));
    const auto write = [&](const std::string& text) {
        std::ofstream(folder / "shape.toml") << text;
        return folder / "shape.toml";
    };
    const Solid solid = read_solid(
        write("[[shape]]\nboundary = { file = \"box.4off\" }\nscale = 2\n[[shape]]\nop = "
              "\"difference\"\nball = { radius = 0.5 }\n"));
    EXPECT_NEAR(solid.value({0.8, 0, 0, 0}), -0.2, 1e-14);
    EXPECT_NEAR(solid.value({0, 0, 0, 0}), 0.5, 1e-14);
    const auto error_with = [&](const std::string& keys) {
        const auto path = write("[[shape]]\nboundary = { " + keys + " }\n");
        return test::error_of([&] { static_cast<void>(read_solid(path)); });
    };
    test::expect_contains(error_with("file = \"none.4off\""), {"shape.toml:2:", "none.4off"});
    test::expect_contains(error_with("file = \"open.4off\""),
                          {"shape.toml:2:", "4 open triangles"});
    const Solid mended =
        read_solid(write("[[shape]]\nboundary = { file = \"open.4off\", mend = true }\n"));
    EXPECT_NEAR(mended.value({0, 0, 0, 0}), -0.5, 1e-14);
}

}  // namespace
}  // namespace pent::mesher
