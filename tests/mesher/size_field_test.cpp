#include "images.h"

#include <pent/error.h>
#include <pent/exchange/tet_surface.h>
#include <pent/mesher/boundary_solid.h>
#include <pent/mesher/image_solid.h>
#include <pent/mesher/links.h>
#include <pent/mesher/primitives.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/quality.h>
#include <pent/mesher/stuff.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

namespace pent::mesher {
namespace {

using Eigen::Vector4d;

constexpr double kPi = std::numbers::pi;

SizeField at_plane(const Vector4d& normal, double offset, double growth) {
    SizeField sizes;
    sizes.plane = Hyperplane<4>{normal, offset};
    sizes.growth = growth;
    return sizes;
}

SizeField at_point(const Vector4d& point, double growth) {
    SizeField sizes;
    sizes.point = point;
    sizes.growth = growth;
    return sizes;
}

void expect_sound(const SimplexMesh<4>& mesh, const std::string& name) {
    EXPECT_NO_THROW(validate(mesh, name));
    EXPECT_EQ(describe_faults(prove(mesh), 4), "") << name;
    const LinkReport links = check_links(mesh);
    EXPECT_EQ(links.faulty, 0) << name;
    EXPECT_EQ(links.unused_vertices, 0) << name;
}

double longest_edge(const SimplexMesh<4>& mesh, Eigen::Index cell) {
    double longest = 0;
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < i; ++j) {
            longest = std::max(longest, (mesh.positions.col(mesh.cells(i, cell))
                                         - mesh.positions.col(mesh.cells(j, cell)))
                                            .norm());
        }
    }
    return longest;
}

TEST(SizeField, LetsEdgesGrowWithTheDistance) {
    const SizeField plane = at_plane({0, 0, 0, 2}, 1, 0.5);  // w = 0.5
    EXPECT_DOUBLE_EQ(plane.distance({7, 7, 7, 2.5}), 2);
    EXPECT_DOUBLE_EQ(plane.edge_within(0.1, {0, 0, 0, 2.5}, 0), 1.1);
    EXPECT_DOUBLE_EQ(plane.edge_within(0.1, {0, 0, 0, 2.5}, 1), 0.6);
    EXPECT_DOUBLE_EQ(plane.edge_within(0.1, {0, 0, 0, 2.5}, 3), 0.1);
    SizeField point = at_point({1, 0, 0, 0}, 1);
    point.longest = 0.3;
    EXPECT_DOUBLE_EQ(point.edge_within(0.1, {1, 0.1, 0, 0}, 0), 0.2);
    EXPECT_DOUBLE_EQ(point.edge_within(0.1, {1, 5, 0, 0}, 0), 0.3);
    EXPECT_DOUBLE_EQ(SizeField{}.edge_within(0.1, {1, 5, 0, 0}, 0), 0.1);
}

struct Case {
    const char* name;
    Solid solid;
    double hypervolume;  // m^4
    double edge_length;
    SizeField sizes;
    double least_mean_ratio;
    double part;  // of as many cells as there would be with short edges everywhere
};

std::vector<Case> cases() {
    return {
        {"ball, point", ball_solid(1), kPi * kPi / 2, 0.12, at_point({0.1, 0, 0, 0}, 1), 0.2, 0.13},
        {"spherinder, slice", spherinder_solid(0.5, 4), 4 * kPi / 3 * 0.125 * 4, 0.16,
         at_plane(Vector4d::UnitW(), 0.1, 1), 0.1, 0.6},
        {"tiger, leaning slice", tiger_solid({0.8, 0.7}, 0.35), 4 * kPi * kPi * kPi * 0.56 * 0.1225,
         0.175, at_plane({0.2, 0, 0.3, 1}, 0.1, 1), 0.15, 0.9},
        {"box, point at a corner", box_solid({1.2, 1, 0.8, 1.1}), 1.2 * 0.8 * 1.1, 0.12,
         at_point({0.6, 0.5, 0.4, 0.5}, 1), 0.1, 0.4}};
}

TEST(StuffWithSizes, MakesSoundMeshesOfEveryKindOfShape) {
    for (const Case& c : cases()) {
        const StuffedSolid stuffed = stuff(c.solid, c.edge_length, c.sizes);
        expect_sound(stuffed.mesh, c.name);
        const QualityReport quality = measure_quality(stuffed.mesh);
        EXPECT_GE(quality.mean_ratio.min, c.least_mean_ratio) << c.name;
        EXPECT_GE(quality.mean_ratio.mean, 0.6) << c.name;
        // Edges up to half of the thinnest part cut off some percents.
        EXPECT_NEAR(total_volume(stuffed.mesh) / c.hypervolume, 1, 0.15) << c.name;
        EXPECT_LT(static_cast<double>(stuffed.mesh.cell_count()),
                  c.part * estimate_cells(c.solid, c.edge_length))
            << c.name;
    }
}

