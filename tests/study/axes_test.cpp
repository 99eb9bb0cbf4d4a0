#include "axes.h"

#include "scene.h"
#include "support/messages.h"

#include <pent/runs/scene_file.h>

#include <gtest/gtest.h>

namespace pent::study {
namespace {

using pent::test::error_of;
using pent::test::expect_contains;
using pent::test::TempFolder;

simulator::Scene bar_scene(const TempFolder& folder) {
    return runs::read_scene(test::write_bar(folder));
}

TEST(ParseAxis, TakesANameAndItsValues) {
    const Axis axis = parse_axis("dt=1/30,0.01");
    EXPECT_EQ(axis.name, "dt");
    EXPECT_EQ(axis.values, (std::vector<std::string>{"1/30", "0.01"}));
}

TEST(ParseAxis, RefusesWhatIsNotOne) {
    for (const std::string text : {"dt", "=1", "dt=", "dt=1,,2", "dt=1,2,1"}) {
        expect_contains(error_of([&] { static_cast<void>(parse_axis(text)); }), {text});
    }
}

TEST(ParseAxis, TakesAListOrATableAsOneValue) {
    EXPECT_EQ(parse_axis("scene.gravity=[0,-9.8,0,0],[0,-1,0,0]").values,
              (std::vector<std::string>{"[0,-9.8,0,0]", "[0,-1,0,0]"}));
    EXPECT_EQ(parse_axis("constraint.motion={translate=[0,0,0,0]}").values,
              (std::vector<std::string>{"{translate=[0,0,0,0]}"}));
}

TEST(ParseAxis, KnowsAnAxisByItsPath) {
    EXPECT_EQ(parse_axis("solver.elements=linear").name, "elements");
    EXPECT_EQ(parse_axis("solver.preset=fast").name, "preset");
    EXPECT_EQ(parse_axis("contact.model=barrier").name, "contact");
    EXPECT_EQ(parse_axis("contact.stiffness=1").name, "contact.stiffness");
    EXPECT_EQ(parse_axis("body.material.young=1").name, "body.material.young");
}

TEST(Combinations, AreAllOfThemWithTheLastAxisFastest) {
    const std::vector<Settings> all = combinations({{"a", {"1", "2"}}, {"b", {"x", "y", "z"}}});
    ASSERT_EQ(all.size(), 6U);
    EXPECT_EQ(settings_text(all[0]), "a=1 b=x");
    EXPECT_EQ(settings_text(all[1]), "a=1 b=y");
    EXPECT_EQ(settings_text(all[5]), "a=2 b=z");
    EXPECT_EQ(combinations({}).size(), 1U);
}

TEST(FileName, HasNoSeparatorsOfFolders) {
    EXPECT_EQ(file_name({{"dt", "1/60"}, {"filter", "none"}}), "dt-1_60.filter-none");
}

TEST(WithSettings, TakesTimeStepsAsWholePartsOfAFrame) {
    const TempFolder folder;
    const simulator::Scene scene = bar_scene(folder);
    EXPECT_EQ(with_settings(scene, {{"dt", "1/30"}}).steps_per_frame, 1);
    EXPECT_EQ(with_settings(scene, {{"dt", "1/240"}}).steps_per_frame, 8);
    EXPECT_DOUBLE_EQ(with_settings(scene, {{"dt", "1/240"}}).dt(), 1.0 / 240);
    expect_contains(error_of([&] {
                        static_cast<void>(with_settings(scene, {{"dt", "1/200"}}));
                    }),
                    {"1/200", "1/210"});
    for (const std::string bad : {"0", "-1", "x", "1/", "1/0", "1/30s", ""}) {
        expect_contains(error_of([&] {
                            static_cast<void>(with_settings(scene, {{"dt", bad}}));
                        }),
                        {"dt=" + bad});
    }
}

TEST(WithSettings, SetsEveryKeyOfTheSolver) {
    const TempFolder folder;
    const simulator::Scene scene = bar_scene(folder);
    EXPECT_EQ(with_settings(scene, {{"integrator", "bdf2"}}).solver.integrator,
              simulator::Integrator::Bdf2);
    EXPECT_EQ(with_settings(scene, {{"precision", "double"}}).solver.precision,
              simulator::Precision::Double);
    EXPECT_EQ(with_settings(scene, {{"tolerance", "1e-6"}}).solver.tolerance, 1e-6);
    EXPECT_EQ(with_settings(scene, {{"filter", "absolute"}}).solver.filter,
              simulator::Filter::Absolute);
}

TEST(WithSettings, SetsAKeyOfEveryBlockOfAName) {
    const TempFolder folder;
    simulator::Scene scene = bar_scene(folder);
    expect_contains(error_of([&] {
                        check_setting(scene, {"attachment.stiffness", "3"});
                    }),
                    {"--vary attachment.stiffness=3: the scene has no [[attachment]]"});
    simulator::Attachment attachment;
    attachment.body = "bar";
    attachment.select = {simulator::EverythingSelection{}};
    scene.attachments = {attachment, attachment};
    scene.contact = simulator::ContactSettings{};
    const simulator::Scene changed =
        with_settings(scene, {{"attachment.stiffness", "3e4"}, {"contact.stiffness", "7"}});
    EXPECT_EQ(changed.attachments[0].stiffness, 3e4);
    EXPECT_EQ(changed.attachments[1].stiffness, 3e4);
    EXPECT_EQ(changed.contact->stiffness, 7);
    expect_contains(error_of([&] {
                        check_setting(scene, {"attachment.stifness", "3"});
                    }),
                    {"--vary attachment.stifness: is not known; did you mean"
                     " attachment.stiffness?"});
    expect_contains(error_of([&] {
                        check_setting(scene, {"attachment.stiffness", "-1"});
                    }),
                    {"--vary attachment.stiffness=-1", "above 0"});
}

TEST(WithSettings, ReachesKeysWithinTablesAndLists) {
    const TempFolder folder;
    const simulator::Scene scene = bar_scene(folder);
    const simulator::Scene changed = with_settings(
        scene, {{"body.material.density", "500"}, {"constraint.select.half_space.offset", "0.2"}});
    EXPECT_EQ(changed.bodies[0].material.density, 500);
    EXPECT_EQ(std::get<simulator::HalfSpaceSelection>(changed.constraints[0].select[0]).offset,
              0.2);
    expect_contains(error_of([&] {
                        check_setting(scene, {"body.material.second_invariant", "0.2"});
                    }),
                    {"--vary body.material.second_invariant=0.2: ", "goes with", "mooney-rivlin"});
}

TEST(WithSettings, TakesAPresetInPlaceOfAllKeysOfTheSolver) {
    const TempFolder folder;
    const simulator::Scene scene =
        runs::read_scene(test::write_bar(folder, "[solver]\nfilter = \"none\"\n"));
    const simulator::Scene accurate = with_settings(scene, {{"preset", "accurate"}});
    EXPECT_EQ(accurate.solver.integrator, simulator::Integrator::Bdf2);
    EXPECT_EQ(accurate.solver.filter, simulator::Filter::Clamp);
    EXPECT_EQ(accurate.bodies.size(), 1U);
    EXPECT_EQ(accurate.constraints.size(), 1U);
}

TEST(WithSettings, TakesQuadraticElementsWithThePresetThatHasThemWhereTheMeshHas) {
    const TempFolder folder;
    const simulator::Scene scene = bar_scene(folder);
    const auto elements = [&](const char* preset) {
        return with_settings(scene, {{"preset", preset}}).solver.elements;
    };
    EXPECT_EQ(elements("accurate"), simulator::ElementKind::Linear);
    write_mesh(folder / "bar.pent", pent::test::quadratic_kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1}));
    EXPECT_EQ(elements("accurate"), simulator::ElementKind::Quadratic);
    EXPECT_EQ(elements("balanced"), simulator::ElementKind::Linear);
    EXPECT_EQ(
        with_settings(scene, {{"preset", "accurate"}, {"elements", "smoothed"}}).solver.elements,
        simulator::ElementKind::Smoothed);
}

