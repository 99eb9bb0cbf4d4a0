#include "pictures.h"
#include "runs.h"

#include <pent/error.h>
#include <pent/formatted.h>
#include <pent/obstacles_file.h>
#include <pent/viewer/movie.h>
#include <pent/viewer/render_run.h>
#include <pent/viewer/slice_run.h>

#include <gtest/gtest.h>

#include <cmath>
#include <support/messages.h>
#include <support/temp_folder.h>
#include <sys/resource.h>

namespace pent::viewer {
namespace {

using pent::test::error_of;
using pent::test::expect_contains;
using pent::test::TempFolder;
using test::count_files;
using test::floor_and_ball;
using test::go_on;
using test::read_png;
using test::small_pictures;
using test::write_run;

TEST(RenderRun, MakesPicturesSheetAndFolder) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1, 2});
    const RunFolder run = open_run(folder / "run");
    RenderRunOptions options = small_pictures(run);
    options.sections.offsets = {0.3, 0.6};
    options.color = ColorBy::Strain;
    options.sheet_frames = 2;
    const RenderRunReport report =
        render_run(run, {.folder = folder / "out", .sheet = folder / "sheet.png"}, options, go_on);
    EXPECT_TRUE(report.is_complete);
    EXPECT_EQ(report.pictures, 3 + 2 * 2);
    EXPECT_EQ(count_files(folder / "out"), 3U);
    EXPECT_TRUE(std::filesystem::exists(folder / "sheet.png"));
    EXPECT_GT(report.range.high, 0);
}

TEST(RenderRun, LaysASheetOfOneHyperplaneOutInASquare) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1, 2, 3});
    const RunFolder run = open_run(folder / "run");
    RenderRunOptions options = small_pictures(run);
    EXPECT_EQ(render_run(run, {.sheet = folder / "sheet.png"}, options, go_on).pictures, 4);
    const Image sheet = read_png(folder / "sheet.png");
    // Two by two pictures of 3/8 of 96 x 64 pixels and three gaps.
    EXPECT_EQ(sheet.width - 2 * 36, sheet.height - 2 * 24);
    EXPECT_LT(sheet.width, 3 * 36);
}

// Frames that differ in nothing else.
TEST(RenderRun, TellsFramesApartByTheirTimesHoweverNear) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0});
    Frame<4> frame = read_frame<4>(folder / "run/frames/a_000000.pent");
    frame.frame = frame.step = 1;
    frame.time = 2e-7;
    write_frame(folder / "run/frames/a_000001.pent", frame);
    const RunFolder run = open_run(folder / "run");
    for (const bool has_caption : {false, true}) {
        RenderRunOptions options = small_pictures(run);
        options.width = 320;
        options.has_caption = has_caption;
        (void)render_run(run, {.folder = folder / "out"}, options, go_on);
        EXPECT_EQ(
            read_png(folder / "out/000000.png").rgb != read_png(folder / "out/000001.png").rgb,
            has_caption);
    }
}

RenderRunOptions bare_picture(const RunFolder& run) {
    RenderRunOptions options = small_pictures(run);
    options.frames = {0};
    options.has_caption = false;
    options.has_floor = false;
    return options;
}

// A turned slice of body and obstacles as ghosts, with a projection or without.
Image picture_at_scale(const std::filesystem::path& folder,
                       double scale,
                       const std::optional<ProjectionOptions>& projection,
                       const std::vector<double>& offsets) {
    write_run(folder / "run", "a", {1}, scale);
    write_obstacles<4>(folder / "run/obstacles.json", floor_and_ball(scale));
    const RunFolder run = open_run(folder / "run");
    RenderRunOptions options = small_pictures(run);
    options.has_caption = false;
    options.is_onion = true;
    options.projection = projection;
    options.sections.rotations = {{0, 3, 0.3}};
    for (const double offset : offsets) {
        options.sections.offsets.push_back(offset * scale);
    }
    (void)render_run(run, {.picture = folder / "a.png"}, options, go_on);
    return read_png(folder / "a.png");
}

