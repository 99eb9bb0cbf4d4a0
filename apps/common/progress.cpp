#include "progress.h"

#include "terminal.h"

#include <pent/formatted.h>

#include <cmath>
#include <cstdio>
#include <utility>

namespace pent::apps {

std::string readable_time(double seconds) {
    const auto whole = static_cast<std::int64_t>(std::llround(seconds));
    if (seconds < 9.95) {
        return formatted("%.1f s", seconds);
    }
    if (whole < 60) {
        return formatted("%d s", static_cast<int>(whole));
    }
    if (whole < 3600) {
        return formatted("%d min %02d s", static_cast<int>(whole / 60),
                         static_cast<int>(whole % 60));
    }
    return formatted("%d h %02d min", static_cast<int>(whole / 3600),
                     static_cast<int>(whole % 3600 / 60));
}

std::string readable_rate(double per_second) {
    return formatted(per_second < 999.5 ? "%.3g" : "%.0f", per_second);
}

Progress::Progress(std::string label, std::int64_t total, bool quiet)
    : label_(std::move(label)),
      total_(total),
      quiet_(quiet),
      terminal_(is_on_terminal()),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
    finish();
}

bool Progress::update(std::int64_t done, const std::string& note) {
    if (first_ < 0) {
        first_ = done - 1;
    }
    const Clock::time_point now = Clock::now();
    const double since_last = std::chrono::duration<double>(now - last_).count();
    const bool is_due = done == total_ || since_last > (terminal_ ? 0.1 : 2.0);
    if (quiet_ || !is_due) {
        return false;
    }
    last_ = now;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double rate = static_cast<double>(done - first_) / std::max(elapsed, 1e-9);
    const double left = static_cast<double>(total_ - done) / rate;
    std::printf("%s%s %lld of %lld, %s per s, %s left%s%s%s", terminal_ ? "\r" : "", label_.c_str(),
                static_cast<long long>(done),    // NOLINT(google-runtime-int): printf's type
                static_cast<long long>(total_),  // NOLINT(google-runtime-int)
                readable_rate(rate).c_str(), readable_time(left).c_str(), note.empty() ? "" : "; ",
                note.c_str(), terminal_ ? "\x1b[K" : "\n");
    open_line_ = terminal_;
    std::fflush(stdout);
    return true;
}

void Progress::finish() {
    if (open_line_) {
        std::printf("\n");
        std::fflush(stdout);
        open_line_ = false;
    }
}

}  // namespace pent::apps
