#include "potentials/gravity.h"

#include "potential_laws.h"

namespace pent::simulator {
namespace {

using test::Dimensions;
using test::expect_derivatives;
using test::Setting;
using test::shaken;
using test::value_of;

template <typename T>
class GravityTest : public testing::Test {};
TYPED_TEST_SUITE(GravityTest, Dimensions);

TYPED_TEST(GravityTest, IsMassTimesHeight) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(test::box_scene<kDim>(), 1);
    const Eigen::Matrix<double, kDim, 1> g = Eigen::Matrix<double, kDim, 1>::LinSpaced(-3, 1);
    Gravity<kDim> gravity(setting.workers, setting.bodies.masses, g);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.1, 1);
    expect_derivatives<kDim>(setting, gravity, x);
    EXPECT_NEAR(value_of<kDim>(gravity, x), -g.dot(x * setting.bodies.masses), 1e-10);
    const Positions<kDim> up = x.colwise() + 0.3 * g;
    EXPECT_NEAR(value_of<kDim>(gravity, up) - value_of<kDim>(gravity, x),
                -0.3 * g.squaredNorm() * setting.bodies.masses.sum(), 1e-9);
}

}  // namespace
}  // namespace pent::simulator
