#include "plot.h"

#include "frontier.h"

#include <algorithm>
#include <cmath>

namespace pent::study {

namespace {

constexpr Rgb kBlack{0.1F, 0.1F, 0.1F};
constexpr Rgb kGray{0.45F, 0.45F, 0.45F};
constexpr Rgb kPale{0.88F, 0.88F, 0.88F};
// Told apart with impaired color vision too. Source: [okabe2008].
constexpr std::array<Rgb, 6> kColors = {{{0.0F, 0.45F, 0.70F},
                                         {0.84F, 0.37F, 0.0F},
                                         {0.0F, 0.62F, 0.45F},
                                         {0.80F, 0.47F, 0.65F},
                                         {0.34F, 0.71F, 0.91F},
                                         {0.90F, 0.62F, 0.0F}}};

// Pixels.
constexpr double kLeft = 84;
constexpr double kTop = 62;
constexpr double kRight = kLeft + 520;
constexpr double kBottom = kTop + 400;
constexpr int kWidth = 1034;
constexpr int kHeight = 524;
constexpr int kRowHeight = 19;

// A logarithmic axis over whole decades, or over 1-2-5 steps where that is too wide.
struct Scale {
    double low = 1;
    double high = 10;

    [[nodiscard]] double operator()(double value) const {
        return std::log(std::clamp(value, low, high) / low) / std::log(high / low);
    }
};

std::vector<double> ticks(double low, double high) {
    std::vector<double> all;
    for (int decade = static_cast<int>(std::floor(std::log10(low))) - 1; decade < 20; ++decade) {
        for (const double step : {1.0, 2.0, 5.0}) {
            all.push_back(step * std::pow(10.0, decade));
        }
        if (all.back() > high) {
            break;
        }
    }
    return all;
}

Scale scale_of(std::vector<double> values) {
    std::erase_if(values, [](double v) { return !(v > 0) || !std::isfinite(v); });
    if (values.empty()) {
        return {};
    }
    const auto [low, high] = std::ranges::minmax(values);
    Scale scale{low, high};
    for (const double tick : ticks(low, high)) {
        if (tick < low) {
            scale.low = tick;
        }
        if (tick > high) {
            scale.high = tick;
            break;
        }
    }
    return scale;
}

// The ticks within a scale.
std::vector<double> ticks_of(const Scale& scale) {
    std::vector<double> within = ticks(scale.low, scale.high);
    std::erase_if(
        within, [&](double tick) { return tick < scale.low * 0.999 || tick > scale.high * 1.001; });
    return within;
}

struct Axes {
    Scale cost;
    Scale error;

