#include "child_process.h"

#include <pent/child_process.h>
#include <pent/stopwatch.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <thread>
#include <utility>

namespace pent::study {

namespace {

// How often to look whether the program has ended: small against any run worth timing.
constexpr std::chrono::milliseconds kLook(2);

std::string last_line(std::FILE* file) {
    std::rewind(file);
    std::string line;
    std::string last;
    for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
        if (c != '\n') {
            line += static_cast<char>(c);
        } else if (!line.empty()) {
            last = std::exchange(line, {});
        }
    }
    return line.empty() ? last : line;
}

// The high-water mark of a process that still runs; 0 if it does not. The one that wait4() gives
// starts from that of the parent.
double peak_bytes(int child) {
    std::ifstream status("/proc/" + std::to_string(child) + "/status");
    std::string line;
    while (std::getline(status, line)) {
        if (line.rfind("VmHWM:", 0) == 0) {
            return 1024 * std::strtod(line.c_str() + 6, nullptr);
        }
    }
    return 0;
}

}  // namespace

ChildOutcome run_child(const std::filesystem::path& program,
                       const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder,
                       const std::function<bool()>& should_stop) {
    const File errors = temporary_file();
    const Stopwatch watch;
    ChildProcess child(program, arguments, {.errors = ::fileno(errors.get()), .folder = folder});
    bool is_told = false;
    double peak = 0;
    std::optional<ChildEnd> end;
    while (!(end = child.poll())) {
        if (!is_told && should_stop && should_stop()) {
            child.stop();
            is_told = true;
        }
        peak = std::max(peak, peak_bytes(child.id()));
        std::this_thread::sleep_for(kLook);
    }
    return {.exit_code = end->signal == 0 ? end->exit_code : -1,
            .wall_seconds = watch.seconds(),
            .cpu_seconds = end->cpu_seconds,
            .peak_bytes = peak,
            .error = last_line(errors.get())};
}

}  // namespace pent::study
