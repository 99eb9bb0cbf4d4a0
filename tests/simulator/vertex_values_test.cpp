#include "muscle.h"
#include "potential_laws.h"

#include <pent/geometry.h>
#include <pent/simulator/energy.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

// What frames may have of every vertex: Simulation::vertex_values().

namespace pent::simulator {
namespace {

using test::cube;

template <typename T>
class VertexValuesTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(VertexValuesTest, Dimensions);

// A cube that hangs from one side, a load at the other.
template <int Dim>
Scene hanging_cube() {
    Scene scene = test::box_scene<Dim>();
    scene.solver.integrator = Integrator::Quasistatic;
    scene.solver.precision = Precision::Double;
    scene.solver.tolerance = 1e-10;
    scene.solver.newton_tolerance = 1e-10;
    scene.gravity[1] = -9.8;
    const HalfSpaceSelection top{.normal = -Eigen::VectorXd::Unit(Dim, 1), .offset = -0.49};
    const HalfSpaceSelection bottom{.normal = Eigen::VectorXd::Unit(Dim, 1), .offset = 0.01};
    scene.constraints = {test::hold(top, test::still(Dim))};
    scene.loads = {{.body = "box",
                    .select = {bottom},
                    .force = 30 * Eigen::VectorXd::Unit(Dim, 0),
                    .keyframes = {}}};
    return scene;
}

// Elastic forces add up to zero, so what holds the body carries its weight and its load.
TYPED_TEST(VertexValuesTest, HaveReactionsThatCarryWeightAndLoad) {
    constexpr int kDim = TypeParam::value;
    const Scene scene = hanging_cube<kDim>();
    Simulation<kDim> simulation(scene, {cube<kDim>()});
    ASSERT_TRUE(simulation.step().is_accepted);
    const Eigen::MatrixXd reaction = simulation.vertex_values(VertexQuantity::Reaction, 0);
    ASSERT_EQ(reaction.rows(), kDim);
    const Eigen::VectorXd outside =
        simulation.masses(0).sum() * scene.gravity + scene.loads[0].force;
    EXPECT_LT((reaction.rowwise().sum() + outside).norm(), 1e-8 * outside.norm());
    for (Eigen::Index v = 0; v < reaction.cols(); ++v) {
        const bool is_held = simulation.mesh(0).positions(1, v) >= 0.49;
        EXPECT_EQ(reaction.col(v).norm() > 0, is_held);
    }
}

// Held for 0.1 s, three steps.
TYPED_TEST(VertexValuesTest, HaveNoReactionWhereAConstraintHasLetGo) {
    constexpr int kDim = TypeParam::value;
    Scene scene = hanging_cube<kDim>();
    scene.solver.integrator = Integrator::NewtonEuler;
    scene.constraints[0].to = 0.1;
    Simulation<kDim> simulation(scene, {cube<kDim>()});
    ASSERT_TRUE(simulation.step().is_accepted);
    EXPECT_GT(simulation.vertex_values(VertexQuantity::Reaction, 0).norm(), 0);
    for (int i = 0; i < 4; ++i) {
        ASSERT_TRUE(simulation.step().is_accepted);
    }
    EXPECT_TRUE(simulation.vertex_values(VertexQuantity::Reaction, 0).isZero(0));
}

// Times the volume around a vertex, which is its mass over the density, it adds up to the energy.
TYPED_TEST(VertexValuesTest, HaveEnergyDensitiesThatAddUpToTheElasticEnergy) {
    constexpr int kDim = TypeParam::value;
    const Scene scene = hanging_cube<kDim>();
    Simulation<kDim> simulation(scene, {cube<kDim>()});
    ASSERT_TRUE(simulation.step().is_accepted);
    const Eigen::MatrixXd density = simulation.vertex_values(VertexQuantity::EnergyDensity, 0);
    ASSERT_EQ(density.rows(), 1);
    const double sum = density.row(0).dot(simulation.masses(0)) / scene.bodies[0].material.density;
    const double energy = simulation.energies().of("elastic");
    EXPECT_GT(energy, 0);
    EXPECT_NEAR(sum, energy, 1e-10 * energy);
}

TYPED_TEST(VertexValuesTest, HaveOneEnergyDensityInABodyStretchedAlike) {
    constexpr int kDim = TypeParam::value;
    const Scene scene = test::box_scene<kDim>();
    Simulation<kDim> simulation(scene, {cube<kDim>()});
    simulation.set_state(0, 1.1 * simulation.positions(0), simulation.velocities(0));
    const Eigen::MatrixXd F = 1.1 * Eigen::MatrixXd::Identity(kDim, kDim);
    const double expected = energy_density(scene.bodies[0].material, F);
    const Eigen::MatrixXd density = simulation.vertex_values(VertexQuantity::EnergyDensity, 0);
    EXPECT_LT((density.array() - expected).abs().maxCoeff(), 1e-10 * expected);
    EXPECT_TRUE(simulation.vertex_values(VertexQuantity::Reaction, 0).isZero(0));
    EXPECT_TRUE(simulation.vertex_values(VertexQuantity::ContactForce, 0).isZero(0));
}

// det Fa psi(F Fa^-1) of each cell of the mesh, by where it is: the second of two bodies has a
// muscle in its lower half along y, by layers or by labels of cells, across two materials, by which
// these are sorted.
TYPED_TEST(VertexValuesTest, HaveEnergyDensitiesOfWhatMusclesLeaveOfTheDeformation) {
    constexpr int kDim = TypeParam::value;
    using Square = Eigen::Matrix<double, kDim, kDim>;
    constexpr double kStretch = 0.8;
    const auto below = [](int axis) {
        return HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, axis), .offset = 0.25};
    };
    for (const ElementKind kind : {ElementKind::Linear, ElementKind::Quadratic}) {
        Scene scene = test::box_scene<kDim>();
        scene.solver.elements = kind;
        scene.bodies.push_back(scene.bodies[0]);
        scene.bodies[0].name = "other";
        Region stiff{.name = "stiff", .select = {below(0)}, .material = scene.bodies[1].material};
        stiff.material.lame = lame_from_young(kDim, 1e6, 0.1);
        scene.bodies[1].regions = {stiff};
        Activation muscle = test::muscle(kStretch, Eigen::VectorXd::Unit(kDim, 0));
        if (kind == ElementKind::Linear) {
            muscle.select = {LayerSelection{.first = 0, .last = 1}};
        } else {
            muscle.select = {RegionSelection{.region = 7}};
        }
        scene.activations = {muscle};
        SimplexMesh<kDim> mesh =
            test::cube_for<kDim>(scene, kind == ElementKind::Quadratic ? 4 : 2);
        const auto middle_of = [&](Eigen::Index cell) -> Vector<kDim> {
            return mesh.positions(Eigen::all, mesh.cells.col(cell)).rowwise().mean();
        };
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            mesh.regions.push_back(middle_of(cell)[1] < 0.25 ? 7 : 2);
        }
        for (Eigen::Index vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
            mesh.layers.push_back(
                static_cast<std::uint32_t>(std::lround(4 * mesh.positions(1, vertex))));
        }
        Simulation<kDim> simulation(scene, {mesh, mesh});
        const Positions<kDim> x = test::shaken<kDim>(mesh.positions, 0.02, 3);
        simulation.set_state(1, x, simulation.velocities(1));
        Square shape = Square::Identity();
        shape(0, 0) = 1 / kStretch;
        Eigen::RowVectorXd energy = Eigen::RowVectorXd::Zero(mesh.vertex_count());
        Eigen::RowVectorXd volume = energy;
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            const Square rest = edge_matrix<kDim>(mesh.positions, mesh.cells, cell);
            const Square F = edge_matrix<kDim>(x, mesh.cells, cell) * rest.inverse();
            const Vector<kDim> middle = middle_of(cell);
            const Material& material = middle[0] < 0.25 ? stiff.material : scene.bodies[1].material;
            const double density = middle[1] < 0.25 ? kStretch * energy_density(material, F * shape)
                                                    : energy_density(material, F);
            for (const std::uint32_t vertex : mesh.cells.col(cell)) {
                energy[vertex] += rest.determinant() * density;
                volume[vertex] += rest.determinant();
            }
        }
        const Eigen::MatrixXd density = simulation.vertex_values(VertexQuantity::EnergyDensity, 1);
        EXPECT_LT((density - energy.cwiseQuotient(volume)).norm(), 1e-10 * density.norm());
        EXPECT_LT(simulation.vertex_values(VertexQuantity::EnergyDensity, 0).norm(),
                  1e-10 * density.norm());
    }
}

}  // namespace
}  // namespace pent::simulator
