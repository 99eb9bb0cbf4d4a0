#include "beams.h"
#include "cases.h"

#include <pent/formatted.h>
#include <pent/simulator/simulation.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <malloc.h>
#include <unistd.h>

namespace pent::simulator::bench {

namespace {

// Memory of this process that is in use, bytes.
double resident_bytes() {
    malloc_trim(0);
    std::ifstream file("/proc/self/statm");
    double total = 0;
    double resident = 0;
    file >> total >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

struct Size {
    double cells = 0;
    double seconds = 0;
    double bytes = 0;
    int iterations = 0;
};

Size measure(const std::array<int, 4>& count, int threads) {
    constexpr int kSteps = 3;
    const double before = resident_bytes();
    Simulation<4> simulation(beam_scene(), {box(count)}, {.threads = threads, .isa = ""});
    Size size;
    std::vector<double> seconds;
    for (int i = 0; i < kSteps; ++i) {
        const StepReport report = simulation.step();
        seconds.push_back(report.seconds);
        size.iterations = std::max(size.iterations, report.iterations);
    }
    std::sort(seconds.begin(), seconds.end());
    size.cells = static_cast<double>(simulation.size().cells);
    size.seconds = seconds[kSteps / 2];
    size.bytes = resident_bytes() - before;
    return size;
}

}  // namespace

std::string growth(int threads) {
    std::string table =
        "| pentachora | time per step | memory | of each | iterations | exponent of time |\n"
        "| --- | --- | --- | --- | --- | --- |\n";
    Size first;
    for (const std::array<int, 4>& count : {std::array{8, 8, 7, 7},
                                            {11, 10, 10, 10},
                                            {15, 15, 15, 14},
                                            {21, 20, 20, 20},
                                            {26, 26, 25, 25}}) {
        const Size size = measure(count, threads);
        table +=
            formatted("| %.0f | %.0f ms | %.0f MB | %.0f B | %d |", size.cells, 1e3 * size.seconds,
                      1e-6 * size.bytes, size.bytes / size.cells, size.iterations);
        if (first.cells == 0) {
            first = size;
            table += " |\n";
            continue;
        }
        table += formatted(" %.2f |\n", std::log(size.seconds / first.seconds)
                                            / std::log(size.cells / first.cells));
    }
    return table;
}

}  // namespace pent::simulator::bench
