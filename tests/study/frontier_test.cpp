#include "frontier.h"

#include "plot.h"
#include "support/messages.h"

#include <gtest/gtest.h>

namespace pent::study {
namespace {

Result result(const std::string& name, double cost, double error) {
    Result r;
    r.settings = {{"s", name}};
    r.verdict = UnitVerdict::Finished;
    r.cost.seconds_per_frame = cost;
    r.cost.wall_seconds = 10 * cost;
    r.errors.position = error;
    return r;
}

StudyReport report() {
    StudyReport r;
    r.scene = "a & b <c>.toml";
    r.frames = 10;
    r.scene_frames = 100;
    r.results = {result("slow", 2, 0.004),   result("fast", 0.1, 0.08),
                 result("beaten", 3, 0.01),  result("middle", 0.5, 0.02),
                 result("exact", 4, 0.0001), result("broken", 0.01, 0)};
    r.results.back().verdict = UnitVerdict::Diverged;
    r.reference.cost.seconds_per_frame = 7;
    r.reference.error_bar = 0.001;
    r.reference.window = 0.5;
    r.frontier = frontier_of(r.results, r.reference.error_bar);
    return r;
}

TEST(Frontier, HasTheResultsThatNoOtherBeatsByTime) {
    EXPECT_EQ(report().frontier, (std::vector<std::size_t>{1, 3, 0, 4}));
}

TEST(Frontier, DoesNotTellErrorsBelowTheErrorBarApart) {
    const std::vector<Result> results = {result("a", 1, 1e-4), result("b", 2, 1e-5)};
    EXPECT_EQ(frontier_of(results, 1e-3), (std::vector<std::size_t>{0}));
    EXPECT_EQ(frontier_of(results, 1e-6), (std::vector<std::size_t>{0, 1}));
}

TEST(BestWithinError, IsTheFastestThatIsGoodEnough) {
    const StudyReport r = report();
    EXPECT_EQ(best_within_error(r, 0.05)->settings[0].value, "middle");
    EXPECT_EQ(best_within_error(r, 0.005)->settings[0].value, "slow");
    EXPECT_EQ(best_within_error(r, 1e-6), nullptr);
}

TEST(BestWithinBudget, CountsAllFramesOfTheSceneNotOnlyTheStudiedOnes) {
    const StudyReport r = report();  // 100 frames
    EXPECT_EQ(best_within_budget(r, 60)->settings[0].value, "middle");
    EXPECT_EQ(best_within_budget(r, 1000)->settings[0].value, "exact");
    EXPECT_EQ(best_within_budget(r, 5), nullptr);
}

TEST(Sentences, SayForEachErrorWhatToTakeAndWhatItSaves) {
    const std::vector<std::string> sentences = sentences_of(report());
    EXPECT_EQ(sentences[0],
              "within 20%: s=fast, 0.1 s per frame, 70x faster than the reference (error 8%)");
    EXPECT_EQ(sentences[4],
              "within 1%: s=slow, 2 s per frame, 3.5x faster than the reference (error 0.4%)");
    EXPECT_EQ(sentences.back(),
              "within 0.1%: s=exact, 4 s per frame, 1.75x faster than the"
              " reference (error below 0.1%)");
}

TEST(Median, IsTheMiddleOrTheMeanOfTwo) {
    EXPECT_EQ(median({}), 0);
    EXPECT_EQ(median({5}), 5);
    EXPECT_EQ(median({9, 1, 2}), 2);
    EXPECT_EQ(median({9, 1, 2, 4}), 3);
}

TEST(FrontierPlot, HasADotForEveryFinishedResultWithinThePicture) {
    const Drawing plot = frontier_plot(report());
    // 5 results, 4 of them again as numbered dots of the frontier, 5 in the legend.
    EXPECT_EQ(plot.discs.size(), 14U);
    for (const Disc& disc : plot.discs) {
        EXPECT_GT(disc.center.x, 0);
        EXPECT_LT(disc.center.x, plot.width);
        EXPECT_GT(disc.center.y, 0);
        EXPECT_LT(disc.center.y, plot.height);
    }
    // Slower is further right, a larger error further up (y points down).
    EXPECT_GT(plot.discs[0].center.x, plot.discs[1].center.x);
    EXPECT_GT(plot.discs[0].center.y, plot.discs[1].center.y);
    pent::test::expect_contains(svg(plot), {"a &amp; b &lt;c>.toml", "wall-clock seconds"});
}

// Ends of the lines of a color, as pixels from left to right.
std::vector<double> ends_in(const Drawing& plot, const Rgb& color) {
    std::vector<double> ends;
    for (const Line& line : plot.lines) {
        if (line.color == color) {
            ends.push_back(line.from.x);
            ends.push_back(line.to.x);
        }
    }
    return ends;
}

TEST(FrontierPlot, JoinsInEachColorWhatNoOtherOfThatColorBeats) {
    StudyReport r;
    r.reference.cost.seconds_per_frame = 100;
    const auto add = [&](const char* elements, const char* dt, double cost, double error) {
        r.results.push_back(result("", cost, error));
        r.results.back().settings = {{"elements", elements}, {"dt", dt}};
    };
    add("linear", "1/30", 1, 0.4);
    add("linear", "1/60", 2, 0.2);
    add("linear", "1/90", 3, 0.3);  // beaten by the one before
    add("quadratic", "1/30", 1.5, 0.1);
    add("quadratic", "1/60", 4, 0.02);
    add("smoothed", "1/30", 5, 0.2);  // alone, and beaten by all
    r.frontier = frontier_of(r.results, r.reference.error_bar);
    const Drawing plot = frontier_plot(r);
    const auto x = [&](std::size_t i) { return plot.discs[i].center.x; };
    const auto color = [&](std::size_t i) { return plot.discs[i].color; };
    EXPECT_EQ(ends_in(plot, color(0)), (std::vector<double>{x(0), x(1)}));
    EXPECT_EQ(ends_in(plot, color(3)), (std::vector<double>{x(3), x(4)}));
    EXPECT_TRUE(ends_in(plot, color(5)).empty());
}

TEST(FrontierPlot, OfNothingMeasuredIsAnEmptyFrame) {
    const Drawing plot = frontier_plot({});
    EXPECT_TRUE(plot.discs.empty());
    for (const Line& line : plot.lines) {
        for (const Point& end : {line.from, line.to}) {
            EXPECT_TRUE(end.x >= 0 && end.x <= plot.width && end.y >= 0 && end.y <= plot.height)
                << end.x << ", " << end.y;
        }
    }
}

}  // namespace
}  // namespace pent::study
