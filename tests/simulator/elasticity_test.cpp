#include "potentials/elasticity.h"

#include "potential_laws.h"

#include <pent/simulator/words.h>

namespace pent::simulator {
namespace {

using test::Dimensions;
using test::expect_derivatives;
using test::expect_invariance_under_rigid_motion;
using test::gradient_of;
using test::Setting;
using test::shaken;
using test::two_cubes;
using test::value_of;

template <typename T>
class ElasticityTest : public testing::Test {};
TYPED_TEST_SUITE(ElasticityTest, Dimensions);

constexpr std::array kKinds = {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic};

// Flat, turned inside out, or all in one point: formulas hold there, too.
template <int Dim>
std::vector<Positions<Dim>> hard_states(const Positions<Dim>& rest) {
    Positions<Dim> flat = shaken<Dim>(rest, 0.02, 4);
    flat.row(1).setConstant(0.25);
    Positions<Dim> inside_out = shaken<Dim>(rest, 0.02, 5);
    inside_out.row(0) *= -1;
    Positions<Dim> line = shaken<Dim>(rest, 0.02, 6);
    line.bottomRows(Dim - 1).setZero();
    return {shaken<Dim>(rest, 0.05, 7), flat, inside_out, line};
}

TYPED_TEST(ElasticityTest, HasTheDerivativesOfItsEnergyAlsoWhereElementsAreDegenerate) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : kKinds) {
        for (const Model law : values<Model>()) {
            Scene scene = test::box_scene<kDim>();
            scene.bodies[0].material.model = law;
            scene.bodies[0].material.second_invariant = 0.4;
            scene.solver.elements = kind;
            const Setting<kDim> setting(scene, 2);
            Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, setting.held,
                                        scene);
            for (const Positions<kDim>& x : hard_states<kDim>(setting.bodies.rest())) {
                if (law == Model::Arap && x.row(1).isConstant(x(1, 0))) {
                    continue;  // its rotation jumps where an element is flat
                }
                expect_derivatives<kDim>(setting, *elasticity.pattern(), elasticity, x);
            }
        }
    }
}

TYPED_TEST(ElasticityTest, DoesNotSeeRigidMotions) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : kKinds) {
        for (const Model law : values<Model>()) {
            if (law == Model::Linear) {
                continue;  // sees turns
            }
            Scene scene = test::box_scene<kDim>();
            scene.bodies[0].material.model = law;
            scene.bodies[0].material.second_invariant = 0.4;
            scene.solver.elements = kind;
            const Setting<kDim> setting(scene, 2);
            Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, setting.held,
                                        scene);
            expect_invariance_under_rigid_motion<kDim>(
                elasticity, shaken<kDim>(setting.bodies.rest(), 0.05, 8));
        }
    }
}

// Held ends, a body that sleeps: what the elastic term says of vertices without dofs stays what it
// is.

TYPED_TEST(ElasticityTest, OfSleepingBodiesIsThatWithWhichTheyFellAsleep) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind : kKinds) {
        Scene scene = two_cubes<kDim>(0.3);
        scene.contact.reset();
        scene.solver.elements = kind;
        Setting<kDim> setting(scene, 1);
        Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, setting.held,
                                    scene);
        const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.05, 9);
        const double awake = value_of<kDim>(elasticity, x);
        const Positions<kDim> gradient = gradient_of<kDim>(elasticity, x);
        setting.dofs = number_dofs(setting.bodies, setting.held, {false, true});
        elasticity.set_dofs(setting.dofs, setting.held, {true, false}, x);
        EXPECT_NEAR(value_of<kDim>(elasticity, x), awake, 1e-12 * awake);
        EXPECT_LT((gradient_of<kDim>(elasticity, x) - gradient).norm(), 1e-12 * gradient.norm());
        expect_derivatives<kDim>(setting, *elasticity.pattern(), elasticity, x);
    }
}

}  // namespace
}  // namespace pent::simulator
