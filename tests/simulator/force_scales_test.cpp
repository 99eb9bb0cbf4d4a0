#include "step/force_scales.h"

#include "potential_laws.h"
#include "potentials/elasticity.h"

#include <pent/simulator/words.h>

#include <algorithm>

// Forces of what is soft or light beside what is stiff or heavy.

namespace pent::simulator {
namespace {

using test::cube_for;
using test::Dimensions;
using test::gradient_of;
using test::Setting;
using test::shaken;

template <typename T>
class ForceScalesTest : public testing::Test {};
TYPED_TEST_SUITE(ForceScalesTest, Dimensions);

// Two cubes apart, the second so many times as stiff and as dense.
template <int Dim>
Scene two_materials(double stiffness, double density) {
    Scene scene = test::two_cubes<Dim>(0.3);
    scene.contact.reset();
    Material& second = scene.bodies[1].material;
    second.lame.mu *= stiffness;
    second.lame.lambda *= stiffness;
    second.density *= density;
    return scene;
}

TYPED_TEST(ForceScalesTest, OfOneMaterialAreAllTheSame) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(two_materials<kDim>(1, 1), 2);
    const ForceScales<kDim> scales(setting.bodies);
    const Positions<kDim> gradient = shaken<kDim>(0 * setting.bodies.rest(), 1, 3);
    EXPECT_EQ(scales.norms(gradient), GradientNorms{gradient.norm()});
    EXPECT_TRUE(scales.weights(setting.dofs).empty());
}

// However many vertices a body has: what counts is how much belongs to each.
TYPED_TEST(ForceScalesTest, OfOneMaterialAndCellsOfOneSizeAreAllTheSame) {
    constexpr int kDim = TypeParam::value;
    const Scene scene = two_materials<kDim>(1, 1);
    const Bodies<kDim> bodies =
        make_bodies<kDim>(scene, {test::cube<kDim>(2), test::cube<kDim>(kDim == 3 ? 6 : 4)});
    EXPECT_EQ(ForceScales<kDim>(bodies).norms(bodies.rest()).size(), 1);
}

// Two bodies that are strained alike have as much of the norm each.
TYPED_TEST(ForceScalesTest, LetBodiesThatAreStrainedAlikeCountAlike) {
    constexpr int kDim = TypeParam::value;
    for (const double ratio : {1e-6, 0.3, 1e6}) {
        const Setting<kDim> setting(two_materials<kDim>(ratio, 5), 2);
        Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, setting.held,
                                    setting.scene);
        const Eigen::Index half = setting.bodies.first_vertex[1];
        Positions<kDim> x = setting.bodies.rest();
        const Positions<kDim> strained = shaken<kDim>(0 * x.leftCols(half), 0.02, 5);
        x.leftCols(half) += strained;
        x.rightCols(half) += strained;
        const Positions<kDim> gradient = gradient_of<kDim>(elasticity, x);
        ForceScales<kDim> scales(setting.bodies);
        scales.set_inertia(false);
        const GradientNorms norms = scales.norms(gradient);
        ASSERT_EQ(norms.size(), 2);
        const double larger =
            std::max(gradient.leftCols(half).norm(), gradient.rightCols(half).norm());
        EXPECT_NEAR(norms[1], std::sqrt(2.0) * larger, 1e-9 * larger);
    }
}

// The same for two sizes, and if they are of one material.
TYPED_TEST(ForceScalesTest, LetBodiesOfAllSizesThatAreStrainedAlikeCountAlike) {
    constexpr int kDim = TypeParam::value;
    for (const double stiffness : {1.0, 30.0}) {
        for (const double size : {0.01, 5.0, 300.0}) {
            Scene scene = two_materials<kDim>(stiffness, 1);
            scene.bodies[1].place.scale = size;
            const Setting<kDim> setting(scene, 2);
            Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, setting.held,
                                        setting.scene);
            const Eigen::Index half = setting.bodies.first_vertex[1];
            const Positions<kDim> rest = setting.bodies.rest();
            Positions<kDim> x = rest;
            const Positions<kDim> strained = shaken<kDim>(0 * x.leftCols(half), 0.02, 5);
            x.leftCols(half) += strained;
            x.rightCols(half) += size * strained;
            const Positions<kDim> gradient = gradient_of<kDim>(elasticity, x);
            ForceScales<kDim> scales(setting.bodies);
            const double left = gradient.leftCols(half).norm();
            const double right = gradient.rightCols(half).norm();
            EXPECT_NEAR(scales.norms(gradient)[1], std::sqrt(2.0) * std::max(left, right),
                        1e-6 * std::max(left, right));
            // As much of a norm where they are accelerated alike.
            const Positions<kDim> moved =
                Positions<kDim>::Ones(kDim, 2 * half) * setting.bodies.masses.asDiagonal();
            const double larger =
                std::max(moved.leftCols(half).norm(), moved.rightCols(half).norm());
            EXPECT_NEAR(scales.norms(moved)[2], std::sqrt(2.0) * larger, 1e-9 * larger);
        }
    }
}

