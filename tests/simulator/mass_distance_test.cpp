#include "potentials/mass_distance.h"

#include "potential_laws.h"

namespace pent::simulator {
namespace {

using test::Dimensions;
using test::expect_derivatives;
using test::Setting;
using test::shaken;
using test::value_of;

template <typename T>
class MassDistanceTest : public testing::Test {};
TYPED_TEST_SUITE(MassDistanceTest, Dimensions);

TYPED_TEST(MassDistanceTest, IsHalfTheSquaredDistanceOfWhatIsSolvedFor) {
    constexpr int kDim = TypeParam::value;
    Scene scene = test::box_scene<kDim>();
    scene.constraints = {
        test::hold(HalfSpaceSelection{.normal = Eigen::VectorXd::Unit(kDim, 0), .offset = 0.01},
                   test::still(kDim))};
    const Setting<kDim> setting(scene, 1);
    ASSERT_LT(setting.dofs.count(), setting.dofs.vertex_count());
    MassDistance<kDim> inertia(setting.workers, std::make_shared<const DofMap>(setting.dofs),
                               setting.bodies.masses);
    const Positions<kDim> anchor = shaken<kDim>(setting.bodies.rest(), 0.2, 2);
    inertia.set_anchor(std::make_shared<const Positions<kDim>>(anchor));
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.2, 3);
    expect_derivatives<kDim>(setting, inertia, x);
    double expected = 0;
    for (const std::uint32_t vertex : setting.dofs.vertices()) {
        expected += 0.5 * setting.bodies.masses[vertex]
                    * (x.col(vertex) - anchor.col(vertex)).squaredNorm();
    }
    EXPECT_NEAR(value_of<kDim>(inertia, x), expected, 1e-12 * expected);
    EXPECT_EQ(value_of<kDim>(inertia, anchor), 0);
}

}  // namespace
}  // namespace pent::simulator
