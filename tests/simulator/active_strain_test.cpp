#include "model/active_strain.h"

#include "muscle.h"
#include "potential_laws.h"
#include "potentials/elasticity.h"
#include "support/messages.h"

#include <pent/geometry.h>
#include <pent/simulator/energy.h>
#include <pent/simulator/placed_mesh.h>
#include <pent/simulator/words.h>

#include <Eigen/LU>

#include <cmath>
#include <numbers>

namespace pent::simulator {
namespace {

using pent::test::error_of;
using test::Dimensions;
using test::expect_derivatives;
using test::gradient_of;
using test::Setting;
using test::shaken;
using test::value_of;

constexpr ElementKind kKinds[] = {ElementKind::Linear, ElementKind::Quadratic};

template <typename T>
class ActiveStrainTest : public testing::Test {};
TYPED_TEST_SUITE(ActiveStrainTest, Dimensions);

template <int Dim>
Activation muscle(double stretch) {
    return test::muscle(stretch, Eigen::Matrix<double, Dim, 1>::LinSpaced(1, 2).normalized());
}

TEST(Signal, OfASineGoesUpAndDownBetweenNothingAndAllOncePerPeriod) {
    Activation activation;
    activation.signal = Signal::Sine;
    activation.frequency = 2;
    EXPECT_NEAR(signal_at(activation, 0, 0), 0.5, 1e-15);
    EXPECT_NEAR(signal_at(activation, 0.125, 0), 1, 1e-15);
    EXPECT_NEAR(signal_at(activation, 0.375, 0), 0, 1e-15);
    EXPECT_NEAR(signal_at(activation, 0.125, 0.5), 0, 1e-15);
    EXPECT_NEAR(signal_at(activation, 0.7, 0), signal_at(activation, 0.2, 0), 1e-14);
    // What is late is as it has been.
    EXPECT_NEAR(signal_at(activation, 0.125, 0.25), signal_at(activation, 0, 0), 1e-15);
    EXPECT_NEAR(signal_at(activation, 0.2, 0.1), signal_at(activation, 0.15, 0), 1e-15);
    activation.phase = 0.25;
    EXPECT_NEAR(signal_at(activation, 0, 0), 1, 1e-15);
}

TEST(Signal, OfPulsesIsAllInTheMiddleNothingOutsideAndChangesSmoothly) {
    Activation activation;
    activation.signal = Signal::Pulses;
    activation.frequency = 1;
    activation.duty = 0.4;
    EXPECT_EQ(signal_at(activation, 0, 0), 0);
    EXPECT_EQ(signal_at(activation, 0.2, 0), 1);
    EXPECT_EQ(signal_at(activation, 0.5, 0), 0);
    EXPECT_EQ(signal_at(activation, 7.2, 0), 1);
    double before = 0;
    for (int i = 1; i <= 4000; ++i) {
        const double now = signal_at(activation, i / 4000.0, 0);
        EXPECT_LE(std::abs(now - before), 1.5 / (0.08 * 4000) + 1e-12);  // the steepest of a flank
        before = now;
    }
}

TYPED_TEST(ActiveStrainTest, StretchesAlongTheFiberAndPreservesVolumeIfAsked) {
    constexpr int kDim = TypeParam::value;
    using Matrix = Eigen::Matrix<double, kDim, kDim>;
    Activation activation = muscle<kDim>(0.7);
    const Vector<kDim> d = activation.direction;
    Matrix Fa = active_deformation<kDim>(activation, 0.5, d);
    EXPECT_LT((Fa * d - 0.85 * d).norm(), 1e-15);
    EXPECT_NEAR(Fa.determinant(), 0.85, 1e-15);
    activation.preserves_volume = true;
    Fa = active_deformation<kDim>(activation, 0.5, d);
    EXPECT_LT((Fa * d - 0.85 * d).norm(), 1e-15);
    EXPECT_NEAR(Fa.determinant(), 1, 1e-14);
    EXPECT_EQ(active_deformation<kDim>(activation, 1, Vector<kDim>::Zero()),
              Matrix::Identity());  // without a fiber
    activation.fibers = Fibers::None;
    EXPECT_LT((active_deformation<kDim>(activation, 1, d) - 0.7 * Matrix::Identity()).norm(),
              1e-15);
}

// det Fa psi(F Fa^-1) cell by cell, where two muscles overlap.
TYPED_TEST(ActiveStrainTest, GivesEveryCellTheEnergyOfWhatIsLeftOfItsDeformation) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    scene.activations = {muscle<kDim>(0.8), muscle<kDim>(1.3)};
    scene.activations[1].select = {
        BoxSelection{Eigen::VectorXd::Constant(kDim, -1), Eigen::VectorXd::Constant(kDim, 0.26)}};
    scene.activations[1].direction = Eigen::VectorXd::Unit(kDim, 0);
    for (const Model law : values<Model>()) {
        scene.bodies[0].material.model = law;
        scene.bodies[0].material.second_invariant = 0.4;
        const Setting<kDim> setting(scene, 2);
        Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, setting.held,
                                    scene);
        const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.03, 11);
        double expected = 0;
        int both = 0;
        const SimplexMesh<kDim>& mesh = setting.bodies.meshes[0];
        const std::vector<bool> is_second =
            select_cells(mesh, scene.activations[1].select, "the second");
        for (Eigen::Index cell = 0; cell < mesh.cell_count(); ++cell) {
            Matrix<kDim> Fa =
                active_deformation<kDim>(scene.activations[0], 1, scene.activations[0].direction);
            if (is_second[static_cast<std::size_t>(cell)]) {
                Fa = (active_deformation<kDim>(scene.activations[1], 1,
                                               scene.activations[1].direction)
                      * Fa)
                         .eval();
                ++both;
            }
            const Matrix<kDim> F = edge_matrix<kDim>(x, mesh.cells, cell)
                                   * edge_matrix<kDim>(mesh.positions, mesh.cells, cell).inverse();
            expected += cell_volume<kDim>(mesh.positions, mesh.cells, cell) * Fa.determinant()
                        * energy_density(scene.bodies[0].material, F * Fa.inverse());
        }
        ASSERT_GT(both, 0);
        ASSERT_LT(both, mesh.cell_count());
        EXPECT_NEAR(value_of<kDim>(elasticity, x), expected, 1e-10 * expected);
    }
}

