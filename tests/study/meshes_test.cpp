#include "meshes.h"

#include "scene.h"
#include "support/messages.h"

#include <pent/runs/scene_file.h>

#include <gtest/gtest.h>

namespace pent::study {
namespace {

TEST(MeshArguments, TakeTheLevelInPlaceOfTheRecipesOwn) {
    using Words = std::vector<std::string>;
    EXPECT_EQ(mesh_arguments("a.obj --layers 4 --thickness 1", {{"layers", "8"}}),
              (Words{"a.obj", "--layers", "8", "--thickness", "1"}));
    EXPECT_EQ(mesh_arguments("a.obj", {{"dt", "1/30"}, {"subdivide", "2"}}),
              (Words{"a.obj", "--subdivide", "2"}));
    EXPECT_EQ(mesh_arguments("a.obj --subdivide=1", {{"subdivide", "2"}}),
              (Words{"a.obj", "--subdivide=2"}));
}

TEST(MeshArguments, MayHaveBlanksWithinQuotes) {
    EXPECT_EQ(mesh_arguments("'my model.obj' --profile=\"a b.txt\" --layers 4", {{"layers", "8"}}),
              (std::vector<std::string>{"my model.obj", "--profile=a b.txt", "--layers", "8"}));
}

TEST(WithMeshes, KeepsMeshesThatAreThere) {
    const pent::test::TempFolder folder;
    const simulator::Scene scene = runs::read_scene(test::write_bar(folder));
    const StudyOptions options{.scene = folder / "bar.toml", .folder = folder / "study"};
    OutputFolder output(options.folder, kStudyFolder);
    EXPECT_EQ(with_meshes(scene, {}, options, output, {}).bodies[0].mesh,
              std::filesystem::absolute(folder / "bar.pent"));
}

TEST(WithMeshes, NeedsARecipeForLevelsAndForAMeshThatIsMissing) {
    const pent::test::TempFolder folder;
    simulator::Scene scene = runs::read_scene(test::write_bar(folder));
    const StudyOptions options{.scene = folder / "bar.toml", .folder = folder / "study"};
    OutputFolder output(options.folder, kStudyFolder);
    const auto message = [&](const Settings& settings) {
        return pent::test::error_of(
            [&] { static_cast<void>(with_meshes(scene, settings, options, output, {})); });
    };
    pent::test::expect_contains(message({{"layers", "2"}}), {"layers", "recipe"});
    scene.bodies[0].mesh = (folder / "none.pent").string();
    pent::test::expect_contains(message({}), {"none.pent", "recipe"});
}

}  // namespace
}  // namespace pent::study