// The same of a boundary and of an image, whose functions are not known but by what is in files.
TEST(StuffWithSizes, MakesSoundMeshesOfBoundariesAndImages) {
    const Solid ball = ball_solid(1);
    const auto surface = exchange::boundary_of(stuff(ball, 0.25).mesh);
    const Vector4d middle = Vector4d::Constant(1.2);
    const auto image = std::make_shared<const Image>(
        test::sampled(Eigen::Vector4i::Constant(13), Vector4d::Constant(0.2),
                      [&](const Vector4d& p) { return 1 - (p - middle).norm(); }));
    const std::vector<Case> all = {
        {"boundary, slice", boundary_solid(surface, "surface").solid, kPi * kPi / 2, 0.16,
         at_plane(Vector4d::UnitW(), -0.9, 1), 0.1, 0.5},
        {"boundary, point", boundary_solid(surface, "surface").solid, kPi * kPi / 2, 0.14,
         at_point({0, 0, 0, 1}, 1), 0.1, 0.3},
        {"image, slice", image_solid(image, 0), kPi * kPi / 2, 0.16,
         at_plane(Vector4d::UnitW(), 0.3, 1), 0.1, 0.5}};
    for (const Case& c : all) {
        const StuffedSolid stuffed = stuff(c.solid, c.edge_length, c.sizes);
        expect_sound(stuffed.mesh, c.name);
        EXPECT_GE(measure_quality(stuffed.mesh).mean_ratio.min, c.least_mean_ratio) << c.name;
        EXPECT_NEAR(total_volume(stuffed.mesh) / c.hypervolume, 1, 0.15) << c.name;
        EXPECT_LT(static_cast<double>(stuffed.mesh.cell_count()),
                  c.part * estimate_cells(c.solid, c.edge_length))
            << c.name;
        // Some cells are of the shortest edges, others of at least twice as long ones.
        double shortest = 1;
        double longest = 0;
        for (Eigen::Index cell = 0; cell < stuffed.mesh.cell_count(); ++cell) {
            shortest = std::min(shortest, longest_edge(stuffed.mesh, cell));
            longest = std::max(longest, longest_edge(stuffed.mesh, cell));
        }
        EXPECT_LT(shortest, 1.3 * c.edge_length) << c.name;
        EXPECT_GT(longest, 2 * c.edge_length) << c.name;
    }
}

// A lattice edge is at most sqrt(1.2) / 0.995 of the mean; vertices that move onto the surface or
// a ridge go less than half of that.
TEST(StuffWithSizes, NeverMakesCellsLongerThanIsAllowed) {
    for (const Case& c : cases()) {
        const SimplexMesh<4> mesh = stuff(c.solid, c.edge_length, c.sizes).mesh;
        double worst = 0;
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            Vector4d middle = Vector4d::Zero();
            for (int i = 0; i < 5; ++i) {
                middle += mesh.positions.col(mesh.cells(i, cell)) / 5;
            }
            worst = std::max(
                worst, longest_edge(mesh, cell) / c.sizes.edge_within(c.edge_length, middle, 0));
        }
        EXPECT_LT(worst, 2) << c.name;
    }
}

TEST(StuffWithSizes, KnowsHowManyCellsItWillMake) {
    for (const Case& c : cases()) {
        const auto cells =
            static_cast<double>(stuff(c.solid, c.edge_length, c.sizes).mesh.cell_count());
        const double estimate = estimate_cells(c.solid, c.edge_length, c.sizes);
        // What the boundary and the smaller neighbors of larger cells add.
        EXPECT_GT(cells, estimate) << c.name;
        EXPECT_LT(cells, 8 * estimate) << c.name;
    }
}

TEST(StuffWithSizes, IsThatOfOneSizeWithoutGrowth) {
    const SimplexMesh<4> plain = stuff(ball_solid(1), 0.3).mesh;
    const SimplexMesh<4> graded = stuff(ball_solid(1), 0.3, at_plane(Vector4d::UnitW(), 0, 0)).mesh;
    EXPECT_EQ(plain.cell_count(), graded.cell_count());
    EXPECT_TRUE((plain.positions.array() == graded.positions.array()).all());
}

// Of the slice where edges are short: the error is that of its edges, quartered where they are
// halved, though the rest of the body is coarser.
TEST(StuffWithSizes, ApproximatesTheSliceToSecondOrder) {
    const auto radius_lost = [](double edge_length) {
        SizeField sizes = at_plane(Vector4d::UnitW(), 0, 1);
        const Solid ball = ball_solid(1);
        const SimplexMesh<4> mesh = stuff(ball, edge_length, sizes).mesh;
        // The largest depth of the middles of edges of the boundary near the slice.
        double deepest = 0;
        const auto on_sphere = [&](std::uint32_t v) {
            return std::abs(mesh.positions.col(v).norm() - 1) < 1e-6;
        };
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            for (int i = 0; i < 5; ++i) {
                for (int j = 0; j < i; ++j) {
                    const std::uint32_t a = mesh.cells(i, cell);
                    const std::uint32_t b = mesh.cells(j, cell);
                    const Vector4d middle = (mesh.positions.col(a) + mesh.positions.col(b)) / 2;
                    if (std::abs(middle[3]) < 0.05 && on_sphere(a) && on_sphere(b)) {
                        deepest = std::max(deepest, 1 - middle.norm());
                    }
                }
            }
        }
        return deepest;
    };
    // What is longest of a few hundred scatters by a third.
    EXPECT_NEAR(radius_lost(0.3) / radius_lost(0.15), 4, 1.5);
}

std::string refusal(const SizeField& sizes) {
    try {
        (void)stuff(ball_solid(1), 0.3, sizes);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(StuffWithSizes, SaysWhatCannotBeMeant) {
    EXPECT_NE(refusal(at_point(Vector4d::Zero(), -1)).find("expected 0 or more"),
              std::string::npos);
    SizeField sizes = at_point(Vector4d::Zero(), 1);
    sizes.longest = 0.1;
    EXPECT_NE(refusal(sizes).find("shorter than the shortest of 0.3 m"), std::string::npos);
}

}  // namespace
}  // namespace pent::mesher
