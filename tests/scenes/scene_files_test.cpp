#include <pent/runs/scene_file.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

// The files in data/scenes: they are read, say how their meshes are made, and keep to the paper.

namespace pent::simulator {
namespace {

std::vector<std::string> scene_names() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(PENT_SCENES)) {
        names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::filesystem::path path_of(const std::string& name) {
    return std::filesystem::path(PENT_SCENES) / (name + ".toml");
}

class EveryScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryScene, IsReadAndHasARecipeForEachMeshAndAnExpectation) {
    const Scene scene = runs::read_scene(path_of(GetParam()));
    std::ifstream file(path_of(GetParam()));
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    for (const Body& body : scene.bodies) {
        const std::string mesh = std::filesystem::path(body.mesh).filename().string();
        EXPECT_NE(text.find(" -o " + mesh), std::string::npos) << mesh;
    }
    EXPECT_NE(text.find("# Mesh: pent-mesh "), std::string::npos);
    EXPECT_NE(text.find("# Slices: "), std::string::npos);
    EXPECT_NE(text.find("# Picture: "), std::string::npos);
    EXPECT_NE(text.find("Expected: "), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(All, EveryScene, testing::ValuesIn(scene_names()), [](const auto& one) {
    return one.param;
});

// Table 1 of [shi2025]: the step, and distance and stiffness of contact where the scene has it.
struct Row {
    const char* scene;
    double steps_per_second;
    double distance;
    double stiffness;
};

// What GoogleTest prints of a row.
void PrintTo(const Row& row, std::ostream* out) {  // NOLINT(readability-identifier-naming)
    *out << row.scene;
}

class PaperScene : public testing::TestWithParam<Row> {};

TEST_P(PaperScene, HasTheStepAndTheContactOfTheTable) {
    const Scene scene = runs::read_scene(path_of(GetParam().scene));
    EXPECT_NEAR(1 / scene.dt(), GetParam().steps_per_second, 1e-9);
    EXPECT_EQ(scene.contact.has_value(), GetParam().distance > 0);
    if (scene.contact) {
        EXPECT_EQ(scene.contact->distance, GetParam().distance);
        EXPECT_EQ(scene.contact->stiffness, GetParam().stiffness);
        EXPECT_TRUE(scene.contact->self);
    }
}

INSTANTIATE_TEST_SUITE_P(All,
                         PaperScene,
                         testing::Values(Row{"rotating_bunny", 30, 2e-2, 1000},
                                         Row{"armadillo_hug", 200, 8e-2, 3000},
                                         Row{"alien_twist", 150, 5e-2, 3000},
                                         Row{"octopus_twist", 100, 4e-2, 3000},
                                         Row{"thin_wring", 150, 3e-2, 3000},
                                         Row{"thick_wring", 150, 4e-2, 3000},
                                         Row{"cantilevers", 30, 2e-2, 3000},
                                         Row{"noodles", 150, 8e-2, 3000}),
                         [](const auto& one) { return std::string(one.param.scene); });

TEST(Cantilevers, HaveThePapersRatiosOfStiffness) {
    const Scene scene = runs::read_scene(path_of("cantilevers"));
    ASSERT_EQ(scene.bodies.size(), 5U);
    const double softest = young_from_lame(4, scene.bodies[0].material.lame).young;
    const std::vector<double> expected = {275, 550, 1010, 2000, 4000};
    for (std::size_t i = 0; i < 5; ++i) {
        const double young = young_from_lame(4, scene.bodies[i].material.lame).young;
        EXPECT_NEAR(young / softest, expected[i] / expected[0], 1e-12);
    }
}

// A prism of length 20 over a ball of radius 1 has 80 pi / 3, half a 4D ball of radius 6 has
// pi^2 / 4 6^4: 13.1%. In 3D, 20 pi over 2 pi / 3 6^3, five times, is 69.4%.
TEST(Noodles, FillAnEighthOfTheBowlTheyFallInto) {
    const Scene scene = runs::read_scene(path_of("noodles"));
    ASSERT_EQ(scene.bodies.size(), 5U);
    const auto& bowl = std::get<BowlObstacle>(scene.obstacles.at(0).shape);
    EXPECT_EQ(bowl.radius, 6);
    using std::numbers::pi;
    const double noodles = 5 * 20 * 4 * pi / 3;
    EXPECT_NEAR(noodles / (pi * pi / 4 * std::pow(bowl.radius, 4)), 0.131, 0.0005);
    EXPECT_NEAR(5 * 20 * pi / (2 * pi / 3 * std::pow(bowl.radius, 3)), 0.694, 0.0005);
}

}  // namespace
}  // namespace pent::simulator