// Whatever else there is far away, a body moves as it does alone.
TYPED_TEST(ForceScalesTest, SmallBodiesMoveAsTheyDoWithoutALargeOne) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        const auto moved = [&](double size) {
            Scene scene = two_materials<kDim>(1, 1);
            scene.gravity[1] = -9.8;
            scene.solver.integrator = integrator;
            scene.bodies[0].spin = {{.plane = {0, 1}, .degrees_per_s = 400}};
            scene.bodies[1].place.scale = size;
            scene.bodies[1].place.translate[0] += 3 * size;
            const std::size_t count = size > 0 ? 2 : 1;
            scene.bodies.resize(count);
            Simulation<kDim> simulation(
                scene, std::vector<SimplexMesh<kDim>>(count, cube_for<kDim>(scene, 2)));
            for (int k = 0; k < 6; ++k) {
                EXPECT_TRUE(simulation.step().is_accepted);
            }
            return Positions<kDim>(simulation.positions(0));
        };
        const Positions<kDim> alone = moved(0);
        // Both leave 1e-4 of the forces of a step, by which it moves less than its own size.
        for (const double size : {10.0, 100.0, 1e7}) {
            EXPECT_LT((moved(size) - alone).cwiseAbs().maxCoeff(), 1e-4) << size;
        }
    }
}

// A body of two pieces, one of them small, moves as two bodies do.
TYPED_TEST(ForceScalesTest, SmallPiecesOfABodyMoveAsBodiesDo) {
    constexpr int kDim = TypeParam::value;
    constexpr double kSmall = 0.002;
    Scene scene = two_materials<kDim>(1, 1);
    scene.gravity[1] = -9.8;
    for (Body& body : scene.bodies) {
        body.place.translate.setZero();
        Constraint hold =
            test::hold(HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 0), .offset = 1e-6},
                       test::still(kDim));
        hold.body = body.name;
        scene.constraints.push_back(hold);
    }
    const SimplexMesh<kDim> large = cube_for<kDim>(scene, 2);
    SimplexMesh<kDim> small = large;
    small.positions *= kSmall;
    small.positions.row(0) *= 10;  // a bar
    small.positions.row(1).array() += 2;
    SimplexMesh<kDim> both = large;
    both.positions.conservativeResize(kDim, 2 * large.vertex_count());
    both.positions.rightCols(large.vertex_count()) = small.positions;
    both.cells.conservativeResize(kDim + 1, 2 * large.cell_count());
    both.cells.rightCols(large.cell_count()) =
        large.cells.array() + static_cast<std::uint32_t>(large.vertex_count());
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        scene.solver.integrator = integrator;
        Scene of_one = scene;
        of_one.bodies.resize(1);
        of_one.constraints.resize(1);
        Simulation<kDim> one(of_one, {both});
        Simulation<kDim> two(scene, {large, small});
        for (int k = 0; k < 12; ++k) {
            EXPECT_TRUE(one.step().is_accepted);
            EXPECT_TRUE(two.step().is_accepted);
        }
        const Positions<kDim> moved = two.positions(1) - small.positions;
        EXPECT_LT((one.positions(0).rightCols(large.vertex_count()) - two.positions(1)).norm(),
                  scene.solver.tolerance * moved.norm());
    }
}

// Densities count beside stiffness, the larger as it is, and in steps with inertia alone.
TYPED_TEST(ForceScalesTest, LetBodiesThatMoveAlikeCountAlike) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(two_materials<kDim>(4, 1.0 / 128), 2);
    const Eigen::Index half = setting.bodies.first_vertex[1];
    ForceScales<kDim> scales(setting.bodies);
    Positions<kDim> gradient = Positions<kDim>::Zero(kDim, 2 * half);
    gradient(1, 0) = 3;
    EXPECT_EQ(scales.norms(gradient), (GradientNorms{3, 12, 3}));
    gradient(2, half) = 4.0 / 128;
    EXPECT_NEAR(scales.norms(gradient)[2], 5, 1e-12);
    scales.set_inertia(false);
    EXPECT_EQ(scales.norms(gradient).size(), 2);
}

