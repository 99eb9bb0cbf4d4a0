// Edge-based smoothed elements: what holds for them and not for linear ones, and that the rest of a
// simulation takes them as it takes those. Their kernels are tested in kernels_test.cpp.

#include "potentials/smoothing.h"

#include "contact_scenes.h"
#include "elastic_box.h"
#include "scenes.h"

#include <pent/simulator/simulation.h>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <random>
#include <set>

namespace pent::simulator {
namespace {

using test::ElasticBox;

template <int Dim>
SmoothingDomains<Dim> domains_of(const SimplexMesh<Dim>& mesh) {
    return smoothing_domains<Dim>(mesh.positions, mesh.cells, 0, mesh.cell_count());
}

// A box whose inner structure is irregular.
template <int Dim>
SimplexMesh<Dim> crooked_box(const std::array<int, Dim>& count) {
    std::array<double, Dim> size{};
    size.fill(1);
    SimplexMesh<Dim> mesh = pent::test::kuhn_box<Dim>(count, size);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shift(-0.04, 0.04);
    mesh.positions = mesh.positions.unaryExpr([&](double x) { return x + shift(random); });
    return mesh;
}

template <int Dim>
SimplexMesh<Dim> one_simplex() {
    SimplexMesh<Dim> mesh;
    mesh.positions.setZero(Dim, Dim + 1);
    mesh.positions.template rightCols<Dim>().setIdentity();
    mesh.positions(0, 1) = 1.3;
    mesh.positions(1, 1) = 0.2;
    mesh.cells.resize(Dim + 1, 1);
    for (int a = 0; a <= Dim; ++a) {
        mesh.cells(a, 0) = static_cast<std::uint32_t>(a);
    }
    return mesh;
}

template <int Dim>
std::int64_t edge_count(const SimplexMesh<Dim>& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        for (int a = 0; a <= Dim; ++a) {
            for (int b = 0; b < a; ++b) {
                edges.insert(std::minmax(mesh.cells(a, cell), mesh.cells(b, cell)));
            }
        }
    }
    return static_cast<std::int64_t>(edges.size());
}

template <int Dim>
void expect_affine_maps_exact(const SimplexMesh<Dim>& mesh) {
    const SmoothingDomains<Dim> domains = domains_of(mesh);
    EXPECT_EQ(domains.count(), edge_count(mesh));
    double volume = 0;
    Eigen::Matrix<double, Dim, Dim> A = Eigen::Matrix<double, Dim, Dim>::Random();
    for (Eigen::Index d = 0; d < domains.count(); ++d) {
        const auto i = static_cast<std::size_t>(d);
        Eigen::Matrix<double, Dim, Dim> F = Eigen::Matrix<double, Dim, Dim>::Zero();
        for (std::int64_t k = domains.start[i]; k < domains.start[i + 1]; ++k) {
            F += A * mesh.positions.col(domains.corners[static_cast<std::size_t>(k)])
                 * domains.gradients.col(k).transpose();
        }
        EXPECT_LT((F - A).norm(), 1e-13);
        EXPECT_GT(domains.volumes[i], 0);
        volume += domains.volumes[i];
    }
    EXPECT_NEAR(volume, total_volume(mesh), 1e-14);
}

TEST(SmoothingDomains, ShareTheVolumeAndSeeAffineMapsExactly) {
    expect_affine_maps_exact(one_simplex<3>());
    expect_affine_maps_exact(one_simplex<4>());
    expect_affine_maps_exact(crooked_box<3>({3, 2, 2}));
    expect_affine_maps_exact(crooked_box<4>({2, 2, 1, 2}));
}

TEST(SmoothingDomains, AreMadeOfTheCellsAskedForAlone) {
    const SimplexMesh<4> mesh = crooked_box<4>({2, 1, 1, 1});
    const Eigen::Index half = mesh.cell_count() / 2;
    SimplexMesh<4> part = mesh;
    part.cells = mesh.cells.rightCols(mesh.cell_count() - half);
    const SmoothingDomains<4> some =
        smoothing_domains<4>(mesh.positions, mesh.cells, half, mesh.cell_count());
    const SmoothingDomains<4> all = domains_of(part);
    EXPECT_EQ(some.corners, all.corners);
    EXPECT_EQ(some.gradients, all.gradients);
    EXPECT_EQ(some.volumes, all.volumes);
}

// A domain of a single simplex is that simplex.
TEST(SmoothedBody, OfOneSimplexIsTheLinearOne) {
    const SimplexMesh<4> mesh = one_simplex<4>();
    Scene scene = test::box_scene<4>();
    scene.gravity[1] = -9.8;
    scene.bodies[0].spin = {{.plane = {0, 3}, .degrees_per_s = 300}};
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-12;
    scene.solver.newton_tolerance = 1e-10;
    Simulation<4> linear(scene, {mesh});
    scene.solver.elements = ElementKind::Smoothed;
    Simulation<4> smoothed(scene, {mesh});
    for (int step = 0; step < 5; ++step) {
        ASSERT_TRUE(linear.step().is_accepted);
        ASSERT_TRUE(smoothed.step().is_accepted);
    }
    EXPECT_LT((linear.positions(0) - smoothed.positions(0)).norm(), 1e-10);
    EXPECT_NEAR(linear.energies().of("elastic"), smoothed.energies().of("elastic"),
                1e-9 * linear.energies().of("elastic"));
}

// Jensen's inequality for a convex energy: a mean deforms less than its parts.
TEST(SmoothedBody, HasNeverMoreEnergyThanALinearOneWhereTheEnergyIsConvex) {
    const Material material{.model = Model::Linear, .lame = {.lambda = 1.3, .mu = 0.7}};
    ElasticBox<4> linear(material);
    const ElasticBox<4> smoothed(material, {}, ElementKind::Smoothed);
    Positions<4> unused;
    for (unsigned seed = 0; seed < 20; ++seed) {
        linear.scramble(0.1, seed);
        const double most = linear.forces(best_isa(), linear.positions, unused).energy;
        const double energy = smoothed.forces(best_isa(), linear.positions, unused).energy;
        EXPECT_LT(energy, most);
        EXPECT_GT(energy, 0);
    }
}

// Motions that cost no energy at rest: the rigid ones and no other.
template <int Dim>
void expect_rigid_modes_alone(const SimplexMesh<Dim>& mesh) {
    std::vector<std::uint32_t> own;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        own.push_back(v);
    }
    const DofMap dofs =
        number_dofs<Dim>(mesh.cells, std::vector<bool>(own.size(), false), {own, own});
    const std::vector<CellRange> ranges = {
        {0, mesh.cell_count(), Material{.lame = {.lambda = 1.3, .mu = 0.7}}}};
    const auto [pattern, elements] =
        lay_out_elements<Dim>(mesh.positions, mesh.cells, ranges, dofs, ElementKind::Smoothed);
    BlockMatrix<Dim, double> K(pattern);
    elements.add_hessian(Workers(1), kernels<Dim>(best_isa()), mesh.positions,
                         target_in(K, 1, Filter::None));
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(ElasticBox<Dim>::dense(K)).eigenvalues();
    constexpr int kRigid = Dim * (Dim + 1) / 2;
    EXPECT_LT(values.head(kRigid).cwiseAbs().maxCoeff(), 1e-12 * values.maxCoeff());
    EXPECT_GT(values[kRigid], 1e-4 * values.maxCoeff());
}