TEST(RenderRun, KnowsNoLengthButThoseOfTheBodies) {
    const TempFolder folder;
    const std::vector<std::optional<ProjectionOptions>> projections = {
        std::nullopt, ProjectionOptions{.is_perspective = false},
        ProjectionOptions{.is_perspective = true}};
    for (const auto& projection : projections) {
        const Image image = picture_at_scale(folder.path(), 1, projection, {0.4, 0.5, 0.6});
        for (const int power : {-40, -33, 20, 60, 64}) {  // 9e-13 to 2e19 m: nothing is rounded
            EXPECT_EQ(
                picture_at_scale(folder.path(), std::ldexp(1.0, power), projection, {0.4, 0.5, 0.6})
                    .rgb,
                image.rgb)
                << power;
        }
    }
    // Where coordinates are rounded some samples of edges fall on the other side: an eighth of a
    // pixel each.
    const Image image = picture_at_scale(folder.path(), 1, std::nullopt, {});
    for (const double scale : {1e-12, 1e19}) {
        const Image other = picture_at_scale(folder.path(), scale, std::nullopt, {});
        int different = 0;
        for (std::size_t i = 0; i < image.rgb.size(); ++i) {
            different += std::abs(image.rgb[i] - other.rgb[i]) > 8 ? 1 : 0;
        }
        EXPECT_LE(different, 30) << scale;
    }
}

class RenderObstacles : public testing::Test {
protected:
    RenderObstacles() {
        write_run(folder_ / "run", "a", {0});
        write_run(folder_ / "bare", "a", {0});
        write_obstacles<4>(folder_ / "run/obstacles.json", floor_and_ball());
    }

    [[nodiscard]] Image picture_of(const std::string& name, const RenderRunOptions& options) const {
        const RunFolder run = open_run(folder_ / name);
        (void)render_run(run, {.picture = folder_ / "a.png"}, options, go_on);
        return read_png(folder_ / "a.png");
    }

    [[nodiscard]] RenderRunOptions options() const {
        RenderRunOptions options = bare_picture(open_run(folder_ / "run"));
        options.sections.offsets = {0.5};
        return options;
    }

    TempFolder folder_;
};

TEST_F(RenderObstacles, ShowsThemUnlessToldNotTo) {
    RenderRunOptions some = options();
    const Image bare = picture_of("bare", some);
    EXPECT_NE(picture_of("run", some).rgb, bare.rgb);
    some.has_obstacles = false;
    EXPECT_EQ(picture_of("run", some).rgb, bare.rgb);
}

TEST_F(RenderObstacles, LeaveOutTheFloorThatIsMadeUpWhereTheyAreOne) {
    RenderRunOptions some = options();
    const Image with = picture_of("run", some);
    some.has_floor = true;
    EXPECT_EQ(picture_of("run", some).rgb, with.rgb);
    write_obstacles<4>(folder_ / "run/obstacles.json", {floor_and_ball()[1]});
    const Image ball_on_floor = picture_of("run", some);
    some.has_floor = false;
    EXPECT_NE(picture_of("run", some).rgb, ball_on_floor.rgb);
}

TEST_F(RenderObstacles, AreSlicedAsTheBodiesAre) {
    RenderRunOptions some = options();
    some.sections.offsets = {0.05};  // misses the ball
    const Image without_ball = picture_of("run", some);
    write_obstacles<4>(folder_ / "run/obstacles.json", {floor_and_ball()[0]});
    EXPECT_EQ(picture_of("run", some).rgb, without_ball.rgb);
}