TEST(WithSettings, LeavesEverythingElseAsItIs) {
    const TempFolder folder;
    const simulator::Scene scene = bar_scene(folder);
    simulator::Scene changed = with_settings(scene, {{"integrator", "bdf2"}});
    changed.solver.integrator = scene.solver.integrator;
    EXPECT_EQ(runs::scene_text(changed), runs::scene_text(scene));
}

// Frames that are at other times cannot be compared, nor those of another body.
TEST(CheckSetting, RefusesWhatRunsMustHaveInCommon) {
    const TempFolder folder;
    const simulator::Scene scene = bar_scene(folder);
    const auto message = [&](const std::string& axis, const std::string& value) {
        return error_of([&] { check_setting(scene, {axis, value}); });
    };
    expect_contains(message("scene.frames", "2"), {"--vary scene.frames:", "--frames"});
    expect_contains(message("scene.frames_per_second", "60"), {"--vary scene.frames_per_second:"});
    expect_contains(message("scene.steps_per_frame", "2"), {"vary dt instead"});
    expect_contains(message("body.mesh", "a.pent"), {"--vary body.mesh:", "layers or subdivide"});
    expect_contains(message("body.recipe", "x"), {"--vary body.recipe:", "layers or subdivide"});
}

TEST(CheckSetting, NamesTheNearestAxisAndRefusesBadValues) {
    const TempFolder folder;
    const simulator::Scene scene = bar_scene(folder);
    const auto message = [&](const std::string& axis, const std::string& value) {
        return error_of([&] { check_setting(scene, {axis, value}); });
    };
    expect_contains(message("intgrator", "bdf2"), {"intgrator", "integrator"});
    expect_contains(message("integrator", "bdf3"), {"bdf3", "bdf2"});
    expect_contains(message("tolerance", "2"), {"tolerance=2"});
    expect_contains(message("contact", "penalty"), {"no [contact]"});
    EXPECT_EQ(message("integrator", "foo").rfind("--vary integrator=foo: \"integrator\" is", 0), 0U)
        << "no line and column of a text that nobody sees";
    expect_contains(message("preset", "foo"), {"--vary preset=foo: ", "\"balanced\""});
    EXPECT_EQ(message("young", "1e5"),
              "--vary young: is not known; did you mean body.material.young or"
              " body.region.material.young?");
    EXPECT_EQ(message("layer", "2"), "--vary layer: is not known; did you mean layers?");
    EXPECT_EQ(message("whatever", "1"),
              "--vary whatever: is not known; expected dt, layers, subdivide, contact, a key of"
              " [solver], or the path of another key, as attachment.stiffness");
    expect_contains(message("max_iterations", "1e3"), {"\"max_iterations\" is 1000;", "whole"});
    expect_contains(message("dt", "1e-9"), {"\"steps_per_frame\" is 33333333", "1000000"});
    for (const char* count : {"0", "-1", "x", "1.5", ""}) {
        expect_contains(message("layers", count), {"expected a whole number of at least 1"});
    }
}

