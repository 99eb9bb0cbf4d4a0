#pragma once

#include "ceilings.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pent::simulator::bench {

/// Something to time.
struct Case {
    std::string name;
    int threads = 1;
    std::string unit = {};  ///< What there are `units` of; empty for a whole.
    double units = 1;
    std::function<double()> run = {};  ///< Does it once and gives the seconds of what counts.
    std::function<double(const Ceilings&)> bound = {};  ///< Least seconds; asked after the runs.
    double oracle_factor = 1;             ///< How much more of the work than the oracle did.
    std::function<double()> oracle = {};  ///< The plain way, seconds; timed in the same rounds.
    std::function<std::string()> note = {};
};

struct Row {
    std::string name;
    int threads = 1;
    std::string unit = {};
    double units = 1;
    double seconds = 0;  ///< Median.
    double spread = 0;   ///< Half the distance of the quartiles over the median.
    double bound = 0;    ///< Seconds; 0 for none.
    double oracle = 0;   ///< Seconds of the plain way for as much; 0 for none.
    std::string note = {};
};

struct Report {
    std::vector<Row> rows;
    std::vector<Ceilings> ceilings;  ///< With 1, 2 .. threads: [0] for one.
};

/// Runs all cases round after round, the ceilings at the start of each, and takes medians.
[[nodiscard]] Report measure(const std::vector<Case>& cases, int rounds, int max_threads);

/// The table, in Markdown.
[[nodiscard]] std::string markdown(const Report& report);

}  // namespace pent::simulator::bench
