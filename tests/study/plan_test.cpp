#include "plan.h"

#include "support/messages.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <fstream>

namespace pent::study {
namespace {

TEST(Plan, IsReadBackAsItWasWritten) {
    const pent::test::TempFolder folder;
    const Plan plan{.scene = "/a\"b.toml",
                    .frames = 3,
                    .scene_frames = 40,
                    .repeats = 5,
                    .threads = 7,
                    .keep_runs = true,
                    .reference_integrator = "bdf2",
                    .reference = "text\n# meshes 7\n",
                    .units = {{.kind = UnitKind::Reference, .name = "references/steps-2"},
                              {.name = "runs/x",
                               .settings = {{"dt", "1/30"}, {"preset", "fast"}},
                               .scene = "0123456789abcdef",
                               .meshes = 4'000'000'000,
                               .refusal = "no"}}};
    write_plan(folder / "plan.json", plan);
    const Plan back = read_plan(folder.path());
    EXPECT_EQ(back.scene, plan.scene);
    EXPECT_EQ(back.frames, 3);
    EXPECT_EQ(back.scene_frames, 40);
    EXPECT_EQ(back.repeats, 5);
    EXPECT_EQ(back.threads, 7);
    EXPECT_TRUE(back.keep_runs);
    EXPECT_EQ(back.reference_integrator, plan.reference_integrator);
    EXPECT_EQ(back.reference, plan.reference);
    EXPECT_EQ(back.level_count(), 1U);
    ASSERT_EQ(back.units.size(), 2U);
    EXPECT_EQ(back.units[0].kind, UnitKind::Reference);
    EXPECT_EQ(back.units[1].kind, UnitKind::Combination);
    EXPECT_EQ(back.units[1].name, "runs/x");
    EXPECT_EQ(back.units[1].settings, plan.units[1].settings);
    EXPECT_EQ(back.units[1].scene, plan.units[1].scene);
    EXPECT_EQ(back.units[1].meshes, 4'000'000'000);
    EXPECT_EQ(back.units[1].refusal, "no");
}

TEST(Plan, ThatIsMissingOrDamagedSaysWhatToDo) {
    const pent::test::TempFolder folder;
    const auto error = [&] {
        return pent::test::error_of([&] { static_cast<void>(read_plan(folder.path())); });
    };
    pent::test::expect_contains(error(), {"no study has been prepared here", "--prepare first"});
    for (const char* text :
         {"", "{}", "[1, 2]", "{\"scene\": 3}", "{\"scene\": \"a\", \"frames\""}) {
        std::ofstream(folder / "plan.json") << text;
        pent::test::expect_contains(error(), {"plan.json: not the plan", "--prepare again"});
    }
}

}  // namespace
}  // namespace pent::study