TEST_F(RenderObstacles, HaveGhostsAndOutlinesAsBodiesHave) {
    RenderRunOptions some = options();
    write_obstacles<4>(folder_ / "run/obstacles.json", {floor_and_ball()[1]});
    some.is_onion = true;
    some.sections.offsets = {0.5, 0.05, 0.02};  // the ball is in the first alone: a ghost
    EXPECT_NE(picture_of("run", some).rgb, picture_of("bare", some).rgb);
    some = options();
    some.sections.offsets = {0.05};
    EXPECT_EQ(picture_of("run", some).rgb, picture_of("bare", some).rgb);
    some.projection = ProjectionOptions();
    EXPECT_NE(picture_of("run", some).rgb, picture_of("bare", some).rgb);
}

TEST_F(RenderObstacles, ThatAreManyBallsTakeMemoryByWhatIsSeenOfThem) {
    const auto peak = [] {  // KiB
        rusage usage = {};
        getrusage(RUSAGE_SELF, &usage);
        return usage.ru_maxrss;
    };
    std::vector<ObstacleShape<4>> balls;
    for (int i = 0; i < 400; ++i) {
        const double angle = 0.3 * i;
        balls.emplace_back(Ball<4>{{std::cos(angle), 0.002 * i, std::sin(angle), 0.5}, 0.02});
    }
    write_obstacles<4>(folder_ / "run/obstacles.json", balls);
    const long before = peak();
    EXPECT_NE(picture_of("run", options()).rgb, picture_of("bare", options()).rgb);
    EXPECT_LT(peak() - before, 700'000);  // balls that are as fine as large ones have: 3 GB
}

TEST_F(RenderObstacles, ThatMoveAreWhereTheyAreAtEachFrame) {
    RenderRunOptions some = options();
    const Image at_rest = picture_of("run", some);
    const int frame = open_run(folder_ / "run").frames.front();
    std::filesystem::remove(folder_ / "run/obstacles.json");
    const auto put = [&](int number, const std::vector<ObstacleShape<4>>& obstacles) {
        std::filesystem::create_directories(folder_ / "run/obstacles");
        write_obstacles<4>(folder_ / "run" / formatted("obstacles/%06d.json", number), obstacles);
    };
    put(frame, floor_and_ball());
    put(frame + 1, {floor_and_ball()[0]});
    EXPECT_EQ(picture_of("run", some).rgb, at_rest.rgb);
    put(frame, {floor_and_ball()[0]});
    EXPECT_NE(picture_of("run", some).rgb, at_rest.rgb);
}

TEST_F(RenderObstacles, OfDamagedFilesAreRefused) {
    write_text(folder_ / "run/obstacles.json", "{}");
    expect_contains(error_of([&] { (void)picture_of("run", options()); }),
                    {"obstacles.json", "is not the list"});
}

// Colors of a sheet are explained under it, where no body can be.
TEST(RenderRun, PutsTheColorBarUnderASheet) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1});
    const RunFolder run = open_run(folder / "run");
    RenderRunOptions options = small_pictures(run);
    const auto sheet_of = [&](ColorBy color) {
        options.color = color;
        (void)render_run(run, {.sheet = folder / "sheet.png"}, options, go_on);
        return read_png(folder / "sheet.png");
    };
    const Image plain = sheet_of(ColorBy::Body);
    const Image colored = sheet_of(ColorBy::Strain);
    EXPECT_EQ(colored.width, plain.width);
    EXPECT_GT(colored.height, plain.height + 13);
}

TEST(RenderRun, ShowsAnOnionAsItsMiddleSliceAmongGhosts) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0});
    const RunFolder run = open_run(folder / "run");
    const auto picture_of = [&](std::vector<double> offsets) {
        RenderRunOptions options = bare_picture(run);
        options.is_onion = true;
        options.sections.offsets = std::move(offsets);
        EXPECT_EQ(render_run(run, {.picture = folder / "a.png"}, options, go_on).pictures, 1);
        return read_png(folder / "a.png");
    };
    const Image alone = picture_of({0.5});
    EXPECT_EQ(picture_of({-50, 0.5, 50}).rgb, alone.rgb);  // ghosts that meet nothing
    EXPECT_NE(picture_of({0.2, 0.5, 0.8}).rgb, alone.rgb);
}

