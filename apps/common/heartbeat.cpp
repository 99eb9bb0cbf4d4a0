#include "heartbeat.h"

#include "terminal.h"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace pent::apps {

namespace {

// What cannot be printed is left out: the program's own lines say so at its end.
void print(const char* text, std::size_t length) {
    static_cast<void>(!::write(STDOUT_FILENO, text, length));
}

}  // namespace

Heartbeat::Heartbeat(bool quiet, std::chrono::milliseconds between)
    : start_(Clock::now()), last_(start_), between_(between), is_terminal_(is_on_terminal()) {
    if (quiet) {
        return;
    }
    thread_ = std::thread([this] { beat(); });
    // Nobody forks while a thread starts: see Watchdog.
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_beating_; });
}

Heartbeat::~Heartbeat() {
    if (!thread_.joinable()) {
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        is_over_ = true;
    }
    changed_.notify_one();
    thread_.join();
    clear_line();
}

void Heartbeat::begin(const std::string& stage) {
    const std::lock_guard lock(mutex_);
    clear_line();
    const std::size_t length = std::min(stage.size(), kLongestStage - 1);
    std::copy_n(stage.begin(), length, stage_.begin());
    stage_[length] = '\0';
    start_ = Clock::now();
}

void Heartbeat::spoken() {
    const std::lock_guard lock(mutex_);
    has_line_ = false;
    last_ = Clock::now();
}

void Heartbeat::beat() {
    std::unique_lock lock(mutex_);
    is_beating_ = true;
    changed_.notify_one();
    while (!changed_.wait_until(lock, last_ + between_, [this] { return is_over_; })) {
        if (Clock::now() >= last_ + between_) {  // nothing was said meanwhile
            say_so_far();
            last_ = Clock::now();
        }
    }
}

void Heartbeat::say_so_far() {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - start_);
    std::array<char, 2 * kLongestStage> line{};
    // On a terminal the next line, whoever prints it, goes over this one.
    const int length =
        std::snprintf(line.data(), line.size(),
                      is_terminal_ ? "\rworking    %s, %d s\x1b[K\r" : "working    %s, %d s\n",
                      stage_.data(), static_cast<int>(seconds.count()));
    print(line.data(), static_cast<std::size_t>(std::max(length, 0)));
    has_line_ = is_terminal_;
}

void Heartbeat::clear_line() {
    if (has_line_) {
        print("\x1b[K", 3);
        has_line_ = false;
    }
}

}  // namespace pent::apps
