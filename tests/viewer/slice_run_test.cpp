#include "pictures.h"
#include "runs.h"

#include <pent/obstacles_file.h>
#include <pent/viewer/slice.h>
#include <pent/viewer/slice_run.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <support/temp_folder.h>

namespace pent::viewer {
namespace {

using pent::test::TempFolder;
using test::count_files;
using test::floor_and_ball;
using test::go_on;
using test::text_in;
using test::write_run;

TEST(SliceRun, WritesEveryFrameBodyAndSectionWithTheirVolumes) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1});
    write_run(folder / "run", "b", {0, 1});
    const RunFolder run = open_run(folder / "run");
    SliceRunOptions options;
    options.frames = run.frames;
    options.sections.offsets = {0.3, 0.6};
    const SliceRunReport report = slice_run(run, folder / "out", options, go_on);
    EXPECT_TRUE(report.is_complete);
    ASSERT_EQ(report.slices.size(), 8U);
    EXPECT_EQ(count_files(folder / "out"), 9U);  // and slices.csv

    const std::vector<Body<4>> bodies = load_bodies<4>(run);
    const Frame<4> frame = load_frame<4>(run, bodies[1], 1);
    const Surface expected = slice(bodies[1].boundary, frame.positions, hyperplane_at(0.6));
    const SliceRecord& record = report.slices.back();
    EXPECT_EQ(record.file, "b_s01_000001.ply");
    EXPECT_EQ(record.time, 0.1);
    EXPECT_NEAR(record.volume, enclosed_volume(expected), 1e-13);
}

TEST(SliceRun, WritesObstaclesIntoFilesOfTheirOwnWhereAsked) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1});
    write_obstacles<4>(folder / "run/obstacles.json", floor_and_ball());
    const RunFolder run = open_run(folder / "run");
    SliceRunOptions options;
    options.frames = run.frames;
    const SliceRunReport without = slice_run(run, folder / "without", options, go_on);
    EXPECT_EQ(without.obstacles, 2);
    EXPECT_EQ(without.slices.size(), 2U);
    EXPECT_NE(text_in(folder / "without/a_000000.ply").find("without obstacles"),
              std::string::npos);

    options.has_obstacles = true;
    options.sections.offsets = {0.4, 0.6};
    const SliceRunReport with = slice_run(run, folder / "with", options, go_on);
    EXPECT_EQ(with.slices.size(), 2U * 2U * 3U);
    EXPECT_EQ(count_files(folder / "with"), 13U);  // and slices.csv
    EXPECT_NE(text_in(folder / "with/a_s00_000000.ply").find("obstacles in files of their own"),
              std::string::npos);
    EXPECT_NE(text_in(folder / "with/obstacle.1_s01_000001.ply")
                  .find("obstacle 1, half_space, w = 0.6, cut off"),
              std::string::npos);
    const SliceRecord& ball = with.slices.back();
    EXPECT_EQ(ball.file, "obstacle.2_s01_000001.ply");
    EXPECT_TRUE(ball.is_obstacle);
    const double radius = std::sqrt(0.4 * 0.4 - 0.1 * 0.1);
    const double volume = 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
    EXPECT_NEAR(ball.volume, volume, 1e-3 * volume);  // chords of 192 corners
    EXPECT_TRUE(std::isnan(with.slices[2].volume));   // a plane has none
}

TEST(SliceRun, GivesEachSurfaceAFileOfItsOwnWhateverBodiesAreCalled) {
    const TempFolder folder;
    for (const char* body : {"a", "a_outline", "a_boundary", "a_s01", "a_000001"}) {
        write_run(folder / "run", body, {0, 1});
    }
    const RunFolder run = open_run(folder / "run");
    SliceRunOptions options;
    options.frames = run.frames;
    options.projection = ProjectionOptions();
    options.has_boundary = true;
    options.format = SurfaceFormat::Vtu;
    for (const std::size_t sections : {1U, 2U}) {
        options.sections.offsets.assign(sections, 0.5);
        const std::filesystem::path out = folder / std::to_string(sections);
        const SliceRunReport report = slice_run(run, out, options, go_on);
        EXPECT_EQ(report.slices.size(), 5 * 2 * sections);
        // Slices, outline and boundary of each body: a file a frame, and a collection; slices.csv.
        EXPECT_EQ(count_files(out), 5 * (sections + 2) * (2 + 1) + 1);
    }
}

// As tables and XML have it.
TEST(SliceRun, WritesNamesWithMarksAsFilesOfTheirFormatDo) {
    const TempFolder folder;
    write_mesh<4>(folder / "a&\"b\",\nc.pent", test::jittered_box({1, 1, 1, 1}, 3));
    const RunFolder run = open_run(folder / "a&\"b\",\nc.pent");
    SliceRunOptions options;
    options.frames = run.frames;
    (void)slice_run(run, folder / "ply", options, go_on);
    EXPECT_NE(text_in(folder / "ply/slices.csv").find("\n\"a&\"\"b\"\",\nc_000000.ply\",0,0,"),
              std::string::npos);
    const std::string ply = text_in(folder / "ply/a&\"b\",\nc_000000.ply");
    EXPECT_NE(ply.find("body a&\"b\", c, w = "), std::string::npos) << ply.substr(0, 200);
    options.format = SurfaceFormat::Vtu;
    (void)slice_run(run, folder / "vtu", options, go_on);
    EXPECT_NE(text_in(folder / "vtu/a&\"b\",\nc.pvd")
                  .find("file=\"a&#38;&#34;b&#34;,&#10;c_000000.vtu\""),
              std::string::npos);
}

TEST(SliceRun, StopsBetweenFramesAndListsWhatItWrote) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1, 2});
    const RunFolder run = open_run(folder / "run");
    SliceRunOptions options;
    options.frames = run.frames;
    const SliceRunReport report =
        slice_run(run, folder / "out", options,
                  [](std::string_view, std::int64_t done, std::int64_t) { return done < 2; });
    EXPECT_FALSE(report.is_complete);
    EXPECT_EQ(report.slices.size(), 2U);
    EXPECT_EQ(count_files(folder / "out"), 3U);
}

TEST(SliceRun, KeepsOtherFilesInAUsedFolder) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0});
    const RunFolder run = open_run(folder / "run");
    SliceRunOptions options;
    options.frames = run.frames;
    make_folder(folder / "out");
    write_text(folder / "out/mine.txt", "keep");
    for (int repeat = 0; repeat < 2; ++repeat) {
        (void)slice_run(run, folder / "out", options, go_on);
    }
    EXPECT_EQ(count_files(folder / "out"), 3U);
    EXPECT_TRUE(std::filesystem::exists(folder / "out/mine.txt"));
}

TEST(SliceRun, PutsVtuFilesInTime) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1});
    const RunFolder run = open_run(folder / "run");
    SliceRunOptions options;
    options.frames = run.frames;
    options.format = SurfaceFormat::Vtu;
    options.color = ColorBy::Speed;
    (void)slice_run(run, folder / "out", options, go_on);
    std::ostringstream collection;
    collection << std::ifstream(folder / "out/a.pvd").rdbuf();
    EXPECT_NE(collection.str().find("timestep=\"0.10000000000000001\" part=\"0\" "
                                    "file=\"a_000001.vtu\""),
              std::string::npos);
}

}  // namespace
}  // namespace pent::viewer