TEST(RenderRun, ShowsTheOutlineOfAPrismWhereItsSliceIs) {
    const TempFolder folder;
    write_mesh<4>(folder / "box.pent", pent::test::kuhn_box<4>({1, 1, 1, 1}, {1, 1, 1, 1}));
    const RunFolder run = open_run(folder / "box.pent");
    RenderRunOptions options = bare_picture(run);
    const auto covered = [&] {
        (void)render_run(run, {.picture = folder / "a.png"}, options, go_on);
        const Image image = read_png(folder / "a.png");
        int count = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                // The background changes from top to bottom alone.
                count += std::abs(image.pixel(x, y)[1] - image.pixel(0, y)[1]) > 2 ? 1 : 0;
            }
        }
        return count;
    };
    const int slice = covered();
    EXPECT_GT(slice, 200);
    options.projection = ProjectionOptions();
    EXPECT_NEAR(covered(), slice, 30);  // the same silhouette, but for pixels on its edge
    options.sections.offsets = {50};
    EXPECT_NEAR(covered(), slice, 30);  // the outline alone
}

TEST(RenderRun, MakesAMovieWhereFfmpegIs) {
    if (!Movie::is_possible()) {
        GTEST_SKIP() << "no ffmpeg";
    }
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1, 2});
    const RunFolder run = open_run(folder / "run");
    const RenderRunReport report =
        render_run(run, {.movie = folder / "a.mp4"}, small_pictures(run), go_on);
    EXPECT_NEAR(report.frames_per_second, 10, 1e-12);  // frames are 0.1 s apart
    EXPECT_GT(std::filesystem::file_size(folder / "a.mp4"), 500U);
    EXPECT_EQ(count_files(folder.path()), 2U);
}

TEST(RenderRun, RefusesATrueSpeedThatNoMovieHas) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1000});  // 100 s apart
    const RunFolder run = open_run(folder / "run");
    RenderRunOptions options = small_pictures(run);
    expect_contains(
        error_of([&] { (void)render_run(run, {.movie = folder / "a.mp4"}, options, go_on); }),
        {"a.mp4: true speed is 0.01 pictures a second", "0.1 to 1000", "--fps"});
    EXPECT_TRUE(render_run(run, {.folder = folder / "out"}, options, go_on).is_complete);
    if (Movie::is_possible()) {
        options.frames_per_second = 1;
        EXPECT_TRUE(render_run(run, {.movie = folder / "a.mp4"}, options, go_on).is_complete);
    }
}

TEST(RenderRun, LeavesNoMovieWhenStopped) {
    if (!Movie::is_possible()) {
        GTEST_SKIP() << "no ffmpeg";
    }
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1, 2});
    const RunFolder run = open_run(folder / "run");
    const RenderRunReport report = render_run(
        run, {.movie = folder / "a.mp4"}, small_pictures(run),
        [](std::string_view what, std::int64_t, std::int64_t) { return what != "picture"; });
    EXPECT_FALSE(report.is_complete);
    EXPECT_EQ(count_files(folder.path()), 1U);
}

// It asks before each of the three frames that it looks at and each of the two pictures.
TEST(RenderRun, LeavesNoSheetWheneverItIsStopped) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1, 2});
    const RunFolder run = open_run(folder / "run");
    RenderRunOptions options = small_pictures(run);
    options.sheet_frames = 2;
    const std::pair<std::string_view, int> parts[] = {{"looked at frame", 3}, {"sheet picture", 2}};
    for (const auto& [part, asks] : parts) {
        for (int stop = 0; stop < asks; ++stop) {
            int asked = 0;
            const RenderRunReport report =
                render_run(run, {.sheet = folder / "sheet.png"}, options,
                           [&](std::string_view what, std::int64_t, std::int64_t) {
                               return what != part || asked++ != stop;
                           });
            EXPECT_FALSE(report.is_complete) << part << stop;
            EXPECT_FALSE(std::filesystem::exists(folder / "sheet.png")) << part << stop;
        }
    }
}