TEST(SmoothedBody, GivesWayToRigidMotionsAndNoOthers) {
    expect_rigid_modes_alone(one_simplex<3>());
    expect_rigid_modes_alone(one_simplex<4>());
    expect_rigid_modes_alone(crooked_box<3>({1, 1, 1}));
    expect_rigid_modes_alone(crooked_box<3>({4, 2, 2}));
    expect_rigid_modes_alone(crooked_box<4>({1, 1, 1, 1}));
    expect_rigid_modes_alone(crooked_box<4>({3, 2, 2, 1}));
}

// A beam four times as long as thick sags under its own weight by q L^4 / 8 E I + q L^2 / 2 k G A,
// k = 5/6 (Timoshenko); here over that.
double sag(ElementKind kind, double poisson, int across) {
    constexpr double kYoung = 1e6;
    const SimplexMesh<4> mesh =
        pent::test::kuhn_box<4>({4 * across, across, across, 1}, {4, 1, 1, 1.0 / across});
    Scene scene = test::box_scene<4>();
    scene.gravity[1] = -1;
    scene.bodies[0].material.model = Model::Linear;
    scene.bodies[0].material.lame = lame_from_young(4, kYoung, poisson);
    scene.bodies[0].material.density = 1;
    scene.constraints = {test::hold(
        HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6}, test::still(4))};
    scene.solver.integrator = Integrator::Quasistatic;
    scene.solver.elements = kind;
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-8;
    scene.solver.newton_tolerance = 1e-6;
    Simulation<4> simulation(scene, {mesh});
    EXPECT_TRUE(simulation.step().is_accepted);
    const Positions<4> shift = simulation.positions(0) - mesh.positions;
    double down = 0;
    int count = 0;
    for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
        if (mesh.positions(0, v) == 4) {
            down -= shift(1, v);
            ++count;
        }
    }
    const double by_shear = 16 * 2 * (1 + poisson) / (2 * 5.0 / 6);
    return down / count * kYoung / (256.0 * 12 / 8 + by_shear);
}