TYPED_TEST(ActiveStrainTest, KeepsTheDerivativesThoseOfTheEnergy) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : kKinds) {
        for (const Model law : values<Model>()) {
            Scene scene = test::box_scene<kDim>();
            scene.solver.elements = kind;
            scene.bodies[0].material.model = law;
            scene.bodies[0].material.second_invariant = 0.4;
            scene.activations = {muscle<kDim>(0.6)};
            scene.activations[0].preserves_volume = true;
            scene.activations[0].signal = Signal::Sine;
            scene.activations[0].wave = Eigen::VectorXd::Constant(kDim, 0.7);
            const Setting<kDim> setting(scene, 2);
            Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, setting.held,
                                        scene);
            EXPECT_TRUE(elasticity.set_time({0.1, 0.2}));
            expect_derivatives<kDim>(setting, *elasticity.pattern(), elasticity,
                                     shaken<kDim>(setting.bodies.rest(), 0.02, 12));
        }
    }
}

// What Fa is the same everywhere leaves a shape without any stress: Fa X.
TYPED_TEST(ActiveStrainTest, OfAllAlikeHasNoEnergyInTheExactShape) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : kKinds) {
        for (const Fibers fibers : {Fibers::None, Fibers::Constant}) {
            Scene scene = test::box_scene<kDim>();
            scene.solver.elements = kind;
            scene.activations = {muscle<kDim>(1.4)};
            scene.activations[0].fibers = fibers;
            const Setting<kDim> setting(scene, 2);
            Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, setting.held,
                                        scene);
            const Positions<kDim> shape =
                active_deformation<kDim>(scene.activations[0], 1, scene.activations[0].direction)
                * setting.bodies.rest();
            const double at_rest = value_of<kDim>(elasticity, setting.bodies.rest());
            EXPECT_GT(at_rest, 1);
            EXPECT_LT(std::abs(value_of<kDim>(elasticity, shape)), 1e-12 * at_rest);
            EXPECT_LT(gradient_of<kDim>(elasticity, shape).norm(), 1e-10 * at_rest);
        }
    }
}

