#include "plot.h"

#include "frontier.h"

#include <algorithm>
#include <cmath>
#include <set>

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

constexpr int kLeft = 84;
constexpr int kTop = 62;
constexpr int kPlotWidth = 520;
constexpr int kPlotHeight = 400;
constexpr int kListWidth = 430;
constexpr int kBottom = 62;
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

class Plot {
public:
    explicit Plot(const StudyReport& report) : report_(report) {
        std::vector<double> costs = {report.reference.cost.seconds_per_frame};
        std::vector<double> errors = {report.reference.error_bar};
        for (const Result& result : report.results) {
            if (result.verdict == "finished") {
                costs.push_back(result.cost.seconds_per_frame);
                errors.push_back(error_of(result));
            }
        }
        cost_ = scale_of(costs);
        error_ = scale_of(errors);
    }

    Drawing operator()() {
        drawing_.width = kLeft + kPlotWidth + kListWidth;
        drawing_.height = kTop + kPlotHeight + kBottom;
        title();
        frame();
        reference();
        results();
        list();
        return std::move(drawing_);
    }

private:
    // Errors that the reference cannot tell from zero are drawn at its error bar.
    [[nodiscard]] double error_of(const Result& result) const {
        return std::max({result.errors.position, report_.reference.error_bar, 1e-9});
    }
    [[nodiscard]] Point place(double cost, double error) const {
        return {kLeft + kPlotWidth * cost_(cost), kTop + kPlotHeight * (1 - error_(error))};
    }
    [[nodiscard]] Point place(const Result& result) const {
        return place(result.cost.seconds_per_frame, error_of(result));
    }

    void title() {
        const ReferenceReport& reference = report_.reference;
        drawing_.words.push_back({.at = {kLeft, 24},
                                  .text = report_.scene + ": error against time",
                                  .pixels = 17,
                                  .color = kBlack});
        drawing_.words.push_back(
            {.at = {kLeft, 46},
             .text = std::to_string(report_.cells) + " cells, " + std::to_string(report_.frames)
                     + " frames, " + std::to_string(report_.threads)
                     + (report_.threads == 1 ? " thread; " : " threads; ")
                     + "position error up to t = " + short_number(reference.window) + " s",
             .pixels = 13,
             .color = kGray});
    }

    void frame() {
        const double bottom = kTop + kPlotHeight;
        for (const double tick : ticks(cost_.low, cost_.high)) {
            if (tick >= cost_.low * 0.999 && tick <= cost_.high * 1.001) {
                const double x = place(tick, error_.low).x;
                drawing_.lines.push_back({.from = {x, kTop}, .to = {x, bottom}, .color = kPale});
                drawing_.words.push_back({.at = {x, bottom + 20},
                                          .text = short_number(tick),
                                          .anchor = Anchor::Middle,
                                          .color = kGray});
            }
        }
        for (const double tick : ticks(error_.low, error_.high)) {
            if (tick >= error_.low * 0.999 && tick <= error_.high * 1.001) {
                const double y = place(cost_.low, tick).y;
                drawing_.lines.push_back(
                    {.from = {kLeft, y}, .to = {kLeft + kPlotWidth, y}, .color = kPale});
                drawing_.words.push_back({.at = {kLeft - 8, y + 4},
                                          .text = percent(tick),
                                          .anchor = Anchor::Right,
                                          .color = kGray});
            }
        }
        drawing_.words.push_back({.at = {kLeft + kPlotWidth / 2.0, bottom + 44},
                                  .text = "wall-clock seconds per frame",
                                  .anchor = Anchor::Middle,
                                  .color = kBlack});
        drawing_.words.push_back({.at = {8, kTop - 12.0}, .text = "error", .color = kBlack});
    }