// What docs/simulator.md promises. Never less than linear ones: they have no more energy at any
// bend.
TEST(SmoothedBody, BendsBetterThanALinearOneOfTwiceTheCellsAcross) {
    for (const double poisson : {0.0, 0.28, 0.32}) {
        const double smoothed = sag(ElementKind::Smoothed, poisson, 2);
        EXPECT_GT(smoothed, sag(ElementKind::Linear, poisson, 2)) << poisson;
        EXPECT_LT(std::abs(1 - smoothed), 1 - sag(ElementKind::Linear, poisson, 4)) << poisson;
        EXPECT_LT(std::abs(1 - sag(ElementKind::Smoothed, poisson, 4)), std::abs(1 - smoothed));
    }
}

Scene swinging_bar(ElementKind kind) {
    Scene scene = test::box_scene<4>();
    scene.gravity[1] = -9.8;
    scene.solver.elements = kind;
    scene.constraints = {test::hold(
        HalfSpaceSelection{.normal = Eigen::Vector4d(1, 0, 0, 0), .offset = 1e-6}, test::still(4))};
    return scene;
}

TEST(SmoothedBody, IsTheSameToTheBitForAnyNumberOfThreads) {
    Scene scene = swinging_bar(ElementKind::Smoothed);
    scene.solver.integrator = Integrator::Bdf2;
    scene.damping = Damping{.mass = 0.1, .stiffness = 0.01};
    Positions<4> of_one;
    for (const int threads : {1, 2, 3, 8}) {
        Simulation<4> simulation(scene, {test::bar(12)}, {.threads = threads});
        for (int step = 0; step < 4; ++step) {
            ASSERT_TRUE(simulation.step().is_accepted);
        }
        if (threads == 1) {
            of_one = simulation.positions(0);
        }
        EXPECT_EQ(simulation.positions(0), of_one) << threads;
    }
}

// Cells are not assembled beside the domains, nor domains where they are not asked for.
TEST(Elements, AreCellsOrEdgesAndNeverBoth) {
    const SimplexMesh<4> mesh = test::bar();
    Scene scene = swinging_bar(ElementKind::Linear);
    scene.constraints.clear();
    Simulation<4> linear(scene, {mesh});
    EXPECT_EQ(linear.size().elements, mesh.cell_count());
    EXPECT_EQ(linear.step().hessians, mesh.cell_count());
    scene.solver.elements = ElementKind::Smoothed;
    Simulation<4> smoothed(scene, {mesh});
    EXPECT_EQ(smoothed.size().elements, edge_count(mesh));
    EXPECT_EQ(smoothed.step().hessians, edge_count(mesh));
}

// An edge is not inside out where one of its cells is; the report counts cells.
TEST(SmoothedBody, ReportsEveryCellThatIsInsideOut) {
    Scene scene = swinging_bar(ElementKind::Smoothed);
    scene.frames_per_second = 1e6;  // so that a step hardly moves anything
    Simulation<4> simulation(scene, {test::bar()}, {.threads = 2});
    const SimplexMesh<4>& mesh = simulation.mesh(0);
    EXPECT_EQ(simulation.step().inverted, 0);
    Positions<4> positions = mesh.positions;
    positions.col(mesh.vertex_count() / 2) += Eigen::Vector4d(0.3, -0.3, 0, 0);
    simulation.set_state(0, positions, Positions<4>::Zero(4, mesh.vertex_count()));
    const StepReport report = simulation.step();
    ASSERT_TRUE(report.is_accepted);
    std::int64_t inverted = 0;
    for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
        inverted += cell_volume<4>(simulation.positions(0), mesh.cells, cell) > 0 ? 0 : 1;
    }
    EXPECT_GT(inverted, 0);
    EXPECT_EQ(report.inverted, inverted);
}

}  // namespace
}  // namespace pent::simulator