TEST(WithSettings, DoNotDependOnTheirOrder) {
    const TempFolder folder;
    simulator::Scene scene = bar_scene(folder);
    scene.contact = simulator::ContactSettings{};
    const Setting barrier{"contact", "barrier"};  // not with linear_euler, which the scene has
    const Setting newton{"integrator", "newton_euler"};
    const Setting preset{"preset", "fast"};
    EXPECT_EQ(runs::scene_text(with_settings(scene, {barrier, newton, preset})),
              runs::scene_text(with_settings(scene, {preset, newton, barrier})));
    const simulator::Scene all = with_settings(scene, {barrier, newton, preset, {"dt", "1/60"}});
    EXPECT_EQ(all.contact->model, simulator::ContactModel::Barrier);
    EXPECT_EQ(all.solver.tolerance, 1e-2);  // of the preset
    EXPECT_EQ(all.steps_per_frame, 2);
}

TEST(WithSettings, RefuseWhatDoesNotGoTogetherThoughEachIsRight) {
    const TempFolder folder;
    simulator::Scene scene = bar_scene(folder);
    scene.contact = simulator::ContactSettings{};
    const Setting barrier{"contact", "barrier"};
    EXPECT_NO_THROW(check_setting(scene, barrier));
    expect_contains(error_of([&] { static_cast<void>(with_settings(scene, {barrier})); }),
                    {"barrier", "newton_euler"});
}

}  // namespace
}  // namespace pent::study
