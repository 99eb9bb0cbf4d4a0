#include "child_process.h"

#include <pent/error.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <memory>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <utility>

namespace pent::study {

namespace {

// How often to look whether the program has ended: small against any run worth timing.
constexpr std::chrono::milliseconds kLook(2);

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

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

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// The high-water mark of a process that still runs; 0 if it does not. The one that wait4() gives
// starts from that of the parent.
double peak_bytes(pid_t child) {
    std::ifstream status("/proc/" + std::to_string(child) + "/status");
    std::string line;
    while (std::getline(status, line)) {
        if (line.rfind("VmHWM:", 0) == 0) {
            return 1024 * std::strtod(line.c_str() + 6, nullptr);
        }
    }
    return 0;
}

pid_t start(const std::filesystem::path& program,
            const std::vector<std::string>& arguments,
            const std::filesystem::path& folder,
            std::FILE* errors) {
    std::vector<std::string> words = {std::filesystem::absolute(program).string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) {
        argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, ::fileno(errors), STDERR_FILENO);
    if (!folder.empty()) {
        ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    }
    pid_t child = -1;
    const int failure =
        ::posix_spawn(&child, words[0].c_str(), &actions, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) {
        throw Error(program.string() + ": cannot be started ("
                    + std::generic_category().message(failure)
                    + "); expected it in the folder of this program");
    }
    return child;
}

}  // namespace

ChildOutcome run_child(const std::filesystem::path& program,
                       const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder,
                       const std::function<bool()>& should_stop) {
    const File errors(std::tmpfile(), &std::fclose);
    if (!errors) {
        throw Error("cannot make a temporary file; make room in the folder for temporary files");
    }
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = start(program, arguments, folder, errors.get());
    bool is_told = false;
    int status = 0;
    double peak = 0;
    rusage usage{};
    while (::wait4(child, &status, WNOHANG, &usage) == 0) {
        if (!is_told && should_stop && should_stop()) {
            ::kill(child, SIGTERM);
            is_told = true;
        }
        peak = std::max(peak, peak_bytes(child));
        std::this_thread::sleep_for(kLook);
    }
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    return {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            .wall_seconds = wall.count(),
            .cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime),
            .peak_bytes = peak,
            .error = last_line(errors.get())};
}

}  // namespace pent::study
