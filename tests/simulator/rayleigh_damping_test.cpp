#include "potentials/rayleigh_damping.h"

#include "potential_laws.h"

namespace pent::simulator {
namespace {

using test::Dimensions;
using test::expect_derivatives;
using test::gradient_of;
using test::Setting;
using test::shaken;
using test::value_of;

template <typename T>
class RayleighDampingTest : public testing::Test {};
TYPED_TEST_SUITE(RayleighDampingTest, Dimensions);

TYPED_TEST(RayleighDampingTest, IsAQuadraticOfTheTangentThatPullsBack) {
    constexpr int kDim = TypeParam::value;
    const Scene scene = test::box_scene<kDim>();
    const Setting<kDim> setting(scene, 2);
    Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, scene);
    RayleighDamping<kDim> damping(setting.workers, setting.isa.blocks, elasticity, setting.dofs,
                                  setting.bodies.sharing, Filter::Clamp);
    const Positions<kDim> start = shaken<kDim>(setting.bodies.rest, 0.05, 10);
    const Positions<kDim> still = Positions<kDim>::Zero(kDim, start.cols());
    static_cast<void>(value_of<kDim>(elasticity, start));
    static_cast<void>(damping.begin_step({start, still, start, still, 0.01, 100, false}));
    const Positions<kDim> x = shaken<kDim>(start, 0.05, 11);
    expect_derivatives<kDim>(setting, damping, x);
    EXPECT_GT(value_of<kDim>(damping, x), 0);
    EXPECT_EQ(value_of<kDim>(damping, start), 0);
    // Twice as far costs four times as much, and a shift of everything nothing.
    const Positions<kDim> far = start + 2 * (x - start);
    EXPECT_NEAR(value_of<kDim>(damping, far), 4 * value_of<kDim>(damping, x),
                1e-9 * value_of<kDim>(damping, far));
    const Positions<kDim> shifted = start.array() + 0.3;
    EXPECT_LT(std::abs(value_of<kDim>(damping, shifted)), 1e-9 * value_of<kDim>(damping, far));
}

// The tangent is that of the elements: those of cells, of edges, and of quadratic cells, which
// couple more.
TYPED_TEST(RayleighDampingTest, HasTheDerivativesOfItsEnergyWithElementsOfEveryKind) {
    constexpr int kDim = TypeParam::value;
    for (const ElementKind kind :
         {ElementKind::Linear, ElementKind::Smoothed, ElementKind::Quadratic}) {
        Scene scene = test::box_scene<kDim>();
        scene.solver.elements = kind;
        const Setting<kDim> setting(scene, 2);
        Elasticity<kDim> elasticity(setting.workers, setting.isa, setting.bodies, scene);
        RayleighDamping<kDim> damping(setting.workers, setting.isa.blocks, elasticity, setting.dofs,
                                      setting.bodies.sharing, Filter::Clamp);
        const Positions<kDim> start = shaken<kDim>(setting.bodies.rest, 0.05, 12);
        const Positions<kDim> still = Positions<kDim>::Zero(kDim, start.cols());
        static_cast<void>(value_of<kDim>(elasticity, start));
        static_cast<void>(damping.begin_step({start, still, start, still, 0.01, 100, false}));
        const Positions<kDim> x = shaken<kDim>(start, 0.05, 13);
        expect_derivatives<kDim>(setting, elasticity.pattern(), damping, x);
        // Twice the energy is what its slope does along the way from the start.
        const double work = gradient_of<kDim>(damping, x).cwiseProduct(x - start).sum();
        EXPECT_NEAR(work, 2 * value_of<kDim>(damping, x), 1e-12 * work);
    }
}

}  // namespace
}  // namespace pent::simulator
