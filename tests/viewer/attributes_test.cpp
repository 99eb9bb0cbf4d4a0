#include "pent/viewer/attributes.h"

#include "meshes.h"

#include <pent/geometry.h>
#include <pent/viewer/coloring.h>
#include <pent/viewer/slice.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string_view>
#include <support/messages.h>

namespace pent::viewer {
namespace {

using pent::test::kuhn_box;

TEST(VertexStrain, IsZeroAtEveryRigidMotion) {
    const SimplexMesh<4> mesh = test::jittered_box({2, 2, 2, 2}, 1);
    const PlaneRotation turns[] = {{0, 3, 1.1}, {1, 2, -2.0}, {2, 3, 0.4}};
    Positions<4> moved = rotation_matrix(turns) * mesh.positions;
    moved.colwise() += Eigen::Vector4d(3, -1, 2, 5);
    EXPECT_EQ(vertex_strain<4>(mesh, moved).maxCoeff(), 0);
    // Far away coordinates have fewer digits behind the point: 5e4 eps is 1e-11.
    moved.colwise() += Eigen::Vector4d(3e4, 0, 5e4, 0);
    EXPECT_EQ(vertex_strain<4>(mesh, moved).maxCoeff(), 0);
}

TEST(VertexStrain, IsSeenAboveTheRoundingOfCoordinates) {
    const SimplexMesh<4> mesh = test::jittered_box({2, 2, 2, 2}, 1);
    Positions<4> moved = mesh.positions;
    moved.row(1) *= 1 + 1e-12;
    EXPECT_NEAR(vertex_strain<4>(mesh, moved).minCoeff(), 1e-12, 2e-14);
}

TEST(VertexStrain, OfAUniformStretchIsThatOfItsMatrix) {
    // F = diag(1.2, 1, 1, 1): E has the one entry (1.44 - 1) / 2 = 0.22.
    const SimplexMesh<4> mesh = test::jittered_box({2, 1, 1, 2}, 2);
    Positions<4> moved = mesh.positions;
    moved.row(0) *= 1.2;
    const Eigen::VectorXd strain = vertex_strain<4>(mesh, moved);
    EXPECT_NEAR(strain.minCoeff(), 0.22, 1e-13);
    EXPECT_NEAR(strain.maxCoeff(), 0.22, 1e-13);
}

TEST(VertexForce, IsTheLengthOfTheContactForce) {
    const Body<4> body;
    Frame<4> frame;
    frame.positions = Positions<4>::Zero(4, 2);
    EXPECT_TRUE(lacks(body, frame, ColorBy::Force));
    frame.contact_forces.resize(4, 2);
    frame.contact_forces.col(0) << 1, 1, 1, 1;
    frame.contact_forces.col(1) << 0, 3, 0, 4;
    EXPECT_FALSE(lacks(body, frame, ColorBy::Force));
    EXPECT_EQ(vertex_force<4>(frame), Eigen::Vector2d(2, 5));
}

TEST(VertexSpeed, IsTheLengthOfTheVelocityOrZeroWithoutOne) {
    Frame<4> frame;
    frame.positions.setZero(4, 2);
    frame.velocities.resize(4, 0);
    EXPECT_EQ(vertex_speed<4>(frame), Eigen::VectorXd::Zero(2));
    frame.velocities.resize(4, 2);
    frame.velocities << 1, 0, 1, 0, 1, 3, 1, 4;
    EXPECT_EQ(vertex_speed<4>(frame), Eigen::Vector2d(2, 5));
}

TEST(CornerNormals, OfABoxAreItsSidesInSpiteOfSliversAndZeroAreas) {
    const SimplexMesh<4> mesh = kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1});
    const Boundary<4> boundary = make_boundary(mesh, "box");
    for (const double w : {0.3, 0.5, 0.5 + 1e-15, 1.0}) {
        const FramedHyperplane plane = hyperplane_at(w);
        const Surface surface = slice(boundary, mesh.positions, plane);
        const Positions<3> normals =
            corner_normals<4>(surface, boundary, mesh.positions, plane.frame.topRows<3>(), 1.0);
        for (Eigen::Index t = 0; t < surface.triangle_count(); ++t) {
            const auto corners = surface.positions(Eigen::all, surface.triangles.col(t));
            const Eigen::Vector3d a = corners.col(1) - corners.col(0);
            const Eigen::Vector3d b = corners.col(2) - corners.col(0);
            const Eigen::Vector3d flat = a.cross(b);
            if (flat.norm() < 1e-10) {
                continue;
            }
            for (int k = 0; k < 3; ++k) {
                // Sides meet at right angles, beyond the crease, so nothing is mixed in.
                EXPECT_NEAR(normals.col(3 * t + k).dot(flat.normalized()), 1, 1e-12);
            }
        }
    }
}