TEST(RenderRun, SweepsTheHyperplaneAtEveryFrame) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1});
    const RunFolder run = open_run(folder / "run");
    RenderRunOptions options = small_pictures(run);
    options.sections.offsets = {0.2, 0.4, 0.6};
    options.is_sweep = true;
    EXPECT_EQ(render_run(run, {.folder = folder / "out"}, options, go_on).pictures, 6);
    EXPECT_EQ(count_files(folder / "out"), 6U);
    EXPECT_TRUE(std::filesystem::exists(folder / "out/000001_s02.png"));
    expect_contains(
        error_of([&] { (void)render_run(run, {.picture = folder / "a.png"}, options, go_on); }),
        {"a.png", "one picture cannot hold a sweep"});
    options.is_onion = true;
    EXPECT_THROW((void)render_run(run, {.folder = folder / "out"}, options, go_on), Error);
}

TEST(RenderRun, RefusesHyperplanesThatHaveNoRoomSideBySide) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0});
    const RunFolder run = open_run(folder / "run");
    RenderRunOptions options = small_pictures(run);
    options.width = 64;
    const auto render = [&](std::size_t hyperplanes) {
        options.sections.offsets.assign(hyperplanes, 0.5);
        (void)render_run(run, {.picture = folder / "a.png"}, options, go_on);
    };
    EXPECT_NO_THROW(render(4));
    expect_contains(error_of([&] { render(5); }),
                    {"5 hyperplanes side by side in 64 pixels", "take fewer"});
    options.is_onion = true;
    EXPECT_NO_THROW(render(100));
}

TEST(ThreeDimensions, AreShownWholeAndTakeNoHyperplane) {
    const TempFolder folder;
    const SimplexMesh<3> mesh = pent::test::kuhn_box<3>({2, 2, 2}, {1, 2, 3});
    write_mesh<3>(folder / "box.pent", mesh);
    const RunFolder run = open_run(folder / "box.pent");
    SliceRunOptions slices;
    slices.frames = run.frames;
    slices.color = ColorBy::Strain;
    const SliceRunReport report = slice_run(run, folder / "out", slices, go_on);
    ASSERT_EQ(report.slices.size(), 1U);
    EXPECT_NEAR(report.slices[0].volume, 6, 6 * 1e-14);
    RenderRunOptions pictures = small_pictures(run);
    EXPECT_FALSE(render_run(run, {.picture = folder / "a.png"}, pictures, go_on).is_empty);

    slices.has_boundary = true;
    EXPECT_THROW((void)slice_run(run, folder / "out", slices, go_on), Error);
    pictures.projection = ProjectionOptions();
    EXPECT_THROW((void)render_run(run, {.picture = folder / "a.png"}, pictures, go_on), Error);
    pictures.projection.reset();
    pictures.sections.offsets = {0.5};
    EXPECT_THROW((void)render_run(run, {.picture = folder / "a.png"}, pictures, go_on), Error);
}

TEST(RenderRun, SaysWhenNothingIsSeen) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0});
    const RunFolder run = open_run(folder / "run");
    RenderRunOptions options = small_pictures(run);
    options.sections.offsets = {100};
    EXPECT_TRUE(render_run(run, {.picture = folder / "a.png"}, options, go_on).is_empty);
}

TEST(RenderRun, RefusesSizesAndFramesThatCannotBe) {
    const TempFolder folder;
    write_run(folder / "run", "a", {0, 1});
    const RunFolder run = open_run(folder / "run");
    RenderRunOptions options = small_pictures(run);
    EXPECT_THROW((void)render_run(run, {.picture = folder / "a.png"}, options, go_on), Error);
    options.width = 97;
    EXPECT_THROW((void)render_run(run, {.movie = folder / "a.mp4"}, options, go_on), Error);
    options.width = 1;
    EXPECT_THROW((void)render_run(run, {.folder = folder / "out"}, options, go_on), Error);
}

}  // namespace
}  // namespace pent::viewer