    [[nodiscard]] Point at(double seconds, double part) const {
        return {kLeft + (kRight - kLeft) * cost(seconds),
                kTop + (kBottom - kTop) * (1 - error(part))};
    }
    [[nodiscard]] Line vertical(double seconds, const Rgb& color, bool is_dashed) const {
        const double x = at(seconds, error.low).x;
        return {.from = {x, kTop}, .to = {x, kBottom}, .color = color, .is_dashed = is_dashed};
    }
    [[nodiscard]] Line horizontal(double part, const Rgb& color, bool is_dashed) const {
        const double y = at(cost.low, part).y;
        return {.from = {kLeft, y}, .to = {kRight, y}, .color = color, .is_dashed = is_dashed};
    }
};

Words words(Point at,
            const std::string& text,
            const Rgb& color,
            int pixels = 13,
            Anchor anchor = Anchor::Left) {
    return {.at = at, .text = text, .anchor = anchor, .pixels = pixels, .color = color};
}

// Errors that the reference cannot tell from zero are drawn at its error bar.
double error_of(const StudyReport& report, const Result& result) {
    return std::max({result.errors.position, report.reference.error_bar, 1e-9});
}

std::vector<Result> finished(const StudyReport& report) {
    std::vector<Result> results = report.results;
    std::erase_if(results,
                  [](const Result& result) { return result.verdict != UnitVerdict::Finished; });
    return results;
}

Axes axes_of(const StudyReport& report) {
    std::vector<double> costs = {report.reference.cost.seconds_per_frame};
    std::vector<double> errors = {report.reference.error_bar};
    for (const Result& result : finished(report)) {
        costs.push_back(result.cost.seconds_per_frame);
        errors.push_back(error_of(report, result));
    }
    return {scale_of(costs), scale_of(errors)};
}

Drawing title(const StudyReport& report) {
    const std::string size =
        std::to_string(report.cells) + " cells, " + std::to_string(report.frames) + " frames, "
        + std::to_string(report.threads) + (report.threads == 1 ? " thread; " : " threads; ")
        + "position error up to t = " + short_number(report.reference.window) + " s";
    return {.words = {words({kLeft, 24}, report.scene + ": error against time", kBlack, 17),
                      words({kLeft, 46}, size, kGray)}};
}

Drawing frame(const Axes& axes) {
    Drawing drawing;
    for (const double tick : ticks_of(axes.cost)) {
        const Line line = axes.vertical(tick, kPale, false);
        drawing.lines.push_back(line);
        drawing.words.push_back(
            words({line.to.x, kBottom + 20}, short_number(tick), kGray, 13, Anchor::Middle));
    }
    for (const double tick : ticks_of(axes.error)) {
        const Line line = axes.horizontal(tick, kPale, false);
        drawing.lines.push_back(line);
        drawing.words.push_back(
            words({kLeft - 8, line.to.y + 4}, percent(tick), kGray, 13, Anchor::Right));
    }
    drawing.words.push_back(words({(kLeft + kRight) / 2, kBottom + 44},
                                  "wall-clock seconds per frame", kBlack, 13, Anchor::Middle));
    drawing.words.push_back(words({8, kTop - 12}, "error", kBlack));
    return drawing;
}

Drawing reference(const StudyReport& report, const Axes& axes) {
    const ReferenceReport& reference = report.reference;
    Drawing drawing;
    if (reference.error_bar >= axes.error.low) {
        const Line line = axes.horizontal(reference.error_bar, kGray, true);
        drawing.lines.push_back(line);
        drawing.words.push_back(words({kLeft + 6, line.to.y - 5},
                                      "error of the reference: " + percent(reference.error_bar),
                                      kGray, 12));
    }
    const Line line = axes.vertical(reference.cost.seconds_per_frame, kGray, true);
    drawing.lines.push_back(line);
    drawing.words.push_back(
        words({line.to.x - 5, kTop + 14}, "reference", kGray, 12, Anchor::Right));
    return drawing;
}

// What colors tell apart: the value of the integrator if it is varied, else of the first axis.
std::string color_value(const Result& result) {
    for (const Setting& setting : result.settings) {
        if (setting.axis == "integrator") {
            return setting.value;
        }
    }
    return result.settings.empty() ? "" : result.settings.front().value;
}

std::vector<std::string> color_values(const StudyReport& report) {
    std::vector<std::string> values;
    for (const Result& result : finished(report)) {
        if (std::ranges::find(values, color_value(result)) == values.end()) {
            values.push_back(color_value(result));
        }
    }
    return values;
}

Rgb color_of(const std::string& value, const std::vector<std::string>& values) {
    const auto place = std::ranges::find(values, value) - values.begin();
    return kColors[static_cast<std::size_t>(place) % kColors.size()];
}

// The frontier of the results of each color alone: what other colors make of it, point by point.
std::vector<Line> curves(const StudyReport& report,
                         const Axes& axes,
                         const std::vector<std::string>& values) {
    std::vector<Line> lines;
    for (const std::string& value : values) {
        std::vector<Result> own = finished(report);
        std::erase_if(own, [&](const Result& result) { return color_value(result) != value; });
        const std::vector<std::size_t> frontier = frontier_of(own, report.reference.error_bar);
        for (std::size_t i = 1; i < frontier.size(); ++i) {
            const auto place = [&](std::size_t at) {
                const Result& result = own[frontier[at]];
                return axes.at(result.cost.seconds_per_frame, error_of(report, result));
            };
            lines.push_back({.from = place(i - 1),
                             .to = place(i),
                             .color = color_of(value, values),
                             .width = 2.5});
        }
    }
    return lines;
}

Drawing results(const StudyReport& report, const Axes& axes) {
    const std::vector<std::string> values = color_values(report);
    const auto disc = [&](const Result& result, double radius) -> Disc {
        return {.center = axes.at(result.cost.seconds_per_frame, error_of(report, result)),
                .radius = radius,
                .color = color_of(color_value(result), values)};
    };
    Drawing drawing{.lines = curves(report, axes, values)};
    for (const Result& result : finished(report)) {
        drawing.discs.push_back(disc(result, 3.5));
    }
    for (std::size_t i = 0; i < report.frontier.size(); ++i) {
        const Disc numbered = disc(report.results[report.frontier[i]], 6);
        if (i > 0) {
            drawing.lines.push_back({.from = drawing.discs.back().center,
                                     .to = numbered.center,
                                     .color = kBlack,
                                     .width = 1.5});
        }
        drawing.discs.push_back(numbered);
        drawing.words.push_back(words({numbered.center.x + 9, numbered.center.y - 7},
                                      std::to_string(i + 1), kBlack, 14));
    }
    return drawing;
}

// What the colors and the numbers stand for, beside the plot.
Drawing list(const StudyReport& report) {
    const double left = kRight + 28;
    double y = kTop + 12;
    Drawing drawing;
    const auto row = [&](const std::string& text, const Rgb& color) {
        drawing.words.push_back(words({left + 14, y}, text, color, 12));
        y += kRowHeight;
    };
    const std::vector<std::string> values = color_values(report);
    for (const std::string& value : values) {
        drawing.discs.push_back(
            {.center = {left + 3, y - 4}, .radius = 4.5, .color = color_of(value, values)});
        row(value, kBlack);
    }
    y += kRowHeight / 2.0;
    row("Not beaten in both time and error:", kGray);
    const auto most = static_cast<std::size_t>((kHeight - y) / (2 * kRowHeight));
    for (std::size_t i = 0; i < std::min(most, report.frontier.size()); ++i) {
        const Result& result = report.results[report.frontier[i]];
        row(std::to_string(i + 1) + "  " + settings_text(result.settings), kBlack);
        row("    " + short_number(result.cost.seconds_per_frame) + " s per frame, error "
                + (result.errors.position < report.reference.error_bar ? "below " : "")
                + percent(error_of(report, result)),
            kGray);
    }
    return drawing;
}

}  // namespace

Drawing frontier_plot(const StudyReport& report) {
    const Axes axes = axes_of(report);
    Drawing plot{.width = kWidth, .height = kHeight};
    for (const Drawing& part : {title(report), frame(axes), reference(report, axes),
                                results(report, axes), list(report)}) {
        plot.lines.insert(plot.lines.end(), part.lines.begin(), part.lines.end());
        plot.discs.insert(plot.discs.end(), part.discs.begin(), part.discs.end());
        plot.words.insert(plot.words.end(), part.words.begin(), part.words.end());
    }
    return plot;
}

}  // namespace pent::study