// Corner by corner, over all facets of the body: of slices with two triangles in a facet, and of
// one through vertices, whose corners lie on edges of other facets once they are merged.
void expect_normals_by_definition(const SimplexMesh<4>& mesh, const FramedHyperplane& plane) {
    const double crease = 0.7;
    const Boundary<4> boundary = make_boundary(mesh, "body");
    Eigen::Matrix<double, 4, Eigen::Dynamic> normals_of_facets(4, boundary.facets.cols());
    for (Eigen::Index facet = 0; facet < boundary.facets.cols(); ++facet) {
        Eigen::Matrix4d corners;
        for (int k = 0; k < 4; ++k) {
            corners.col(k) = mesh.positions.col(boundary.facets(k, facet));
        }
        normals_of_facets.col(facet) = facet_normal<4>(corners);
    }
    const auto smooth = [&](std::uint32_t of, std::uint32_t vertex) {
        const Eigen::Vector4d own = normals_of_facets.col(of).normalized();
        Eigen::Vector4d sum = Eigen::Vector4d::Zero();
        for (Eigen::Index facet = 0; facet < boundary.facets.cols(); ++facet) {
            const Eigen::Vector4d other = normals_of_facets.col(facet);
            if ((boundary.facets.col(facet).array() == vertex).any()
                && std::acos(std::min(1.0, own.dot(other.normalized()))) <= crease) {
                sum += other;
            }
        }
        return Eigen::Vector4d(sum.stableNormalized());
    };
    const Surface surface = merge_coincident(slice(boundary, mesh.positions, plane));
    const Eigen::Matrix<double, 3, 4> axes = plane.frame.topRows<3>();
    const Positions<3> normals = corner_normals<4>(surface, boundary, mesh.positions, axes, crease);
    ASSERT_GT(normals.cols(), 0);
    Eigen::Index compared = 0;
    for (Eigen::Index i = 0; i < normals.cols(); ++i) {
        const std::uint32_t v = surface.triangles(i % 3, i / 3);
        const std::uint32_t facet = surface.facets[static_cast<std::size_t>(i / 3)];
        const double s = surface.weights[v];
        const Eigen::Vector3d expected =
            axes
            * ((1 - s) * smooth(facet, surface.ends(0, v)) + s * smooth(facet, surface.ends(1, v)));
        if (normals.col(i).dot(expected) > 0) {  // else that of the triangle
            EXPECT_LT((normals.col(i) - expected.normalized()).norm(), 1e-12) << i;
            ++compared;
        }
    }
    EXPECT_GT(compared, normals.cols() / 2);
}

TEST(CornerNormals, AreWhatTheirDefinitionSays) {
    expect_normals_by_definition(test::jittered_box({2, 2, 2, 2}, 5),
                                 hyperplane_across({0.2, 0.3, -0.1, 1}, 0.4));
    expect_normals_by_definition(kuhn_box<4>({2, 2, 2, 2}, {1, 1, 1, 1}), hyperplane_at(0.5));
}

TEST(CornerNormals, OfAFineBallPointAwayFromItsCenter) {
    // A box pressed onto a sphere: each vertex moves along its ray from the center.
    SimplexMesh<4> mesh = kuhn_box<4>({8, 8, 8, 8}, {2, 2, 2, 2});
    mesh.positions.array() -= 1;
    for (auto point : mesh.positions.colwise()) {
        const double largest = point.cwiseAbs().maxCoeff();
        point *= largest > 0 ? largest / point.norm() : 0;
    }
    const Boundary<4> boundary = make_boundary(mesh, "ball");
    const FramedHyperplane plane = hyperplane_across({0.2, 0.3, -0.1, 1}, 0.2);
    const Surface surface = slice(boundary, mesh.positions, plane);
    const Positions<3> normals =
        corner_normals<4>(surface, boundary, mesh.positions, plane.frame.topRows<3>(), 1.0);
    double worst = 1;
    for (Eigen::Index t = 0; t < surface.triangle_count(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const Eigen::Vector3d out = surface.positions.col(surface.triangles(k, t)).normalized();
            worst = std::min(worst, normals.col(3 * t + k).dot(out));
        }
    }
    // The surface has facets about 0.25 across on a ball of radius 1: their normals lean by up to
    // half of that, an eighth of a radian, and averages over uneven neighborhoods no more.
    EXPECT_GT(worst, std::cos(0.2));
}

