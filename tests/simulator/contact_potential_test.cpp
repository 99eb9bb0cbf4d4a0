#include "potentials/contact_potential.h"

#include "potential_laws.h"

namespace pent::simulator {
namespace {

using test::barrier_scene;
using test::Dimensions;
using test::expect_derivatives;
using test::expect_invariance_under_rigid_motion;
using test::gradient_of;
using test::Setting;
using test::shaken;
using test::two_cubes;
using test::value_of;

template <typename T>
class ContactPotentialTest : public testing::Test {};
TYPED_TEST_SUITE(ContactPotentialTest, Dimensions);

TYPED_TEST(ContactPotentialTest, ABarrierHasTheDerivativesOfItsEnergy) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(barrier_scene<kDim>(), 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies, setting.held);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.006, 12);
    ASSERT_GT(value_of<kDim>(contact, x), 0);
    ASSERT_GT(contact.contacts().pair_count, 0U);
    ASSERT_GT(contact.summary().obstacle, 0);
    expect_derivatives<kDim>(setting, contact, x, 1e-6);
}

TYPED_TEST(ContactPotentialTest, ABarrierBetweenBodiesPushesBothAlike) {
    constexpr int kDim = TypeParam::value;
    Scene scene = barrier_scene<kDim>();
    scene.obstacles.clear();
    const Setting<kDim> setting(scene, 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies, setting.held);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.006, 13);
    ASSERT_GT(value_of<kDim>(contact, x), 0);
    expect_invariance_under_rigid_motion<kDim>(contact, x);
}

// A barrier doubles its stiffness where a gap is small, up to 1e8 times that of the scene.
TYPED_TEST(ContactPotentialTest, ABarrierIsStiffenedUpToItsLimit) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(barrier_scene<kDim>(), 1);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies, setting.held);
    const auto above_floor = [&](double gap) {
        Positions<kDim> x = setting.bodies.rest();
        x.row(1).array() += gap - 0.02 - x.row(1).minCoeff();
        return x;
    };
    const double most = 1e8 * contact.stiffness();
    contact.set_stiffness(0.75 * most);
    const Positions<kDim> start = above_floor(1e-4);
    ASSERT_GT(value_of<kDim>(contact, start), 0);
    static_cast<void>(contact.begin_step({start, start, start, start}));
    ASSERT_GT(value_of<kDim>(contact, above_floor(1e-5)), 0);
    EXPECT_TRUE(contact.adapt());
    EXPECT_EQ(contact.stiffness(), most);
    ASSERT_GT(value_of<kDim>(contact, above_floor(1e-6)), 0);
    EXPECT_FALSE(contact.adapt());
    EXPECT_EQ(contact.stiffness(), most);
}

// Two cubes, the second on a corner over the middle of the first, at a fraction of the distance of
// contact.
template <int Dim>
Positions<Dim> on_a_corner(const Bodies<Dim>& bodies) {
    Positions<Dim> x = bodies.rest();
    auto second = x.rightCols(bodies.vertices(1).size);
    const Eigen::Matrix<double, Dim, 1> middle = second.rowwise().mean();
    Eigen::Matrix<double, Dim, 1> diagonal = Eigen::Matrix<double, Dim, 1>::Ones().normalized();
    const auto turn = Eigen::Matrix<double, Dim, Dim>(
        Eigen::Matrix<double, Dim, Dim>::Identity()
        - 2 * (diagonal - Eigen::Matrix<double, Dim, 1>::Unit(1)).normalized()
              * (diagonal - Eigen::Matrix<double, Dim, 1>::Unit(1)).normalized().transpose());
    second = (turn * (second.colwise() - middle)).eval();  // mirrored, which a cube does not mind
    const double lowest = second.row(1).minCoeff();
    second.colwise() += Eigen::Matrix<double, Dim, 1>::Constant(0.23);
    second.row(1).array() += 0.5 + 0.02 - lowest - 0.23;
    return x;
}

