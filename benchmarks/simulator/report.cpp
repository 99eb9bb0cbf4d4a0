#include "report.h"

#include <pent/formatted.h>
#include <pent/stopwatch.h>

#include <algorithm>
#include <cmath>

namespace pent::simulator::bench {

namespace {

double quantile(std::vector<double> values, double part) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(
        std::lround(part * static_cast<double>(values.size() - 1)))];
}

std::string readable(double seconds) {
    return seconds < 1e-6   ? formatted("%.3g ns", 1e9 * seconds)
           : seconds < 1e-3 ? formatted("%.3g us", 1e6 * seconds)
           : seconds < 1    ? formatted("%.3g ms", 1e3 * seconds)
                            : formatted("%.3g s", seconds);
}

}  // namespace

Report measure(const std::vector<Case>& cases, int rounds, int max_threads) {
    std::vector<std::vector<double>> seconds(cases.size());
    std::vector<std::vector<double>> oracles(cases.size());
    std::vector<std::vector<Ceilings>> ceilings(static_cast<std::size_t>(max_threads));
    for (int round = 0; round < rounds; ++round) {
        for (int threads = 1; threads <= max_threads; ++threads) {
            ceilings[static_cast<std::size_t>(threads) - 1].push_back(
                measure_ceilings(Workers(threads)));
        }
        for (std::size_t i = 0; i < cases.size(); ++i) {
            seconds[i].push_back(cases[i].run());
            if (cases[i].oracle) {
                oracles[i].push_back(cases[i].oracle());
            }
        }
    }
    Report report;
    for (const std::vector<Ceilings>& samples : ceilings) {
        const auto median = [&](double Ceilings::*figure) {
            std::vector<double> values;
            values.reserve(samples.size());
            for (const Ceilings& sample : samples) {
                values.push_back(sample.*figure);
            }
            return quantile(values, 0.5);
        };
        report.ceilings.push_back({median(&Ceilings::memory), median(&Ceilings::cache),
                                   median(&Ceilings::float_flops),
                                   median(&Ceilings::double_flops)});
    }
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Case& c = cases[i];
        Row row{.name = c.name, .threads = c.threads, .unit = c.unit, .units = c.units};
        row.seconds = quantile(seconds[i], 0.5);
        row.spread = 0.5 * (quantile(seconds[i], 0.75) - quantile(seconds[i], 0.25)) / row.seconds;
        if (c.bound) {
            row.bound = c.bound(report.ceilings[static_cast<std::size_t>(c.threads) - 1]);
        }
        if (c.oracle) {
            row.oracle = c.oracle_factor * quantile(oracles[i], 0.5);
        }
        row.note = c.note ? c.note() : "";
        report.rows.push_back(row);
    }
    return report;
}

std::string markdown(const Report& report) {
    std::string out =
        "| threads | triad, 192 MB | triad, 16 MB | FMA, float | FMA, double |\n"
        "| --- | --- | --- | --- | --- |\n";
    for (std::size_t i = 0; i < report.ceilings.size(); ++i) {
        const Ceilings& c = report.ceilings[i];
        out +=
            formatted("| %zu | %.1f GB/s | %.1f GB/s | %.0f GFLOP/s | %.0f GFLOP/s |\n", i + 1,
                      1e-9 * c.memory, 1e-9 * c.cache, 1e-9 * c.float_flops, 1e-9 * c.double_flops);
    }
    out +=
        "\n| what | threads | time | +- | each | bound | of the bound | plain way | faster by | |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const Row& row : report.rows) {
        out += "| " + row.name + formatted(" | %d | ", row.threads) + readable(row.seconds)
               + formatted(" | %.0f%% | ", 100 * row.spread)
               + (row.unit.empty() ? "" : readable(row.seconds / row.units) + " / " + row.unit)
               + " | "
               + (row.bound > 0
                      ? readable(row.bound) + formatted(" | %.0f%%", 100 * row.bound / row.seconds)
                      : " | ")
               + " | "
               + (row.oracle > 0
                      ? readable(row.oracle) + formatted(" | %.3gx", row.oracle / row.seconds)
                      : " | ")
               + " | " + row.note + " |\n";
    }
    return out;
}

}  // namespace pent::simulator::bench
