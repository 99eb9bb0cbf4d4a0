#include "potentials/force_loads.h"

#include "potential_laws.h"

namespace pent::simulator {
namespace {

using test::Dimensions;
using test::expect_derivatives;
using test::gradient_of;
using test::Setting;
using test::shaken;

template <typename T>
class ForceLoadsTest : public testing::Test {};
TYPED_TEST_SUITE(ForceLoadsTest, Dimensions);

template <int Dim>
Scene pushed_scene() {
    Scene scene = test::box_scene<Dim>();
    const HalfSpaceSelection half{.normal = Eigen::VectorXd::Unit(Dim, 0), .offset = 0.3};
    scene.loads = {{.body = "box",
                    .select = {half},
                    .force = Eigen::VectorXd::LinSpaced(Dim, -2, 5),
                    .keyframes = {{0, 1}, {1, 0.25}}}};
    return scene;
}

// Gravity on a part of the body: no torque about its center of mass, wherever it is.
TYPED_TEST(ForceLoadsTest, AddUpToTheForceThroughTheCenterOfMassOfTheSelection) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(pushed_scene<kDim>(), 2);
    ForceLoads<kDim> loads(setting.scene, setting.bodies);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.1, 3);
    expect_derivatives<kDim>(setting, loads, x);
    const Positions<kDim> forces = -gradient_of<kDim>(loads, x);
    const Eigen::Matrix<double, kDim, 1> force = setting.scene.loads[0].force;
    EXPECT_LT((forces.rowwise().sum() - force).norm(), 1e-13 * force.norm());
    double mass = 0;
    Eigen::Matrix<double, kDim, 1> center = Eigen::Matrix<double, kDim, 1>::Zero();
    for (Eigen::Index v = 0; v < x.cols(); ++v) {
        const bool is_selected = setting.bodies.rest()(0, v) <= 0.3;
        EXPECT_EQ(forces.col(v).norm() > 0, is_selected);
        mass += is_selected ? setting.bodies.masses[v] : 0;
        if (is_selected) {
            center += setting.bodies.masses[v] * x.col(v);
        }
    }
    center /= mass;
    const Eigen::Matrix<double, kDim, kDim> moment = forces * (x.colwise() - center).transpose();
    EXPECT_LT((moment - moment.transpose()).norm(), 1e-13 * moment.norm() + 1e-13);
}

TYPED_TEST(ForceLoadsTest, FollowTheirKeyframesAndSayThatTheBodyIsDriven) {
    constexpr int kDim = TypeParam::value;
    Scene scene = pushed_scene<kDim>();
    scene.bodies.insert(scene.bodies.begin(), scene.bodies[0]);
    scene.bodies[0].name = "other";
    const Setting<kDim> setting(scene, 2);
    ForceLoads<kDim> loads(setting.scene, setting.bodies);
    const Positions<kDim>& x = setting.bodies.rest();
    const Positions<kDim> full = gradient_of<kDim>(loads, x);
    const Eigen::Index half = setting.bodies.first_vertex[1];
    EXPECT_TRUE(full.leftCols(half).isZero(0));
    EXPECT_GT(full.rightCols(half).norm(), 1);
    EXPECT_FALSE(loads.set_time({0, 0}));
    EXPECT_TRUE(loads.set_time({0.9, 1.1}));
    EXPECT_LT((gradient_of<kDim>(loads, x) - 0.25 * full).norm(), 1e-14 * full.norm());
    Couplings during;
    loads.add_couplings(during);
    EXPECT_EQ(during.driven, std::vector<std::size_t>{1});
    EXPECT_FALSE(loads.set_time({1.1, 1.2}));
    Couplings behind;
    loads.add_couplings(behind);
    EXPECT_TRUE(behind.driven.empty());
}

}  // namespace
}  // namespace pent::simulator
