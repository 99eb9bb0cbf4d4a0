#include "potentials/friction_potential.h"

#include "model/same_time.h"
#include "potential_laws.h"

namespace pent::simulator {
namespace {

using test::barrier_scene;
using test::Dimensions;
using test::expect_derivatives;
using test::gradient_of;
using test::Setting;
using test::shaken;
using test::value_of;

template <typename T>
class FrictionPotentialTest : public testing::Test {};
TYPED_TEST_SUITE(FrictionPotentialTest, Dimensions);

TYPED_TEST(FrictionPotentialTest, HasTheDerivativesOfItsEnergyAndNeverPushesAlongTheSlip) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(barrier_scene<kDim>(), 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies, setting.held);
    const Positions<kDim> start = shaken<kDim>(setting.bodies.rest(), 0.006, 17);
    ASSERT_GT(value_of<kDim>(contact, start), 0);
    const Positions<kDim> still = Positions<kDim>::Zero(kDim, start.cols());
    for (const double slip_speed : {1e-3, 1.0}) {  // sliding, and sticking
        FrictionPotential<kDim> friction(contact, {.coefficient = 0.4, .slip_speed = slip_speed});
        static_cast<void>(friction.begin_step({start, still, start, still, 0.01, 100, false}));
        EXPECT_EQ(value_of<kDim>(friction, start), 0);
        const Positions<kDim> x = shaken<kDim>(start, 1e-3, 18);
        expect_derivatives<kDim>(setting, friction, x, 1e-7);
        const Positions<kDim> gradient = gradient_of<kDim>(friction, x);
        EXPECT_GT(gradient.cwiseProduct(x - start).sum(), 0);
        EXPECT_GT(value_of<kDim>(friction, x), 0);
    }
}

TYPED_TEST(FrictionPotentialTest, BetweenBodiesKeepsTheirMomentum) {
    constexpr int kDim = TypeParam::value;
    Scene scene = barrier_scene<kDim>();
    scene.obstacles.clear();
    const Setting<kDim> setting(scene, 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies, setting.held);
    const Positions<kDim> start = shaken<kDim>(setting.bodies.rest(), 0.006, 19);
    ASSERT_GT(value_of<kDim>(contact, start), 0);
    FrictionPotential<kDim> friction(contact, {.coefficient = 0.4, .slip_speed = 1e-3});
    const Positions<kDim> still = Positions<kDim>::Zero(kDim, start.cols());
    static_cast<void>(friction.begin_step({start, still, start, still, 0.01, 100, false}));
    const Positions<kDim> gradient = gradient_of<kDim>(friction, shaken<kDim>(start, 1e-3, 20));
    EXPECT_GT(gradient.norm(), 0);
    EXPECT_LT(gradient.rowwise().sum().norm(), 1e-12 * gradient.norm());
}

// A simulation that is put to another time has nothing to hold; one that repeats its step, or part
// of it, holds what it held.
TYPED_TEST(FrictionPotentialTest, HoldsNothingForAStepOfAnotherEndUntilItBegins) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(barrier_scene<kDim>(), 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies, setting.held);
    const Positions<kDim> start = shaken<kDim>(setting.bodies.rest(), 0.006, 17);
    ASSERT_GT(value_of<kDim>(contact, start), 0);
    const Positions<kDim> still = Positions<kDim>::Zero(kDim, start.cols());
    const Positions<kDim> x = shaken<kDim>(start, 1e-3, 18);
    FrictionPotential<kDim> friction(contact, {.coefficient = 0.4, .slip_speed = 1e-3});
    EXPECT_EQ(value_of<kDim>(friction, x), 0);
    constexpr double kEnd = 1.01;  // s, of a step of a hundredth
    const auto begin = [&] {
        EXPECT_FALSE(friction.set_time({1, kEnd}));
        static_cast<void>(friction.begin_step({start, still, start, still, 0.01, 100, false}));
        return value_of<kDim>(friction, x);
    };
    const double held = begin();
    EXPECT_GT(held, 0);
    for (const double end : {kEnd, kEnd + 0.1 * kSameTime * 0.01, kEnd - 0.1 * kSameTime * 0.01}) {
        EXPECT_FALSE(friction.set_time({1, end}));
        EXPECT_EQ(value_of<kDim>(friction, x), held);
    }
    for (const double end : {kEnd + 10 * kSameTime * 0.01, kEnd - 10 * kSameTime * 0.01, 1.02}) {
        EXPECT_FALSE(friction.set_time({1, end}));
        EXPECT_EQ(value_of<kDim>(friction, x), 0);
        EXPECT_EQ(begin(), held);
    }
}

TYPED_TEST(FrictionPotentialTest, CountsItsContactsOnceForEveryEvaluation) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(barrier_scene<kDim>(), 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies, setting.held);
    const Positions<kDim> start = shaken<kDim>(setting.bodies.rest(), 0.006, 17);
    ASSERT_GT(value_of<kDim>(contact, start), 0);
    const auto contacts = static_cast<std::int64_t>(contact.contacts().list.size());
    const Positions<kDim> still = Positions<kDim>::Zero(kDim, start.cols());
    FrictionPotential<kDim> friction(contact, {.coefficient = 0.4, .slip_speed = 1e-3});
    static_cast<void>(friction.begin_step({start, still, start, still, 0.01, 100, false}));
    EXPECT_EQ(friction.take_count(), 0);
    static_cast<void>(value_of<kDim>(friction, start));
    const std::int64_t once = friction.take_count();
    EXPECT_GT(once, 0);
    EXPECT_LE(once, contacts);
    static_cast<void>(value_of<kDim>(friction, start));
    static_cast<void>(value_of<kDim>(friction, start));
    EXPECT_EQ(friction.take_count(), 2 * once);
    EXPECT_EQ(friction.take_count(), 0);
}

}  // namespace
}  // namespace pent::simulator
