#include "contact_scenes.h"
#include "support/messages.h"

#include <pent/error.h>

#include <gtest/gtest.h>

// Which bodies see each other, and how rough each is.

namespace pent::simulator {
namespace {

using test::cube;
using test::two_cubes;

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

template <typename T>
class ContactByPair : public testing::Test {};
TYPED_TEST_SUITE(ContactByPair, Dimensions);

// The first step of two cubes in contact with each other; with a third one, c, upon b.
template <int Dim>
ContactSummary first_step(const Scene& scene) {
    std::vector<SimplexMesh<Dim>> meshes(scene.bodies.size(), cube<Dim>(1));
    const StepReport report = Simulation<Dim>(scene, std::move(meshes)).step();
    EXPECT_TRUE(report.is_accepted) << report.failure;
    return report.contact;
}

template <int Dim>
Scene three_cubes() {
    Scene scene = two_cubes<Dim>(0);
    scene.bodies[1].place.translate[1] = 0.26;
    scene.bodies.push_back(scene.bodies[1]);
    scene.bodies[2].name = "c";
    scene.bodies[2].place.translate[1] = 0.52;
    scene.solver.integrator = Integrator::NewtonEuler;
    return scene;
}

TYPED_TEST(ContactByPair, IsNotBetweenThoseThatIgnoreEachOtherNorBeyondTheOnlyOnes) {
    constexpr int kDim = TypeParam::value;
    for (const ContactModel model : {ContactModel::Penalty, ContactModel::Barrier}) {
        Scene scene = three_cubes<kDim>();
        scene.contact->model = model;
        const auto count = [&] {
            const ContactSummary contact = first_step<kDim>(scene);
            return contact.point_facet + contact.mixed;
        };
        const std::int64_t all = count();
        scene.contact->ignore = {{"b", "a"}};
        const std::int64_t of_bc = count();
        EXPECT_GT(of_bc, 0);
        EXPECT_LT(of_bc, all);
        scene.contact->only = {{"c", "b"}};
        EXPECT_EQ(count(), of_bc);
        scene.contact->only = {{"a", "c"}};  // which are far apart
        EXPECT_EQ(count(), 0);
        scene.contact->ignore.clear();
        scene.contact->only = {{"a", "b"}, {"b", "c"}};
        EXPECT_EQ(count(), all);
    }
}

// Bodies that ignore each other may be in each other from the start, under a barrier too.
TYPED_TEST(ContactByPair, LetsThoseThatIgnoreEachOtherPassThroughEachOther) {
    constexpr int kDim = TypeParam::value;
    Scene scene = two_cubes<kDim>(-0.3);
    scene.contact->model = ContactModel::Barrier;
    scene.solver.integrator = Integrator::NewtonEuler;
    EXPECT_THROW(static_cast<void>(first_step<kDim>(scene)), Error);
    scene.contact->ignore = {{"a", "b"}};
    const ContactSummary contact = first_step<kDim>(scene);
    EXPECT_EQ(contact.point_facet + contact.mixed + contact.candidates, 0);
}

TYPED_TEST(ContactByPair, LeavesSingleBodiesOutOfContactWithThemselves) {
    constexpr int kDim = TypeParam::value;
    for (const bool ignores : {false, true}) {
        Scene scene = test::box_scene<kDim>();
        scene.contact = ContactSettings{.distance = 0.05, .stiffness = 2e3, .self = true};
        if (ignores) {
            scene.contact->ignore = {{"box", "box"}};
        }
        Simulation<kDim> simulation(scene, {cube<kDim>()});
        // Pressed flat: its sides are nearer to each other than the distance of contact.
        Positions<kDim> flat = simulation.positions(0);
        flat.row(0) *= 0.01;
        simulation.set_state(0, flat, simulation.velocities(0));
        EXPECT_EQ(simulation.step().contact.candidates > 0, !ignores);
    }
}

// On a floor that slopes by 30 degrees, of tan 30 = 0.58: a body stays where the geometric mean of
// both coefficients is more, and slides where it is less; whether the body or the floor has its
// own.
TYPED_TEST(ContactByPair, HasTheFrictionOfBothSides) {
    constexpr int kDim = TypeParam::value;
    for (const auto& [of_body, of_floor] :
         {std::pair(1.0, 0.8), std::pair(0.2, 0.8), std::pair(0.8, 1.0), std::pair(0.8, 0.2)}) {
        Scene scene = test::box_scene<kDim>();
        scene.gravity = 9.8
                        * (std::sin(0.5236) * Eigen::VectorXd::Unit(kDim, 0)
                           - std::cos(0.5236) * Eigen::VectorXd::Unit(kDim, 1));
        scene.obstacles = {
            {.shape = HalfSpaceObstacle{.normal = Eigen::VectorXd::Unit(kDim, 1), .offset = -0.015},
             .stiffness = 2e4}};
        scene.contact = ContactSettings{.distance = 0.02, .stiffness = 2e4, .friction = 0.8};
        (of_floor == 0.8 ? scene.bodies[0].friction : scene.obstacles[0].friction) =
            of_floor == 0.8 ? of_body : of_floor;
        scene.solver.integrator = Integrator::NewtonEuler;
        scene.frames_per_second = 100;
        Simulation<kDim> simulation(scene, {cube<kDim>(1)});
        const auto speed_later = [&] {
            for (int i = 0; i < 50; ++i) {
                EXPECT_TRUE(simulation.step().is_accepted);
            }
            return test::mean_velocity<kDim>(simulation, 0)[0];
        };
        // It hops until it has settled, half a second later. From then on g (sin - mu cos) t, with
        // mu = sqrt(0.16); what is left of hopping is a hundredth of that.
        const double before = speed_later();
        const double gained = speed_later() - before;
        if (of_body * of_floor == 0.8) {
            EXPECT_LT(std::abs(before + gained), 0.01);
        } else {
            const double expected = 0.5 * 9.8 * (std::sin(0.5236) - 0.4 * std::cos(0.5236));
            EXPECT_NEAR(gained, expected, 0.03 * expected);
        }
    }
}

TEST(ContactPairs, OfBodiesThatAreNotThereAreRefused) {
    Scene scene = two_cubes<3>(1);
    scene.contact->ignore = {{"a", "bb"}};
    pent::test::expect_contains(pent::test::error_of([&] { check(scene); }),
                                {"contact: no body is called \"bb\"; did you mean \"b\"?"});
}

}  // namespace
}  // namespace pent::simulator
