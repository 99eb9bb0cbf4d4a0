#include "potentials/scene_energy.h"

#include "potential_laws.h"

#include <numeric>
#include <string>
#include <vector>

namespace pent::simulator {
namespace {

using test::barrier_scene;
using test::Dimensions;
using test::gradient_of;
using test::Setting;
using test::shaken;
using test::two_cubes;
using test::value_of;

template <typename T>
class SceneEnergyTest : public testing::Test {};
TYPED_TEST_SUITE(SceneEnergyTest, Dimensions);

// The sum of a scene is that of its terms, with nothing in it that the scene does not ask for.

TYPED_TEST(SceneEnergyTest, TheSumHasTheTermsOfTheSceneAndNoOthers) {
    constexpr int kDim = TypeParam::value;
    const auto names = [](const Scene& scene) {
        const Setting<kDim> setting(scene, 1);
        SceneEnergy<kDim> energy(setting.workers, setting.isa, setting.bodies, setting.held,
                                 setting.scene);
        energy.sum.update(setting.bodies.rest());
        std::vector<std::string> list;
        for (const TermEnergy& term : energy.sum.energies()) {
            list.emplace_back(term.name);
        }
        return list;
    };
    Scene scene = two_cubes<kDim>(0.03);
    scene.contact.reset();
    EXPECT_EQ(names(scene), (std::vector<std::string>{"elastic"}));
    scene.gravity[1] = -9.8;
    EXPECT_EQ(names(scene), (std::vector<std::string>{"gravity", "elastic"}));
    scene.contact = ContactSettings{.distance = 0.05, .stiffness = 2e3, .friction = 0.3};
    EXPECT_EQ(names(scene),
              (std::vector<std::string>{"gravity", "elastic", "contact", "friction"}));
    scene.contact.reset();
    scene.obstacles = barrier_scene<kDim>().obstacles;
    EXPECT_EQ(names(scene), (std::vector<std::string>{"gravity", "elastic", "obstacle"}));
}

// There is friction where anything has some, whatever else there is.
TYPED_TEST(SceneEnergyTest, HasFrictionIfAnyBodyObstacleOrContactHas) {
    constexpr int kDim = TypeParam::value;
    for (int which = -1; which < 5; ++which) {
        Scene scene = two_cubes<kDim>(0.03);
        scene.obstacles.assign(2, barrier_scene<kDim>().obstacles.front());
        scene.contact->friction = which == 0 ? 0.3 : 0;
        for (std::size_t i = 0; i < 2; ++i) {
            scene.bodies[i].friction = which == 1 + static_cast<int>(i) ? 0.3 : 0;
            scene.obstacles[i].friction = which == 3 + static_cast<int>(i) ? 0.3 : 0;
        }
        const Setting<kDim> setting(scene, 1);
        const SceneEnergy<kDim> energy(setting.workers, setting.isa, setting.bodies, setting.held,
                                       setting.scene);
        EXPECT_EQ(energy.friction != nullptr, which >= 0) << which;
    }
}

TYPED_TEST(SceneEnergyTest, TheSumIsThatOfItsTerms) {
    constexpr int kDim = TypeParam::value;
    Scene scene = barrier_scene<kDim>();
    scene.gravity[1] = -9.8;
    scene.contact->friction = 0.3;
    const Setting<kDim> setting(scene, 1);
    SceneEnergy<kDim> energy(setting.workers, setting.isa, setting.bodies, setting.held,
                             setting.scene);
    const Positions<kDim> x = shaken<kDim>(setting.bodies.rest(), 0.006, 21);
    energy.sum.update(x);
    double value = 0;
    Positions<kDim> gradient = Positions<kDim>::Zero(kDim, x.cols());
    for (const auto& term : energy.sum.terms()) {
        value += value_of<kDim>(*term, x);
        gradient += gradient_of<kDim>(*term, x);
    }
    EXPECT_NEAR(energy.sum.value(), value, 1e-12 * std::abs(value));
    EXPECT_LT((energy.sum.gradient() - gradient).norm(), 1e-12 * gradient.norm());
    const std::vector<TermEnergy> parts = energy.sum.energies();
    EXPECT_NEAR(
        std::accumulate(parts.begin(), parts.end(), 0.0,
                        [](double sum, const TermEnergy& part) { return sum + part.energy; }),
        value, 1e-12 * std::abs(value));
}

}  // namespace
}  // namespace pent::simulator
