#include "pent/viewer/run_folder.h"

#include "runs.h"

#include <pent/error.h>

#include <gtest/gtest.h>

#include <support/temp_folder.h>

namespace pent::viewer {
namespace {

using pent::test::TempFolder;
using test::write_run;

// The message of the Error an action throws, or "none".
template <typename Action>
std::string error_of(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "none";
}

TEST(OpenRun, FindsBodiesByNameAndTheFramesAllOfThemHave) {
    const TempFolder folder;
    write_run(folder.path(), "b", {0, 1, 2, 3});
    write_run(folder.path(), "a_1", {0, 2, 3, 4});
    const RunFolder run = open_run(folder.path());
    EXPECT_EQ(run.bodies, (std::vector<std::string>{"a_1", "b"}));
    EXPECT_EQ(run.frames, (std::vector<int>{0, 2, 3}));
    EXPECT_EQ(run.dimension, 4);
}

TEST(OpenRun, OverlooksTemporaryAndForeignFiles) {
    const TempFolder folder;
    write_run(folder.path(), "a", {0, 1});
    write_text(folder / "frames/.a_000002.pent.77.tmp", "half");
    write_text(folder / "frames/.a_000003.pent", "hidden");
    write_text(folder / "frames/a_notes.pent", "not a frame");
    write_text(folder / "frames/other_000009.pent", "no such body");
    EXPECT_EQ(open_run(folder.path()).frames, (std::vector<int>{0, 1}));
}

TEST(OpenRun, TakesAMeshAsARunOfOneFrame) {
    const TempFolder folder;
    const SimplexMesh<4> mesh = test::jittered_box({1, 1, 1, 1}, 1);
    write_mesh<4>(folder / "box.pent", mesh);
    const RunFolder run = open_run(folder / "box.pent");
    EXPECT_EQ(run.bodies, (std::vector<std::string>{"box"}));
    const std::vector<Body<4>> bodies = load_bodies<4>(run);
    EXPECT_EQ(load_frame<4>(run, bodies[0], 0).positions, mesh.positions);
}

TEST(OpenRun, SaysWhatIsMissing) {
    const TempFolder folder;
    EXPECT_NE(error_of([&] { (void)open_run(folder / "none"); }).find("no such file or folder"),
              std::string::npos);
    EXPECT_NE(error_of([&] { (void)open_run(folder.path()); }).find("meshes"), std::string::npos);
    make_folder(folder / "meshes");
    EXPECT_NE(error_of([&] { (void)open_run(folder.path()); }).find("no .pent mesh"),
              std::string::npos);
    write_run(folder.path(), "a", {});
    EXPECT_NE(error_of([&] { (void)open_run(folder.path()); }).find("no such frame"),
              std::string::npos);
}

TEST(OpenRun, RefusesAFrameInPlaceOfAMesh) {
    const TempFolder folder;
    write_run(folder.path(), "a", {0});
    const std::string error = error_of([&] { (void)open_run(folder / "frames/a_000000.pent"); });
    EXPECT_NE(error.find("is a frame"), std::string::npos) << error;
}

TEST(OpenRun, RefusesDimensionsThatCannotBeSeenTogether) {
    const TempFolder folder;
    write_mesh<2>(folder / "flat.pent", pent::test::kuhn_box<2>({1, 1}, {1, 1}));
    std::string error = error_of([&] { (void)open_run(folder / "flat.pent"); });
    EXPECT_NE(error.find("has dimension 2; expected 3 or 4"), std::string::npos) << error;
    write_run(folder.path(), "a", {0});
    write_mesh<3>(folder / "meshes/b.pent", pent::test::kuhn_box<3>({1, 1, 1}, {1, 1, 1}));
    error = error_of([&] { (void)open_run(folder.path()); });
    EXPECT_NE(error.find("b.pent: has dimension 3; expected 4 as the other bodies have"),
              std::string::npos)
        << error;
}

TEST(OpenRun, RefusesBodiesWithoutACommonFrame) {
    const TempFolder folder;
    write_run(folder.path(), "a", {0, 2});
    write_run(folder.path(), "b", {1, 3});
    const std::string error = error_of([&] { (void)open_run(folder.path()); });
    EXPECT_NE(error.find("frames: no frame that all bodies have"), std::string::npos) << error;
}

TEST(LoadFrame, RefusesAFrameOfAnotherMesh) {
    const TempFolder folder;
    write_run(folder.path(), "a", {0});
    write_mesh<4>(folder / "meshes/a.pent", test::jittered_box({2, 2, 2, 2}, 24));
    const RunFolder run = open_run(folder.path());
    const std::vector<Body<4>> bodies = load_bodies<4>(run);
    const std::string error = error_of([&] { (void)load_frame<4>(run, bodies[0], 0); });
    EXPECT_NE(error.find("another mesh"), std::string::npos) << error;
}

TEST(LoadBodies, RefusesCellsThatDoNotFit) {
    const TempFolder folder;
    SimplexMesh<4> mesh = test::jittered_box({1, 1, 1, 1}, 1);
    mesh.cells.conservativeResize(Eigen::NoChange, 25);
    mesh.cells.col(24) = mesh.cells.col(0);  // one cell twice: its facets are seen from one side
    write_mesh<4>(folder / "twice.pent", mesh);
    const RunFolder run = open_run(folder / "twice.pent");
    const std::string error = error_of([&] { (void)load_bodies<4>(run); });
    EXPECT_NE(error.find("does not fit its neighbors"), std::string::npos) << error;
}

TEST(SelectFrames, TakesRangesWithBothEndsListsAndLast) {
    const std::vector<int> frames = {0, 1, 2, 3, 5, 8};
    EXPECT_EQ(select_frames(frames, ""), frames);
    EXPECT_EQ(select_frames(frames, "1:3"), (std::vector<int>{1, 2, 3}));
    EXPECT_EQ(select_frames(frames, "::2"), (std::vector<int>{0, 2, 8}));
    EXPECT_EQ(select_frames(frames, "3:"), (std::vector<int>{3, 5, 8}));
    EXPECT_EQ(select_frames(frames, ":1"), (std::vector<int>{0, 1}));
    EXPECT_EQ(select_frames(frames, "last,0,last"), (std::vector<int>{0, 8}));
}

TEST(SelectFrames, RefusesWhatItDoesNotUnderstandOrFind) {
    const std::vector<int> frames = {0, 1, 2, 3};
    for (const char* text :
         {"x", "1:x", "1:2:0", "1:2:3:4", "-1", "1,,2", "7", "1.5", "8:9", "3:1"}) {
        EXPECT_THROW((void)select_frames(frames, text), Error) << text;
    }
}

}  // namespace
}  // namespace pent::viewer
