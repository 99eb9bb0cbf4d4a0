// Measures the simulator's kernels, steps and growth, each beside what bounds it; prints Markdown.
//
//   bench_simulator [--rounds N] [--threads N] [--no-growth] [--title TEXT]

#include "cases.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

namespace {

struct Options {
    int rounds = 7;
    int threads = 2;
    bool has_growth = true;
    std::string title = "Simulator";
};

Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string name = argv[i];
        const bool has_value = i + 1 < argc;
        if (name == "--no-growth") {
            options.has_growth = false;
        } else if (name == "--rounds" && has_value) {
            options.rounds = std::atoi(argv[++i]);  // NOLINT(cert-err34-c): 0 is refused below
        } else if (name == "--threads" && has_value) {
            options.threads = std::atoi(argv[++i]);  // NOLINT(cert-err34-c)
        } else if (name == "--title" && has_value) {
            options.title = argv[++i];
        } else {
            options.rounds = 0;
        }
    }
    if (options.rounds < 1 || options.threads < 1) {
        std::fprintf(stderr,
                     "usage: bench_simulator [--rounds N] [--threads N] [--no-growth] [--title "
                     "TEXT]\n");
        std::exit(2);
    }
    return options;
}

std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.rfind("model name", 0) == 0) {
            return line.substr(line.find(':') + 2);
        }
    }
    return "unknown processor";
}

}  // namespace

int main(int argc, char** argv) {
    using namespace pent::simulator::bench;  // NOLINT(google-build-using-namespace)
    const Options options = parse(argc, argv);
    std::printf(
        "# %s\n\n%s, %u cores seen, g++ %s, kernels for %s. Medians of %d rounds that take "
        "all cases in turn;\n+- is half the distance of the quartiles. Products and "
        "preconditioners are applied ten times in a row, after\nas many that do not count; those "
        "that keep a part of more than 24 MB in the cache may be above 100%%.\n\n",
        options.title.c_str(), processor().c_str(), std::thread::hardware_concurrency(),
        __VERSION__, std::string(pent::simulator::isa_name(pent::simulator::best_isa())).c_str(),
        options.rounds);
    const Report kernels = measure(kernel_cases(options.threads), options.rounds, options.threads);
    std::printf(
        "## Kernels: beam of 259,200 pentachora, vertices moved by a tenth of an edge\n\n%s\n",
        markdown(kernels).c_str());
    std::fflush(stdout);
    const Report steps = measure(step_cases(options.threads), options.rounds, options.threads);
    std::printf("## Steps: eighth step of 1/30 s, E = 1e7, nu = 0.28, to 1e-3\n\n%s\n",
                markdown(steps).c_str());
    std::fflush(stdout);
    if (options.has_growth) {
        std::printf("## Growth: compact boxes, linear_euler, %d threads\n\n%s", options.threads,
                    growth(options.threads).c_str());
    }
    return 0;
}
