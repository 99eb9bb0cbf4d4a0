#include "frontier.h"

#include <pent/formatted.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pent::study {

namespace {

// A gain in error smaller than this part of it does not make a setting another point of the
// frontier.
constexpr double kMinGain = 0.05;
constexpr double kLevels[] = {0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001};

std::string sentence(double level, const Result& result, const StudyReport& report) {
    const double ratio =
        report.reference.cost.seconds_per_frame / std::max(result.cost.seconds_per_frame, 1e-9);
    const double error = std::max(result.errors.position, report.reference.error_bar);
    const char* sign = result.errors.position < report.reference.error_bar ? "below " : "";
    return "within " + percent(level) + ": " + settings_text(result.settings) + ", "
           + short_number(result.cost.seconds_per_frame) + " s per frame, "
           + (ratio >= 1 ? short_number(ratio) + "x faster" : short_number(1 / ratio) + "x slower")
           + " than the reference (error " + sign + percent(error) + ")";
}

}  // namespace

std::string short_number(double value) {
    return formatted(std::abs(value) >= 100 && std::abs(value) < 1e5 ? "%.0f" : "%.3g", value);
}

std::string percent(double fraction) {
    return formatted(std::abs(fraction) >= 1 ? "%.0f%%" : "%.2g%%", 100 * fraction);
}

double median(std::vector<double> values) {
    if (values.empty()) {
        return 0;
    }
    std::ranges::sort(values);
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::vector<std::size_t> frontier_of(const std::vector<Result>& results, double error_bar) {
    const auto error = [&](std::size_t i) {
        return std::max(results[i].errors.position, error_bar);
    };
    const auto cost = [&](std::size_t i) { return results[i].cost.seconds_per_frame; };
    std::vector<std::size_t> order(results.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return cost(a) != cost(b) ? cost(a) < cost(b) : error(a) < error(b);
    });
    std::vector<std::size_t> frontier;
    for (const std::size_t i : order) {
        if (results[i].verdict == UnitVerdict::Finished
            && (frontier.empty() || error(i) < (1 - kMinGain) * error(frontier.back()))) {
            frontier.push_back(i);
        }
    }
    return frontier;
}

std::vector<std::string> sentences_of(const StudyReport& report) {
    std::vector<std::string> sentences;
    for (const double level : kLevels) {
        if (level < report.reference.error_bar) {
            break;  // finer than the reference knows
        }
        const Result* best = best_within_error(report, level);
        if (best == nullptr) {
            sentences.push_back("within " + percent(level) + ": none of these settings");
            break;
        }
        sentences.push_back(sentence(level, *best, report));
    }
    return sentences;
}

const Result* best_within_error(const StudyReport& report, double error) {
    for (const std::size_t i : report.frontier) {
        if (report.results[i].errors.position <= error) {
            return &report.results[i];
        }
    }
    return nullptr;
}

const Result* best_within_budget(const StudyReport& report, double seconds) {
    const Result* best = nullptr;
    for (const std::size_t i : report.frontier) {
        if (report.results[i].cost.seconds_per_frame * report.scene_frames <= seconds) {
            best = &report.results[i];
        }
    }
    return best;
}

}  // namespace pent::study