template <int Dim>
std::vector<std::array<std::uint32_t, Dim + 1>> pairs_at(ContactPotential<Dim>& contact,
                                                         const Positions<Dim>& x) {
    static_cast<void>(value_of<Dim>(contact, x));
    std::vector<std::array<std::uint32_t, Dim + 1>> pairs;
    for (const contact::Contact<Dim>& pair : contact.contacts().list) {
        pairs.push_back(pair.vertices);
    }
    return pairs;
}

// Of a penalty the gradient is that of the energy between vertices and facets, but for the moment
// in which another facet becomes the nearest. Mixed pairs fade towards the ends of their edges by a
// share that is held; the Hessian holds the weights of closest points. Where neither moves, at
// obstacles, that is tested below.

TYPED_TEST(ContactPotentialTest, APenaltyOfVerticesAndFacetsHasTheGradientOfItsEnergy) {
    constexpr int kDim = TypeParam::value;
    constexpr double kStep = 1e-6;
    const Setting<kDim> setting(two_cubes<kDim>(0.03), 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies, setting.held);
    int compared = 0;
    for (unsigned seed = 0; seed < 10; ++seed) {
        const Positions<kDim> x = shaken<kDim>(on_a_corner<kDim>(setting.bodies), 1e-3, seed);
        ASSERT_GT(value_of<kDim>(contact, x), 0);
        ASSERT_EQ(contact.summary().mixed, 0);
        expect_invariance_under_rigid_motion<kDim>(contact, x);
        const Positions<kDim> gradient = gradient_of<kDim>(contact, x);
        const Positions<kDim> way = shaken<kDim>(0 * x, 1, 200 + seed);
        const Positions<kDim> ahead = x + kStep * way;
        const Positions<kDim> behind = x - kStep * way;
        if (pairs_at<kDim>(contact, ahead) != pairs_at<kDim>(contact, behind)) {
            continue;
        }
        EXPECT_NEAR(
            (value_of<kDim>(contact, ahead) - value_of<kDim>(contact, behind)) / (2 * kStep),
            gradient.cwiseProduct(way).sum(), 1e-6 * gradient.norm() * way.norm());
        ++compared;
    }
    EXPECT_GT(compared, 5);
}

TYPED_TEST(ContactPotentialTest, APenaltyPushesBothBodiesAlikeAndDoesNotSeeRigidMotions) {
    constexpr int kDim = TypeParam::value;
    const Setting<kDim> setting(two_cubes<kDim>(0.03), 2);
    ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies, setting.held);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.006, 14);
    ASSERT_GT(value_of<kDim>(contact, x), 0);
    ASSERT_GT(contact.summary().mixed, 0);
    expect_invariance_under_rigid_motion<kDim>(contact, x);
}

TYPED_TEST(ContactPotentialTest, AnObstacleHasTheDerivativesOfItsEnergy) {
    constexpr int kDim = TypeParam::value;
    const Eigen::VectorXd up = Eigen::VectorXd::Unit(kDim, 1);
    const Eigen::VectorXd middle = Eigen::VectorXd::Constant(kDim, 0.125);
    const std::vector<ObstacleShape> shapes = {
        HalfSpaceObstacle{.normal = up, .offset = 0.1},
        BallObstacle{.center = -0.3 * up, .radius = 0.4},
        CavityObstacle{.center = middle, .radius = 0.2},
        BowlObstacle{.center = middle, .radius = 0.2, .up = up},
        BoxObstacle{.center = middle - 0.2 * up, .sides = Eigen::VectorXd::Constant(kDim, 0.3)}};
    for (const ObstacleShape& shape : shapes) {
        Scene scene = test::box_scene<kDim>();
        scene.obstacles = {{.shape = shape, .distance = 0.05, .stiffness = 700}};
        scene.contact = ContactSettings{.filter = Filter::None};
        const Setting<kDim> setting(scene, 1);
        ContactPotential<kDim> contact(setting.workers, setting.scene, setting.bodies,
                                       setting.held);
        const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.02, 16);
        ASSERT_GT(value_of<kDim>(contact, x), 0);
        expect_derivatives<kDim>(setting, contact, x, 1e-6);
    }
}

}  // namespace
}  // namespace pent::simulator
