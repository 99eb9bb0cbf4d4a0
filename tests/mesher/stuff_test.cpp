#include "shapes/lattice_stuffing.h"
#include "shapes/star_mesh.h"
#include "shapes/surface_mesh.h"
#include "shapes/surface_search.h"

#include <pent/error.h>
#include <pent/mesher/links.h>
#include <pent/mesher/primitives.h>
#include <pent/mesher/prove.h>
#include <pent/mesher/quality.h>
#include <pent/mesher/stuff.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace pent::mesher {
namespace {

using Eigen::Vector4d;

constexpr double kPi = std::numbers::pi;

Eigen::Matrix4d random_rotation(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Eigen::Matrix4d entries;
    for (double& entry : entries.reshaped()) {
        entry = normal(random);
    }
    Eigen::Matrix4d rotation = Eigen::HouseholderQR<Eigen::Matrix4d>(entries).householderQ();
    if (rotation.determinant() < 0) {
        rotation.col(0) *= -1;
    }
    return rotation;
}

struct Case {
    const char* name;
    Solid solid;
    double hypervolume;  // by its closed form, m^4
    double edge_length;
};

std::vector<Case> smooth_cases() {
    return {{"ball", ball_solid(1), kPi * kPi / 2, 0.3},
            {"capsule", capsule_solid(0.6, 1), kPi * kPi / 2 * 0.1296 + 4 * kPi / 3 * 0.216, 0.25},
            {"spheritorus", spheritorus_solid(0.8, 0.35), 8 * kPi * kPi / 3 * 0.8 * 0.042875, 0.2},
            {"torisphere", torisphere_solid(0.8, 0.35),
             4 * kPi * kPi * 0.1225 * (0.64 + 0.1225 / 4), 0.25},
            {"tiger", tiger_solid({0.8, 0.7}, 0.35), 4 * kPi * kPi * kPi * 0.56 * 0.1225, 0.25},
            {"ditorus", ditorus_solid({0.9, 0.5}, 0.3), 4 * kPi * kPi * kPi * 0.45 * 0.09, 0.25},
            {"clifford torus", clifford_torus_solid(1, 0.7), kPi * kPi * kPi / 2 * 0.49, 0.25}};
}

std::vector<Case> sharp_cases() {
    const double root5 = std::sqrt(5.0);
    const auto fourth_power = [](double edge) { return edge * edge * edge * edge; };
    return {
        {"box", box_solid({1.2, 1, 0.8, 1.1}), 1.2 * 0.8 * 1.1, 0.2},
        {"spherinder", spherinder_solid(0.8, 1.2), 4 * kPi / 3 * 0.512 * 1.2, 0.25},
        {"cubinder", cubinder_solid(0.7, {1.2, 1}), kPi * 0.49 * 1.2, 0.25},
        {"duocylinder", duocylinder_solid({0.8, 0.7}), kPi * kPi * 0.64 * 0.49, 0.25},
        {"5-cell", polytope_solid(5, 1.5), root5 / 96 * fourth_power(1.5 * std::sqrt(2.5)), 0.2},
        {"8-cell", polytope_solid(8, 1), 1, 0.2},
        {"16-cell", polytope_solid(16, 1.2), fourth_power(1.2 * std::sqrt(2.0)) / 6, 0.25},
        {"24-cell", polytope_solid(24, 1), 2, 0.25},
        {"120-cell", polytope_solid(120, 1),
         15.0 / 4 * (105 + 47 * root5) * fourth_power(std::sqrt(2.0) / (3 + root5)), 0.3}};
}

// A mesh that may be written, whose boundary is a closed manifold of dimension 3.
void expect_sound(const SimplexMesh<4>& mesh, const char* name) {
    EXPECT_NO_THROW(validate(mesh, name));
    EXPECT_EQ(describe_faults(prove(mesh), 4), "") << name;
    const LinkReport links = check_links(mesh);
    EXPECT_EQ(links.faulty, 0) << name;
    EXPECT_EQ(links.unused_vertices, 0) << name;
}

void expect_quality(const SimplexMesh<4>& mesh, double least, double mean, const char* name) {
    const QualityReport quality = measure_quality(mesh);
    EXPECT_GE(quality.mean_ratio.min, least) << name;
    EXPECT_GE(quality.mean_ratio.mean, mean) << name;
}

TEST(Stuff, MakesSoundMeshesOfSmoothShapesAtAnyRotation) {
    unsigned seed = 0;
    for (const Case& c : smooth_cases()) {
        for (int i = 0; i < 2; ++i, ++seed) {
            const Solid turned = place(c.solid, 1, random_rotation(seed), Vector4d(0.1, 0.2, 0, 0));
            const StuffedSolid stuffed = stuff(turned, c.edge_length);
            expect_sound(stuffed.mesh, c.name);
            expect_quality(stuffed.mesh, 0.2, 0.78, c.name);
        }
    }
}

// The estimate knows the hypervolume alone. Along the boundary lattice cells become several pieces
// or none, and in bodies of a few edges most cells are there: twice as many or half of them, at the
// most.
TEST(Stuff, SaysAboutHowManyCellsItWillMake) {
    for (const Case& c : smooth_cases()) {
        const auto cells = static_cast<double>(stuff(c.solid, c.edge_length).mesh.cell_count());
        const double estimate = estimate_cells(c.solid, c.edge_length);
        EXPECT_GT(cells, 0.5 * estimate) << c.name;
        EXPECT_LT(cells, 2 * estimate) << c.name;
    }
    EXPECT_THROW(static_cast<void>(estimate_cells(ball_solid(1), 3)), Error);
}

TEST(Stuff, MakesSoundMeshesOfSharpShapesAtAnyRotation) {
    unsigned seed = 100;
    for (const Case& c : sharp_cases()) {
        const Solid turned = place(c.solid, 1, random_rotation(seed++), Vector4d(0, 0.1, 0, 0));
        const StuffedSolid stuffed = stuff(turned, c.edge_length);
        expect_sound(stuffed.mesh, c.name);
        expect_quality(stuffed.mesh, 0.1, 0.7, c.name);
    }
}

TEST(Stuff, HasHypervolumesOfSecondOrder) {
    // Chords cut off what is proportional to the square of their length: half of it leaves a
    // quarter, here within the scatter of where the lattice lies.
    for (const Case& c : smooth_cases()) {
        const double coarse = 1 - total_volume(stuff(c.solid, c.edge_length).mesh) / c.hypervolume;
        const double fine =
            1 - total_volume(stuff(c.solid, c.edge_length / 1.5).mesh) / c.hypervolume;
        EXPECT_GT(coarse, 0) << c.name;
        EXPECT_NEAR(coarse / fine, 2.25, 0.45) << c.name;
    }
}

TEST(Stuff, KeepsSharpRidges) {
    // Without them a bevel of about an edge would be missing along every ridge: some percents here.
    for (const Case& c : sharp_cases()) {
        const StuffedSolid stuffed = stuff(c.solid, c.edge_length);
        EXPECT_NEAR(total_volume(stuffed.mesh) / c.hypervolume, 1, 0.03) << c.name;
        const LinkReport links = check_links(stuffed.mesh);
        // A few in a thousand may stay: there cells would become too flat.
        EXPECT_LT(static_cast<double>(stuffed.beveled),
                  0.1 * static_cast<double>(links.boundary_vertices))
            << c.name;
    }
}

TEST(Stuff, PutsBoundaryVerticesOnTheSurface) {
    for (const Case& c : {smooth_cases()[4], sharp_cases()[3]}) {
        const StuffedSolid stuffed = stuff(c.solid, c.edge_length);
        std::int64_t off = 0;
        for (const auto& p : stuffed.mesh.positions.colwise()) {
            off += c.solid.value(p) > 1e-6 * c.edge_length ? 1 : 0;
        }
        // Cuts near points that had to leave the surface are off it.
        EXPECT_LE(off, 16 * stuffed.moved_back) << c.name;
    }
}

TEST(Stuff, MeshesWhatOperationsMake) {
    const Solid holed = subtract(box_solid({1.5, 1.5, 1.5, 1.5}), ball_solid(0.55));
    const StuffedSolid with_hole = stuff(holed, 0.25);
    expect_sound(with_hole.mesh, "box without a ball");
    EXPECT_NEAR(total_volume(with_hole.mesh), std::pow(1.5, 4) - kPi * kPi / 2 * std::pow(0.55, 4),
                0.1);
    const Solid apart =
        unite(ball_solid(0.5),
              place(ball_solid(0.5), 1, Eigen::Matrix4d::Identity(), Vector4d(2, 0, 0, 0)));
    expect_sound(stuff(apart, 0.25).mesh, "two balls");
    const Solid blended =
        unite(ball_solid(0.6),
              place(ball_solid(0.6), 1, Eigen::Matrix4d::Identity(), Vector4d(0.8, 0, 0, 0)), 0.3);
    expect_sound(stuff(blended, 0.25).mesh, "two balls, blended");
    const Solid formula = expression_solid("x^4 + y^4 + z^4 + w^4 - 0.5",
                                           {Vector4d::Constant(-1), Vector4d::Constant(1)});
    expect_sound(stuff(formula, 0.3).mesh, "formula");
}

TEST(Stuff, RepeatsItselfAtEveryStepOfTheLattice) {
    // All that decides is the same up to rounding of places.
    const StuffedSolid here = stuff(ball_solid(0.8), 0.3);
    const double spacing = 2 * 0.3 / (std::sqrt(0.8) + std::sqrt(1.2));
    const double lean = (1 - 1 / std::sqrt(5.0)) / 4;
    const Vector4d step = spacing * (Vector4d::Unit(1) - Vector4d::Constant(lean));
    const Solid moved = place(ball_solid(0.8), 1, Eigen::Matrix4d::Identity(), step);
    const StuffedSolid there = stuff(moved, 0.3);
    EXPECT_EQ(here.mesh.cell_count(), there.mesh.cell_count());
    EXPECT_NEAR(total_volume(here.mesh), total_volume(there.mesh), 1e-9);
}

std::string refusal(const Solid& solid, double edge_length) {
    try {
        (void)stuff(solid, edge_length);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(Stuff, SaysWhatCannotBeMeshed) {
    EXPECT_NE(refusal(half_space_solid({1, 0, 0, 0}, 0), 0.1).find("no bounds"), std::string::npos);
    EXPECT_NE(refusal(tiger_solid({1, 1}, 0.04), 0.1).find("at most 0.08 m"), std::string::npos);
    EXPECT_NE(refusal(ball_solid(1), 1e-12).find("too short"), std::string::npos);
    EXPECT_NE(refusal(ball_solid(1), 0).find("above 0"), std::string::npos);
    const Solid far = place(ball_solid(1), 1, Eigen::Matrix4d::Identity(), Vector4d(5, 0, 0, 0));
    EXPECT_NE(refusal(intersect(ball_solid(1), far), 0.3).find("empty"), std::string::npos);
    EXPECT_NE(refusal(subtract(ball_solid(1), ball_solid(2)), 0.3).find("empty"),
              std::string::npos);
    const Solid broken =
        expression_solid("sqrt(x)", {Vector4d::Constant(-1), Vector4d::Constant(1)});
    EXPECT_NE(refusal(broken, 0.3).find("not a number at"), std::string::npos);
}

TEST(StarMesh, SplitsASimplexIntoPiecesThatFillIt) {
    SimplexMesh<4> simplex;
    simplex.positions.setZero(4, 5);
    simplex.positions.rightCols<4>().setIdentity();
    simplex.cells.resize(5, 1);
    simplex.cells.col(0) << 0, 1, 2, 3, 4;
    for (const std::vector<std::uint32_t>& part :
         {std::vector<std::uint32_t>{0, 1}, {1, 2, 4}, {0, 1, 2, 3}}) {
        StarMesh mesh(simplex);
        Vector4d middle = Vector4d::Zero();
        for (const std::uint32_t corner : part) {
            middle += mesh.place(corner) / static_cast<double>(part.size());
        }
        const double foreseen = mesh.quality_if_split(part, middle);
        const std::uint32_t added = mesh.split(part, middle);
        EXPECT_EQ(mesh.cell_count(), part.size());
        EXPECT_EQ(mesh.star(added).size(), part.size());
        EXPECT_TRUE(mesh.star(part).empty());
        EXPECT_NEAR(total_volume(mesh.mesh()), 1.0 / 24, 1e-16);
        double least = 1;
        for (std::uint32_t cell = 0; cell < mesh.cell_count(); ++cell) {
            least = std::min(least, mesh.quality(cell));
            for (const std::uint32_t corner : mesh.cell(cell)) {
                const auto& star = mesh.star(corner);
                EXPECT_EQ(std::count(star.begin(), star.end(), cell), 1);
            }
        }
        EXPECT_DOUBLE_EQ(least, foreseen);
    }
}

TEST(StarMesh, HasTheSlopeOfQuality) {
    SimplexMesh<4> simplex;
    simplex.positions.setZero(4, 5);
    simplex.positions.rightCols<4>() << 1, 0.2, 0.1, -0.3, 0, 0.9, 0.4, 0.2, 0.1, 0, 1.1, 0.3, 0, 0,
        -0.2, 0.8;
    simplex.cells.resize(5, 1);
    simplex.cells.col(0) << 0, 1, 2, 3, 4;
    const StarMesh mesh(simplex);
    for (std::uint32_t vertex = 0; vertex < 5; ++vertex) {
        const Vector4d slope = mesh.quality_slope(0, vertex);
        for (int axis = 0; axis < 4; ++axis) {
            const Vector4d step = 1e-5 * Vector4d::Unit(axis);
            const double after = mesh.quality_if_moved(vertex, mesh.place(vertex) + step).sum;
            const double before = mesh.quality_if_moved(vertex, mesh.place(vertex) - step).sum;
            // Differences of second order, of slopes of about 1.
            EXPECT_NEAR(slope[axis], std::log(after / before) / 2e-5, 1e-8);
        }
    }
}

TEST(StarMesh, CountsAChangeExactlyWhereACellAroundAVertexChanges) {
    const Solid solid = ball_solid(1);
    const LatticeTree tree(solid, Lattice::with_mean_edge(0.5), {});
    LatticeStuffing stuffing(solid, tree);
    StarMesh mesh(stuffing.mesh().mesh);
    const auto cells_around = [&](std::uint32_t vertex) {
        std::vector<std::array<Vector4d, 5>> cells;
        for (const std::uint32_t cell : mesh.star(vertex)) {
            std::array<Vector4d, 5>& corners = cells.emplace_back();
            for (int i = 0; i < 5; ++i) {
                corners[i] = mesh.place(mesh.cell(cell)[i]);
            }
        }
        return cells;
    };
    const std::uint32_t vertex = mesh.cell(mesh.cell_count() / 2)[2];
    const std::vector<std::uint32_t> edge = {mesh.cell(10)[0], mesh.cell(10)[3]};
    const std::vector<std::function<void()>> acts = {
        [&] { mesh.move(vertex, mesh.place(vertex) + Vector4d::Constant(1e-3)); },
        [&] { mesh.split(edge, (mesh.place(edge[0]) + mesh.place(edge[1])) / 2); }};
    for (const auto& act : acts) {
        std::vector<std::vector<std::array<Vector4d, 5>>> cells;
        std::vector<std::uint32_t> changes;
        for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
            cells.push_back(cells_around(v));
            changes.push_back(mesh.change(v));
        }
        act();
        int changed = 0;
        for (std::uint32_t v = 0; v < cells.size(); ++v) {
            EXPECT_EQ(mesh.change(v) != changes[v], cells_around(v) != cells[v]) << v;
            changed += mesh.change(v) != changes[v] ? 1 : 0;
        }
        EXPECT_GT(changed, 5);
        EXPECT_LT(changed, static_cast<int>(cells.size()) / 2);
    }
}

TEST(Smooth, MakesCellsBetterAndKeepsWhatTheirVerticesLieOn) {
    for (const Case& c : {sharp_cases()[4], sharp_cases()[3]}) {
        const LatticeTree tree(c.solid, Lattice::with_mean_edge(c.edge_length), {});
        LatticeStuffing stuffing(c.solid, tree);
        SurfaceMesh surface = on_surface(c.solid, c.edge_length, stuffing.mesh());
        (void)sharpen(surface, 0.12);
        const SimplexMesh<4> before = surface.mesh.mesh();
        const double volume = total_volume(before);
        smooth(surface, 0.3);
        const SimplexMesh<4> after = surface.mesh.mesh();
        const QualityReport was = measure_quality(before);
        const QualityReport is = measure_quality(after);
        EXPECT_GT(is.mean_ratio.mean, was.mean_ratio.mean + 0.01) << c.name;
        EXPECT_GE(is.mean_ratio.min, std::min(was.mean_ratio.min, 0.3)) << c.name;
        // Chords differ by where their ends are on curved sides, and by what was beveled.
        EXPECT_NEAR(total_volume(after), volume, 0.01 * volume) << c.name;
        for (std::uint32_t v = 0; v < surface.mesh.vertex_count(); ++v) {
            for (const int piece : surface.pieces[v]) {
                EXPECT_NEAR(c.solid.piece_value(piece, surface.mesh.place(v)), 0,
                            2e-6 * c.edge_length)
                    << c.name;
            }
        }
    }
}

TEST(SurfaceSearch, FindsTheZeroBetweenTwoPoints) {
    const Solid ball = ball_solid(1);
    const Vector4d from(0.2, 0.1, 0, 0);
    const Vector4d to(0.9, 0.9, 0.3, 0);
    const double t = zero_between(ball, {from, ball.value(from)}, {to, ball.value(to)});
    EXPECT_NEAR((from + t * (to - from)).norm(), 1, 1e-11);
}

TEST(SurfaceSearch, FindsWherePiecesMeet) {
    const Solid duocylinder = duocylinder_solid({0.8, 0.7});
    const std::vector<int> both = {0, 1};
    const auto place = nearest_common_zero(duocylinder, both, {0.7, 0.1, 0.1, 0.6}, 0.2);
    ASSERT_TRUE(place.has_value());
    EXPECT_NEAR(place->head<2>().norm(), 0.8, 1e-9);
    EXPECT_NEAR(place->tail<2>().norm(), 0.7, 1e-9);
}

TEST(SurfaceSearch, FindsCornersOfAnyNumberOfPieces) {
    // Six octahedra of a 24-cell meet in a vertex, twenty tetrahedra of a 600-cell.
    for (const int cells : {24, 600}) {
        const Solid polytope = polytope_solid(cells, 1);
        const Vector4d corner =
            cells == 24 ? Vector4d(1, 1, 0, 0) / std::sqrt(2.0) : Vector4d(1, 1, 1, 1) / 2;
        const std::vector<int> pieces = polytope.pieces_near(corner, 1e-9);
        EXPECT_EQ(pieces.size(), cells == 24 ? 6U : 20U);
        const auto place =
            nearest_common_zero(polytope, pieces, corner + Vector4d(0.02, -0.01, 0.03, 0.01), 0.2);
        ASSERT_TRUE(place.has_value());
        EXPECT_NEAR((*place - corner).norm(), 0, 1e-10);
    }
}

}  // namespace
}  // namespace pent::mesher