// Fibers by the distance from a face run along the axis: those of a constant direction.
TYPED_TEST(ActiveStrainTest, HasFibersByDistanceAndOfTheMeshAsByADirection) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : kKinds) {
        Scene scene = test::box_scene<kDim>();
        scene.solver.elements = kind;
        scene.activations = {muscle<kDim>(0.6)};
        Activation& activation = scene.activations[0];
        activation.direction = Eigen::VectorXd::Unit(kDim, 1);
        activation.signal = Signal::Sine;
        activation.wave = 0.3 * activation.direction;
        const auto energy = [&](const auto& change) {
            Scene changed = scene;
            change(changed.activations[0]);
            SimplexMesh<kDim> mesh = test::cube_for<kDim>(changed, 2);
            mesh.fibers = Positions<kDim>::Zero(kDim, mesh.cell_count());
            mesh.fibers.row(1).setConstant(-3);
            const Bodies<kDim> bodies = make_bodies<kDim>(changed, {mesh});
            const Workers workers(1);
            Elasticity<kDim> elasticity(workers, kernels<kDim>(Isa::Scalar), bodies,
                                        HeldVertices<kDim>(changed, bodies), changed);
            static_cast<void>(elasticity.set_time({0, 0.1}));
            return value_of<kDim>(elasticity, shaken<kDim>(bodies.rest(), 0.02, 13));
        };
        const double expected = energy([](Activation&) {});
        EXPECT_NEAR(energy([](Activation& a) { a.fibers = Fibers::Mesh; }), expected,
                    1e-12 * expected);
        const auto by_distance = [&](Activation& a) {
            a.fibers = Fibers::Distance;
            a.away_from = {HalfSpaceSelection{Eigen::VectorXd::Unit(kDim, 1), 1e-9}};
            a.wave = {};
            a.distance_wave = 0.3;
        };
        EXPECT_NEAR(energy(by_distance), expected, 1e-9 * expected);
        EXPECT_GT(std::abs(energy([](Activation& a) { a.fibers = Fibers::None; }) - expected),
                  0.01 * expected);
    }
}

TYPED_TEST(ActiveStrainTest, SaysWhatItMisses) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    scene.activations = {muscle<kDim>(0.6)};
    scene.activations[0].source = "a.toml:3:1";
    const auto error = [&] {
        return error_of([&] {
            const Setting<kDim> setting(scene, 2);
            static_cast<void>(ActiveStrain<kDim>(setting.workers, scene, setting.bodies));
        });
    };
    scene.activations[0].fibers = Fibers::Mesh;
    EXPECT_EQ(error(),
              "a.toml:3:1: activation of \"box\": fibers = \"mesh\", but the mesh has none;"
              " expected the properties fiber_x, fiber_y .. of its cells"
              " (docs/pent-format.md)");
    scene.activations[0].fibers = Fibers::Constant;
    scene.activations[0].select = {BallSelection{Eigen::VectorXd::Constant(kDim, 9), 0.1}};
    EXPECT_NE(
        error().find("a.toml:3:1: activation of \"box\" selects no cell: the nearest cell is"),
        std::string::npos)
        << error();
    scene.solver.elements = ElementKind::Smoothed;
    EXPECT_EQ(error(),
              "activation: smoothed elements know none; use elements = \"quadratic\" or"
              " \"linear\"");
    scene.solver.elements = ElementKind::Linear;
    scene.activations[0].keyframes = {{0, 0}, {1, 3}};
    EXPECT_EQ(error(),
              "activation of \"box\": the keyframe of factor 3 makes fibers -0.2 times as"
              " long, which would turn cells inside out; expected more than 0: factors are"
              " of stretch - 1");
}

}  // namespace
}  // namespace pent::simulator