    void reference() {
        const ReferenceReport& reference = report_.reference;
        if (reference.error_bar >= error_.low) {
            const double y = place(cost_.low, reference.error_bar).y;
            drawing_.lines.push_back({.from = {kLeft, y},
                                      .to = {kLeft + kPlotWidth, y},
                                      .color = kGray,
                                      .is_dashed = true});
            drawing_.words.push_back(
                {.at = {kLeft + 6, y - 5},
                 .text = "error of the reference: " + percent(reference.error_bar),
                 .pixels = 12,
                 .color = kGray});
        }
        const double x = place(reference.cost.seconds_per_frame, error_.low).x;
        drawing_.lines.push_back(
            {.from = {x, kTop}, .to = {x, kTop + kPlotHeight}, .color = kGray, .is_dashed = true});
        drawing_.words.push_back({.at = {x - 5, kTop + 14.0},
                                  .text = "reference",
                                  .anchor = Anchor::Right,
                                  .pixels = 12,
                                  .color = kGray});
    }

    // The values that colors tell apart: of the integrator if it is varied, else of the first axis.
    [[nodiscard]] std::string color_value(const Result& result) const {
        for (const Setting& setting : result.settings) {
            if (setting.axis == "integrator") {
                return setting.value;
            }
        }
        return result.settings.empty() ? "" : result.settings.front().value;
    }
    [[nodiscard]] Rgb color_of(const std::string& value) {
        const auto place = std::ranges::find(color_values_, value);
        if (place == color_values_.end()) {
            color_values_.push_back(value);
            return kColors[(color_values_.size() - 1) % kColors.size()];
        }
        return kColors[static_cast<std::size_t>(place - color_values_.begin()) % kColors.size()];
    }

    void results() {
        for (std::size_t i = 0; i + 1 < report_.frontier.size(); ++i) {
            drawing_.lines.push_back({.from = place(report_.results[report_.frontier[i]]),
                                      .to = place(report_.results[report_.frontier[i + 1]]),
                                      .color = kBlack,
                                      .width = 1.5});
        }
        for (const Result& result : report_.results) {
            if (result.verdict == "finished") {
                drawing_.discs.push_back({.center = place(result),
                                          .radius = 3.5,
                                          .color = color_of(color_value(result))});
            }
        }
        for (std::size_t i = 0; i < report_.frontier.size(); ++i) {
            const Result& result = report_.results[report_.frontier[i]];
            const Point at = place(result);
            drawing_.discs.push_back(
                {.center = at, .radius = 6, .color = color_of(color_value(result))});
            drawing_.words.push_back({.at = {at.x + 9, at.y - 7},
                                      .text = std::to_string(i + 1),
                                      .pixels = 14,
                                      .color = kBlack});
        }
    }

    void list() {
        const double left = kLeft + kPlotWidth + 28;
        double y = kTop + 12;
        const auto row = [&](const std::string& text, const Rgb& color) {
            drawing_.words.push_back(
                {.at = {left + 14, y}, .text = text, .pixels = 12, .color = color});
            y += kRowHeight;
        };
        for (const std::string& value : color_values_) {
            drawing_.discs.push_back(
                {.center = {left + 3, y - 4}, .radius = 4.5, .color = color_of(value)});
            row(value, kBlack);
        }
        y += kRowHeight / 2.0;
        row("Not beaten in both time and error:", kGray);
        const auto most = static_cast<std::size_t>((drawing_.height - y) / (2 * kRowHeight));
        for (std::size_t i = 0; i < std::min(most, report_.frontier.size()); ++i) {
            const Result& result = report_.results[report_.frontier[i]];
            row(std::to_string(i + 1) + "  " + settings_text(result.settings), kBlack);
            row("    " + short_number(result.cost.seconds_per_frame) + " s per frame, error "
                    + (result.errors.position < report_.reference.error_bar ? "below " : "")
                    + percent(error_of(result)),
                kGray);
        }
    }

    const StudyReport& report_;
    Drawing drawing_;
    Scale cost_;
    Scale error_;
    std::vector<std::string> color_values_;
};

}  // namespace

Drawing frontier_plot(const StudyReport& report) {
    return Plot(report)();
}

}  // namespace pent::study