TEST(VertexValues, AreHeightsOverTheBaseSpaceForW) {
    const SimplexMesh<4> mesh = test::jittered_box({1, 1, 1, 1}, 3);
    Body<4> body;
    body.name = "box";
    body.mesh = mesh;
    Frame<4> frame;
    frame.positions = mesh.positions;
    frame.frame = 7;
    EXPECT_EQ(vertex_values<4>(body, frame, ColorBy::W), mesh.positions.row(3).transpose());
    EXPECT_EQ(vertex_values<4>(body, frame, ColorBy::Body), Eigen::VectorXd::Zero(16));
    pent::test::expect_contains(
        pent::test::error_of([&] { (void)vertex_values<4>(body, frame, ColorBy::Force); }),
        {"frame 7 of \"box\"", "no contact forces", "[output] vertex = [\"contact_force\"]"});
    frame.contact_forces = mesh.positions;
    EXPECT_EQ(vertex_values<4>(body, frame, ColorBy::Force), vertex_force<4>(frame));
    pent::test::expect_contains(
        pent::test::error_of([&] { (void)vertex_values<4>(body, frame, ColorBy::Reaction); }),
        {"frame 7 of \"box\"", "no reaction", "[output] vertex = [\"reaction\"]"});
    frame.fields = {{"energy_density", Eigen::RowVectorXd::LinSpaced(16, 0, 3)},
                    {"reaction", 2 * mesh.positions}};
    EXPECT_EQ(vertex_values<4>(body, frame, ColorBy::Reaction), 2 * vertex_force<4>(frame));
    EXPECT_EQ(vertex_values<4>(body, frame, ColorBy::EnergyDensity),
              Eigen::VectorXd::LinSpaced(16, 0, 3));
    // In three dimensions nothing has a height.
    Frame<3> flat;
    flat.positions = Positions<3>::Ones(3, 5);
    EXPECT_EQ(vertex_values<3>(Body<3>(), flat, ColorBy::W), Eigen::VectorXd::Zero(5));
}

TEST(ColorBy, HasANameOfItsOwnAndATitleWithItsUnit) {
    std::set<std::string> names;
    std::set<std::string> titles;
    for (const ColorBy& by : all_colorings()) {
        const std::string title = title_of(by, 4);
        names.insert(name_of(by));
        titles.insert(title);
        EXPECT_EQ(title.empty(), by == ColorBy::Body);
        EXPECT_TRUE(by == ColorBy::Body || title.find(name_of(by)) != std::string::npos);
        EXPECT_EQ(title == title_of(by, 3), by != ColorBy::EnergyDensity);  // J/m^3 or J/m^4
    }
    EXPECT_EQ(names.size(), 7U);
    EXPECT_EQ(titles.size(), 7U);
}

TEST(SuitableRange, OfHeightsHasTheLowestAndTheHighest) {
    const ColorRange range = suitable_range(Eigen::Vector3d(-2, 5, 1), ColorBy::W);
    EXPECT_EQ(range.low, -2);
    EXPECT_EQ(range.high, 5);
}

TEST(SuitableRange, LeavesOutTheUpmostHundredth) {
    Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(1001, 0, 1);
    values[1000] = 1e6;
    const ColorRange range = suitable_range(values, ColorBy::Strain);
    EXPECT_EQ(range.low, 0);
    EXPECT_NEAR(range.high, 0.99, 1e-12);
}

TEST(ColorRange, PlacesWhatIsAllEqualInTheMiddleOfTwoSidesOrAtTheBeginning) {
    EXPECT_EQ((ColorRange{3, 3}.place(3, ColorBy::W)), 0.5);
    EXPECT_EQ((ColorRange{0, 0}.place(0, ColorBy::Strain)), 0);
    EXPECT_EQ((ColorRange{2, 4}.place(3.5, ColorBy::W)), 0.75);
    EXPECT_EQ((ColorRange{2, 4}.place(3.5, ColorBy::Strain)), 0.75);
}

TEST(SurfaceColors, AreThoseOfZeroWhereNothingIsStrained) {
    const Eigen::Matrix3Xf colors =
        surface_colors(Eigen::VectorXd::Zero(2), ColorBy::Strain, {0, 0}, 0);
    EXPECT_EQ(colors.col(0), map_color(ColorMap::Heat, 0));
}

TEST(Color, SrgbReturnsToItself) {
    for (int i = 0; i < 256; ++i) {
        const float s = static_cast<float>(i) / 255.0F;
        EXPECT_EQ(to_srgb(from_srgb(s, s, s))[1], i);
    }
    EXPECT_EQ(to_srgb(Color(-1, 2, 0.5F)), (std::array<std::uint8_t, 3>{0, 255, 188}));
}

TEST(Color, OklchWithoutChromaIsGray) {
    for (const float lightness : {0.0F, 0.3F, 1.0F}) {
        const Color gray = from_oklch(lightness, 0, 123);
        // Oklab's lightness of a gray is the cube root of its light; its matrix has ten digits.
        EXPECT_NEAR(gray.minCoeff(), std::pow(lightness, 3.0F), 1e-5F);
        EXPECT_NEAR(gray.maxCoeff(), std::pow(lightness, 3.0F), 1e-5F);
    }
}

}  // namespace
}  // namespace pent::viewer