// A soft part of a stiff body: what both have of a vertex is held by the stiff one. The solver
// weighs the same.
TYPED_TEST(ForceScalesTest, TakeTheStifferOfTwoMaterialsOfAVertex) {
    constexpr int kDim = TypeParam::value;
    Scene scene = two_materials<kDim>(1, 1);
    Region soft;
    soft.name = "soft";
    soft.select = {HalfSpaceSelection{-Eigen::VectorXd::Unit(kDim, 1), -0.25}};
    soft.material = scene.bodies[0].material;
    soft.material.lame.mu /= 128;
    soft.material.lame.lambda /= 128;
    scene.bodies[0].regions = {soft};
    const Setting<kDim> setting(scene, 2);
    const ForceScales<kDim> scales(setting.bodies);
    const std::vector<Eigen::VectorXd> weights = scales.weights(setting.dofs);
    ASSERT_EQ(weights.size(), 1);
    for (std::uint32_t vertex = 0; vertex < setting.bodies.vertex_count(); ++vertex) {
        Positions<kDim> gradient = Positions<kDim>::Zero(kDim, setting.bodies.vertex_count());
        gradient(0, vertex) = 1;
        const bool is_soft =
            vertex < setting.bodies.first_vertex[1] && setting.bodies.rest()(1, vertex) > 0.3;
        const double expected = is_soft ? 128 : 1;
        EXPECT_EQ(scales.norms(gradient), (GradientNorms{1, expected})) << vertex;
        EXPECT_EQ(weights[0][setting.dofs.dof_of(vertex)], expected * expected) << vertex;
    }
}

// How far the first of two cubes, each pulled away from a side that is held, is in three steps from
// where it is alone, over how far it moved. Both leave 1e-4 of the forces of a step, and a cube
// of two cells an edge has no mode that is ten times as soft as those that gravity moves.
template <int Dim>
double far_from_alone(ElementKind kind, Integrator integrator, double stiffness, double density) {
    Scene both = two_materials<Dim>(stiffness, density);
    both.solver.elements = kind;
    both.solver.integrator = integrator;
    both.solver.newton_tolerance = 1e-4;
    both.gravity = Eigen::VectorXd::Zero(Dim);
    both.gravity[0] = 2;
    for (const Body& body : both.bodies) {
        HalfSpaceSelection side;
        side.normal = Eigen::VectorXd::Unit(Dim, 0);
        side.offset = body.place.translate[0] + 0.01;
        both.constraints.push_back({.body = body.name, .select = {side}, .motion = {}});
    }
    Scene alone = both;
    alone.bodies.pop_back();
    alone.constraints.pop_back();
    alone.solver.newton_tolerance = 1e-10;
    alone.solver.tolerance = 1e-9;
    const SimplexMesh<Dim> mesh = cube_for<Dim>(both, 2);
    Simulation<Dim> a(both, {mesh, mesh});
    Simulation<Dim> b(alone, {mesh});
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(a.step().is_accepted);
        EXPECT_TRUE(b.step().is_accepted);
    }
    const Positions<Dim> moved = b.positions(0) - b.mesh(0).positions;
    return (a.positions(0) - b.positions(0)).norm() / moved.norm();
}

TYPED_TEST(ForceScalesTest, LeaveASoftBodyBesideAStiffOneAsRightAsAlone) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : test::kElementKinds) {
        for (const double ratio : {1e3, 1e6}) {
            EXPECT_LT(far_from_alone<kDim>(kind, Integrator::Quasistatic, ratio, ratio), 1e-3)
                << word_of(kind) << " " << ratio;
        }
    }
}

TYPED_TEST(ForceScalesTest, LeaveALightBodyBesideAHeavyOneAsRightAsAlone) {
    constexpr int kDim = TypeParam::value;
    for (const Integrator integrator :
         {Integrator::LinearEuler, Integrator::NewtonEuler, Integrator::Bdf2}) {
        for (const ElementKind kind : test::kElementKinds) {
            for (const double stiffness : {1.0, 1e3, 1e6}) {
                EXPECT_LT(far_from_alone<kDim>(kind, integrator, stiffness, 1e6), 1e-3)
                    << word_of(integrator) << " " << word_of(kind) << " " << stiffness;
            }
        }
    }
}

}  // namespace
}  // namespace pent::simulator
